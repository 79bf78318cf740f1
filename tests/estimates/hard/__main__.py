"""``make hard``: attempt every hard case, print how each ended, and write what the report shows of them."""

import argparse
import sys
from pathlib import Path

from fem_adhesion.common.files import directory_written_aside
from fem_adhesion.common.jobs import progress_bar
from fem_adhesion.common.options import console_beside
from hard.bodies import locking
from hard.cases import cases
from hard.run import Row, run
from hard.table import cases_table, locking_table, write_hard


def main(directory: Path) -> int:
    """Attempt the hard cases; 1 if one ends otherwise than was declared for it beforehand, else 0."""
    attempted = cases()
    names = [*(case.name for case in attempted), "locking"]
    rows: list[Row] = []
    with directory_written_aside(directory, force=True) as aside:
        with progress_bar() as step:
            step(names[0], 0, len(names))
            for row in run(attempted):
                rows.append(row)
                step(names[len(rows)], len(rows), len(names))
            locked = list(locking())
        write_hard(aside, rows, locked)
    console_beside().print(cases_table(rows), locking_table(locked))
    return int(any(row.outcome == "wrong" for row in rows))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="make hard", description=__doc__)
    parser.add_argument("out", type=Path, help="directory to write")
    sys.exit(main(parser.parse_args().out))
