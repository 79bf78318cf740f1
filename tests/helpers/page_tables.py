"""Tables of a page as they are read: each line a mapping of its headers to its cells."""

import re
from html import unescape


def tables(page):
    """All tables of a page, in order, each a list of lines."""
    return [_lines(text) for text in re.findall(r"<table[^>]*>(.*?)</table>", page, re.S)]


def _lines(text):
    headers = _cells("th", text)
    rows = [_cells("td", row) for row in re.findall(r"<tr[^>]*>(.*?)</tr>", text, re.S)]
    return [dict(zip(headers, row, strict=True)) for row in rows if row]


def _cells(tag, text):
    found = re.findall(rf"<{tag}\b([^>]*)>(.*?)</{tag}>", text, re.S)
    return [unescape(cell) for how, cell in found for _ in range(2 if 'colspan="2"' in how else 1)]


def value_and_error(text):
    """Number with the error of its last digit in brackets, as 60.4440(1); None of what is no such number."""
    found = re.fullmatch(r"(-?\d+(?:\.(\d+))?)\((\d+)\)", text)
    return found and (float(found[1]), int(found[3]) * 10.0 ** -len(found[2] or ""))
