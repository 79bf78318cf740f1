"""All figures after Greenwood's, as files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib import rc_context

from fem_adhesion.common.style import LOOK
from fem_adhesion.greenwood.device_figures import DEVICE_PLOTS
from fem_adhesion.greenwood.load_figures import LOAD_PLOTS
from fem_adhesion.greenwood.state_figures import STATE_PLOTS
from fem_adhesion.greenwood.study import Greenwood1997
from fem_adhesion.greenwood.trend_figures import TREND_PLOTS

PLOTS = (*LOAD_PLOTS, *STATE_PLOTS, *TREND_PLOTS, *DEVICE_PLOTS)  # in the paper's order
DOTS_PER_INCH = 160


def draw(study: Greenwood1997, directory: Path, progress: Callable[[str], None] | None = None) -> None:
    """Write every figure as SVG and PNG; `progress` is told each figure's title as its drawing begins."""
    with rc_context(dict(LOOK)):
        for plot in PLOTS:
            if progress:
                progress(f"figure {plot.number}")
            figure = plot.draw(study)
            figure.savefig(directory / f"{plot.stem}.svg", metadata={"Date": None, "Title": plot.title})
            figure.savefig(directory / f"{plot.stem}.png", dpi=DOTS_PER_INCH)
