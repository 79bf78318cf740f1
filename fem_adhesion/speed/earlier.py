"""An earlier run of the speed study, read back from its table to be shown beside a new one."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from pathlib import Path

from fem_adhesion.speed.methods import QUANTITIES
from fem_adhesion.speed.result import Earlier, Timing
from halfspace.errors import InputError


def read(path: Path, tabor: float) -> Earlier:
    """Read ``speed.csv`` of an earlier run at the same Tabor parameter, or raise InputError."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        at = {float(row["tabor"]) for row in rows}
        rungs = tuple(_rung(row) for row in rows if row["outcome"] == "converged")
    except OSError as error:
        raise InputError(
            f"beside = {path} cannot be read: {error.strerror}; give speed.csv of an earlier run"
        ) from None
    except KeyError as error:
        raise InputError(f"beside = {path} has no column {error}; give speed.csv of this version's study") from None
    except (TypeError, ValueError, csv.Error) as error:
        raise InputError(f"beside = {path} is no table of a speed study ({error}); give its speed.csv") from None
    if not rungs:
        raise InputError(f"beside = {path} has no rung with a result; give speed.csv of an earlier run")
    if at != {tabor}:
        raise InputError(f"beside = {path} is of tabor {', '.join(f'{t:g}' for t in sorted(at))}, not {tabor:g}")
    return Earlier(str(path), rungs)


def _rung(row: Mapping[str, str]) -> Timing:
    """Rung of a row of the table, where what is not known is empty."""
    told = [q for q in QUANTITIES if row[f"{q}_error"]]
    errors, floors = ({q: float(row[f"{q}_{what}"]) for q in told} for what in ("error", "truth_uncertainty"))
    yardsticks = float(row["yardsticks"])
    if not 0 < yardsticks < math.inf or not all(math.isfinite(error) for error in errors.values()):
        raise ValueError(f"{row['method']} at {row['setting']} has no time or no error")
    return Timing(row["method"], row["setting"], "converged", yardsticks, errors=errors, floors=floors)
