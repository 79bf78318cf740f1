"""How figures look: one colour for each Tabor parameter, stable and unstable told apart; and how they become files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Generic, TextIO, TypeVar

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter

from fem_adhesion.common import page
from fem_adhesion.common.numbers import joined
from halfspace.errors import InputError

# Okabe and Ito's colours, which colour-blind eyes tell apart.
BLUE, SKY, GREEN, ORANGE, RED, PINK = "#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7"
DASHED, DOTTED, CHAIN, LONG = (0, (5, 1.5)), (0, (1, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (9, 2))
LOOK: dict[Any, Any] = {
    "font.size": 11,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.hashsalt": "fem-adhesion",
}
ON_PAGES = LOOK | {"svg.fonttype": "none"}  # text that can be read and searched in the file
SUFFIXES = (".png", ".svg", ".pdf")
DOTS_PER_INCH = 160

LEGEND: Mapping[str, Any] = {"fontsize": 9.5, "handlelength": 3.2}

Point = tuple[float, float]


def panels(columns: int = 1, height: float = 5.0) -> tuple[Figure, Sequence[Any]]:
    """Figure with panels side by side, its height in inches."""
    figure = Figure(figsize=(7.4 if columns == 1 else 12.0, height), layout="constrained")
    return figure, figure.subplots(1, columns, squeeze=False)[0]


def dress(
    axes: Any, x: str, y: str, *, legend: str | None = "best", columns: int = 3, **limits: tuple[float, float]
) -> None:
    """Label the axes, set `xlim` and `ylim` if given, and add a legend of what is drawn, at a place or below."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set(**limits)
    axes.grid(True, color="0.93", linewidth=0.8)
    axes.set_axisbelow(True)
    if not axes.get_legend_handles_labels()[1]:
        return
    if legend == "below":
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=columns, frameon=False, **LEGEND)
    elif legend:
        axes.legend(loc=legend, framealpha=0.9, edgecolor="none", **LEGEND)


def legend_below(figure: Figure, panels: Sequence[Any], columns: int) -> None:
    """One legend below the panels, of all that any of them shows, each label once."""
    shown = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if shown:
        handles, labels = list(shown.values()), list(shown)
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False, **LEGEND)


def plain_ticks(axis: Any, ticks: Sequence[float]) -> None:
    """Ticks of a logarithmic axis as plain numbers."""
    axis.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    axis.set_ticks([], minor=True)


def engineering_ticks(axis: Any, unit: str) -> None:
    """Ticks of an axis with engineering prefixes, and a plain zero."""
    write = EngFormatter(unit)
    axis.set_major_formatter(lambda value, place: write(value, place) if value else "0")


def arrow(axes: Any, tail: Point, head: Point, *, zorder: float = 3, clipped: bool | None = None, **look: Any) -> None:
    """Arrow of a jump, from point to point; drawn whatever is outside the axes unless clipped."""
    props = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, **look}
    axes.annotate("", head, tail, arrowprops=props, zorder=zorder, annotation_clip=clipped)


def note(axes: Any, text: str, at: tuple[float, float], offset: tuple[float, float] = (6, 4), **style: Any) -> None:
    """Text beside a point, offset in points."""
    axes.annotate(text, at, xytext=offset, textcoords="offset points", fontsize=10.5, **style)


# Files


Results = TypeVar("Results")


@dataclass(frozen=True)
class Picture(Generic[Results]):
    """A figure of a study: its file's name without the suffix, and what is drawn.

    `draw` draws it from the results, and `sentences` say what is to be seen in it; empty ones are left out. `lacks`
    says what the results lack to be drawn, or nothing.
    """

    stem: str
    title: str
    draw: Callable[[Results], Figure]
    sentences: Callable[[Results], Iterable[str]]
    lacks: Callable[[Results], str] = lambda _: ""

    def see(self, results: Results) -> str:
        """What is to be seen in it, as one paragraph."""
        return joined(*self.sentences(results))


def draw(
    pictures: Sequence[Picture[Results]],
    results: Results,
    directory: Path,
    begin: Callable[[str], None] = lambda _: None,
) -> None:
    """Write figures as SVG and PNG, but for those that lack something; `begin` is told which is begun."""
    with rc_context(ON_PAGES):
        for picture in pictures:
            begin(f"figure {picture.stem}")
            if picture.lacks(results):
                continue
            figure = laid_out(picture.draw(results))
            figure.savefig(directory / f"{picture.stem}.svg", metadata={"Date": None, "Title": picture.title})
            figure.savefig(directory / f"{picture.stem}.png", dpi=DOTS_PER_INCH)


def laid_out(figure: Figure) -> Figure:
    """Figure whose axes have their places: left to each format, they would be sought anew, and all be drawn once more.

    What is written in several formats has them in the same places, too.
    """
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)
    return figure


def captions(pictures: Sequence[Picture[Results]], results: Results) -> page.Table:
    """What is to be seen in each figure, for pages that show it elsewhere."""
    rows = [
        (one.stem, "" if (lack := one.lacks(results)) else f"{one.title}. {one.see(results)}", lack) for one in pictures
    ]
    return page.Table("captions", "Captions", "", ("figure", "caption", "why not drawn"), rows)


def shown(pictures: Sequence[Picture[Results]], results: Results, directory: Path) -> list[page.Figure]:
    """Figures that `draw` has written, as parts of a page, which can be sent alone, with links to the files beside."""
    figures = []
    for one in (picture for picture in pictures if not picture.lacks(results)):
        files = [suffix for suffix in ("svg", "png", "csv") if (directory / f"{one.stem}.{suffix}").exists()]
        svg = (directory / f"{one.stem}.svg").read_bytes()
        figures.append(page.Figure(svg, one.see(results), one.title, one.stem, files))
    return figures


def require_suffix(path: Path) -> str:
    """Return the format of a figure file, or raise InputError if it is none of png, svg and pdf."""
    if path.suffix not in SUFFIXES:
        raise InputError(f"{path} ends in {path.suffix!r}, limit: one of {', '.join(SUFFIXES)}; rename it")
    return path.suffix[1:]


def write(
    figure: Callable[[], Figure], file: TextIO, form: str, look: Mapping[Any, Any] = LOOK, dpi: float = 200
) -> None:
    """Draw and write, in a format of `require_suffix`, to a file from `fem_adhesion.common.files.written_aside`."""
    picture = BytesIO()
    with rc_context(dict(look)):
        laid_out(figure()).savefig(picture, format=form, dpi=dpi, metadata={"Date": None} if form == "svg" else None)
    file.buffer.write(picture.getbuffer())
