"""Lines drawn in a terminal with the eight dots of Braille characters."""

from __future__ import annotations

import numpy as np
from rich.text import Text

from halfspace.values import Array, Index

DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])  # by row and column in a character
BLANK = 0x2800
FINE = 20  # samples between two points of a line
THIN = 3  # every how many dots a thinned line has one


class Canvas:
    """Characters with a frame of values.

    Parameters
    ----------
    width, height : int
        In characters.
    x, y : pair of float
        Values at the left and right, lower and upper edge.
    """

    MARGIN = 10  # characters in front of it, for the values at its edges and the frame

    def __init__(self, width: int, height: int, x: tuple[float, float], y: tuple[float, float]) -> None:
        self._dots = np.zeros((height, width), dtype=int)
        self._styles = np.full((height, width), "", dtype=object)
        self._letters: dict[tuple[int, int], str] = {}
        self._x, self._y = x, y

    def line(self, x: Array, y: Array, style: str, *, thinned: bool = False) -> None:
        """Draw a line through points in a colour; nan interrupts it."""
        fine = np.linspace(0, x.size - 1, FINE * x.size)
        columns, rows = self._place(np.interp(fine, np.arange(x.size), x), np.interp(fine, np.arange(x.size), y))
        places = dict.fromkeys(zip(rows.tolist(), columns.tolist(), strict=True))
        for row, column in list(places)[:: THIN if thinned else 1]:
            if 0 <= row < 4 * self._dots.shape[0] and 0 <= column < 2 * self._dots.shape[1]:
                self._dots[row // 4, column // 2] |= DOTS[row % 4, column % 2]
                self._styles[row // 4, column // 2] = style

    def letter(self, letter: str, x: float, y: float) -> None:
        """Put a letter over a point."""
        column, row = (int(value[0]) for value in self._place(np.array([x]), np.array([y])))
        self._letters[row // 4, column // 2] = letter

    def text(self, edges: tuple[str, str]) -> Text:
        """Lines of text, with the values at the lower and upper edge in front."""
        text, (height, width) = Text(), self._dots.shape
        for row in range(height):
            text.append(f"{ {0: edges[1], height - 1: edges[0]}.get(row, ''):>{self.MARGIN - 2}} │")
            for column in range(width):
                letter = self._letters.get((row, column))
                text.append(
                    letter or chr(BLANK + self._dots[row, column]), "bold" if letter else self._styles[row, column]
                )
            text.append("\n")
        return text.append(" " * (self.MARGIN - 1) + "└" + "─" * width + "\n")

    def _place(self, x: Array, y: Array) -> tuple[Index, Index]:
        """Column and row of dots, counted from the upper left; outside where a value is nan."""
        height, width = self._dots.shape
        column = (x - self._x[0]) / (self._x[1] - self._x[0]) * 2 * width
        row = (self._y[1] - y) / (self._y[1] - self._y[0]) * 4 * height
        return _whole(column), _whole(row)


def _whole(values: Array) -> Index:
    return np.nan_to_num(np.floor(values), nan=-1.0).astype(np.intp)
