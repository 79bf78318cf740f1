"""What the numbers that were found by trial are worth: how many estimates hold at half and at double of each.

`python tests/constants.py` measures it again over the coarse nets of the families that a constant serves.
"""

from contextlib import contextmanager
from dataclasses import dataclass

import honesty

import fem_adhesion.sized
import halfspace.accuracy
import halfspace.sized

FACTORS = (0.5, 1.0, 2.0)


@dataclass(frozen=True)
class Constant:
    """A number of a module, and the families in which it tells."""

    module: object
    name: str
    families: tuple

    @contextmanager
    def times(self, factor):
        """Let the number be a multiple of what it is."""
        usual = getattr(self.module, self.name)
        setattr(self.module, self.name, type(usual)(factor * usual))
        try:
            yield
        finally:
            setattr(self.module, self.name, usual)


CONSTANTS = (
    Constant(halfspace.accuracy, "ONE_NODE", ("half-space",)),
    Constant(halfspace.accuracy, "REMAINING", ("half-space",)),
    Constant(halfspace.accuracy, "EXTENT", ("half-space",)),
    Constant(fem_adhesion.sized, "REMAINING", ("hemisphere, sliding",)),
    Constant(fem_adhesion.sized, "FINEST", ("hemisphere, sliding",)),
)


def main():
    """Print the table."""
    print(f"{'constant':32}{'times':>6}{'numbers':>9}{'within':>9}{'within 100 times':>18}{'CPU s':>8}")
    for constant in CONSTANTS:
        for factor in FACTORS:
            with constant.times(factor):
                for row in honesty.rows_of("quick", constant.families, jobs=1):
                    held, close = row.shares
                    print(
                        f"{constant.module.__name__}.{constant.name:12}"[:32].ljust(32)
                        + f"{factor:6g}{len(row.numbers):9}{held:9.1%}{close:18.1%}{row.seconds:8.0f}",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
