"""Numbers of what is shown of a curve that several places use, or that a reader may want to change."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Numbers of what is shown of a curve."""

    # What is asked
    inside: int = 20  # points of a curve for ParaView

    # Stress as numbers
    along: int = 101  # points of a line, closer near the pole
    deep: float = 3.0  # contact radii, or beta without contact, to which a line goes
    larger: float = 1.6  # times the box of a cell's vertices, in which points may be its own: sides are curved
    steps: int = 10  # of Newton's method to a place in a cell
    outside: float = 1e-6  # of a cell's side, by which a place on the side may be off

    # The page
    samples: int = 600  # points of a theory's line
    shown: float = 3.0  # radius of the mesh shown, in contact radii
    highest: float = 0.9  # height of the mesh shown, in contact radii
    points: int = 1500  # of a profile along the surface
    wider: float = 1.6  # radius of profiles, in the widest contact's

    # Pictures and movies
    picture: tuple[int, int] = (1600, 1000)  # pixels
    frames: int = 48  # of a movie, about
    faded: float = 0.04  # load at which the movie begins, in the pull-off load
    pressed: float = -0.25  # load at which the wall turns back, in the pull-off load
    moving: float = 0.1  # seconds for which a frame is shown while the wall moves
    resting: float = 0.9  # the same at turns and jumps
    near: float = 1e-6  # difference of approaches in eps that counts as none

    # The table and the plot in characters
    most_digits: int = 8  # significant digits of a number in the table, at most
    columns: int = 76  # width of the plot
    lines: int = 18  # height of the plot
    margin: int = 10  # in front of the plot, for the values at its edges and the frame


USUAL = Settings()
