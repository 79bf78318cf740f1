"""All figures after Greenwood's, as files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib import rc_context

from fem_adhesion.output.greenwood_device_plots import DEVICE_PLOTS
from fem_adhesion.output.greenwood_load_plots import LOAD_PLOTS
from fem_adhesion.output.greenwood_state_plots import STATE_PLOTS
from fem_adhesion.output.greenwood_style import LOOK
from fem_adhesion.output.greenwood_trend_plots import TREND_PLOTS
from fem_adhesion.studies.greenwood1997 import Greenwood1997

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
