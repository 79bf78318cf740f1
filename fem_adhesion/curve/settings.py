"""Numbers of what is shown of a curve: its page, pictures and movies, its table and plot in characters."""

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
    page: tuple[float, float] = (7.3, 10.0)  # inches
    samples: int = 600  # points of a theory's line
    apart: float = 0.04  # distance of points drawn on a line, in the diagonal of the frame
    theory: float = 1.3  # largest contact radius of a theory's line, in the curve's widest
    close: float = 0.99  # the same in the radius where the body ends, at most
    enlarged: float = 3.0  # highest load, in that of the frame around the events, from which on these are enlarged
    shown: float = 3.0  # radius of the mesh shown, in contact radii
    drawn_as: float = 0.45  # contact radii that the largest displacement is drawn as
    highest: float = 0.9  # height of the mesh shown, in contact radii
    side: int = 9  # points drawn on a side of a cell
    points: int = 1500  # of a profile along the surface
    wider: float = 1.6  # radius of profiles, in the widest contact's
    highest_gap: float = 3.3  # gap shown, in that of an undeformed sphere at the rim of the contact
    spikes: float = 5.0  # widths of the spike of tension shown on either side of the edge

    # Curves by several laws
    core: float = -0.5  # gap in eps below which a law with a core has none
    gaps: tuple[float, float, int] = (-0.4, 6.0, 1200)  # of the laws, in dgamma/(largest tension), and their number

    # Pictures and movies
    picture: tuple[int, int] = (1600, 1000)  # pixels
    width: float = 8.0  # of a picture, in inches
    digits: int = 6  # significant digits of a number in a caption, at most
    frame: tuple[int, int] = (800, 500)  # of a movie, in pixels
    frames: int = 48  # of a movie, about
    faded: float = 0.04  # load at which the movie begins, in the pull-off load
    pressed: float = -0.25  # load at which the wall turns back, in the pull-off load
    moving: float = 0.1  # seconds for which a frame is shown while the wall moves
    resting: float = 0.9  # the same at turns and jumps
    sampled: int = 8  # frames for which the colours of the movie are chosen
    near: float = 1e-6  # difference of approaches in eps that counts as none

    # The table and the plot in characters
    most_digits: int = 8  # significant digits of a number in the table, at most
    columns: int = 76  # width of the plot
    lines: int = 18  # height of the plot
    margin: int = 10  # in front of the plot, for the values at its edges and the frame
    thin: int = 3  # a thinned line has one dot of so many


USUAL = Settings()
