"""One figure of the paper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from fem_adhesion.greenwood.study import Greenwood1997


@dataclass(frozen=True)
class Plot:
    """One figure of the paper.

    Attributes
    ----------
    number : str
        As in the paper.
    title : str
        What is drawn.
    see : callable
        Says what is to be seen in it, from the study.
    draw : callable
        Draws it from the study.
    """

    number: str
    title: str
    see: Callable[[Greenwood1997], str]
    draw: Callable[[Greenwood1997], Figure]

    @property
    def stem(self) -> str:
        """File name without its suffix."""
        return f"fig_{self.number}"
