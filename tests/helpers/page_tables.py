"""What pages and files hold: tables, each line a mapping of its headers to its cells, and what a script draws."""

import csv
import json
import re


def value_and_error(text):
    """Number with the error of its last digit in brackets, as 60.4440(1); None of what is no such number."""
    found = re.fullmatch(r"(-?\d+(?:\.(\d+))?)\((\d+)\)", text)
    return found and (float(found[1]), int(found[3]) * 10.0 ** -len(found[2] or ""))


def data_of(page):
    """What the walk of a report draws."""
    return json.loads(re.search(r'id="walk-data">(.*?)</script>', page, re.S)[1])


def rows_of(file):
    """Lines of a CSV file but for its comments, each a mapping of its headers to its cells."""
    with file.open(newline="") as lines:
        return list(csv.DictReader(line for line in lines if not line.startswith("#")))
