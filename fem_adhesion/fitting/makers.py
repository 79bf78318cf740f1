"""Curves in the files of makers of instruments: by afmformats and, of Nanosurf, by NSFopen, each an extra.

afmformats reads JPK, Asylum (.ibw), AFM Workshop, NT-MDT (.txt), Optics11, HDF5 and its own .tab; a file holds one
curve or a map of curves. Segments in between approach and retract, such as a pause, are left out.
"""

from __future__ import annotations

import importlib
import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from fem_adhesion.common.numbers import listed
from halfspace.errors import InputError
from halfspace.values import Array

NANOSURF = (".nid",)
OTHERS = (".h5", ".ibw", ".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".tab", ".txt", ".zip")
WORKSHOP = "Force-Distance Curve"  # first line of a .csv of AFM Workshop, which has no header such as ours
TRAVELS = {"height (measured)": "sensor", "height (piezo)": "piezo", "tip position": "separation"}
NTMDT = 1e-9  # m: its texts are in nm, and afmformats takes their sensitivity in nm too
GIVEN = {"spring constant": "stiffness in N/m", "sensitivity": "sensitivity in m/V"}


@dataclass(frozen=True)
class Columns:
    """Columns of a curve in SI, the travel first, the segment of each sample, and the spring constant of the file.

    Columns are named as in `fem_adhesion.fitting.measured.TRAVELS` and "force" or "deflection"; segments are None where
    the file does not tell them, `told` is what was found about the columns, in sentences.
    """

    values: Mapping[str, Array]
    labels: Sequence[str] | None
    stiffness: float | None
    told: tuple[str, ...] = ()


def is_makers(path: Path) -> bool:
    """Whether a file is one of a maker's."""
    if path.suffix.lower() != ".csv":
        return path.suffix.lower() in NANOSURF + OTHERS
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            return file.readline().startswith(WORKSHOP)
    except OSError as error:
        raise InputError(f"{path} cannot be read ({error.strerror}); give a file of a force curve") from error


def load(path: Path, stiffness: float | None = None, sensitivity: float | None = None) -> Sequence[Columns]:
    """Curves of a file. The stiffness in N/m and the sensitivity in m/V take the place of those that it lacks.

    InputError if the library is not installed, the file cannot be read, or what it lacks is not given.
    """
    if not path.is_file():
        raise InputError(f"{path} is no file; give a file of a force curve")
    return _loaded(path, path.stat().st_mtime_ns, stiffness, sensitivity)


@lru_cache(maxsize=1)  # a map is opened once, not once for each of its curves
def _loaded(path: Path, _changed: int, stiffness: float | None, sensitivity: float | None) -> Sequence[Columns]:
    if path.suffix.lower() in NANOSURF:
        return _nanosurf(path)
    return _afmformats(path, stiffness, sensitivity)


def _library(name: str, extra: str) -> Any:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise InputError(
            f"{name.partition('.')[0]} is not installed, limit: the extra {extra}; pip install '.[{extra}]' in a clone"
        ) from error


def _afmformats(path: Path, stiffness: float | None, sensitivity: float | None) -> Sequence[Columns]:
    """Curves by afmformats, whose errors are no `Exception` and are logged with their traceback."""
    library = _library("afmformats", "afm")
    logging.getLogger("afmformats").setLevel(logging.CRITICAL + 1)
    unit = NTMDT if path.suffix == ".txt" else 1.0
    known = {"spring constant": stiffness, "sensitivity": sensitivity and sensitivity / unit}
    known = {name: value for name, value in known.items() if value is not None}

    def tried(**given: Any) -> Sequence[Any]:
        try:
            return list(library.load_data(path, **given))
        except library.errors.MissingMetaDataError as error:
            missing = [name for name in GIVEN if name in str(error)]
            if not given and known.keys() >= set(missing):
                return tried(meta_override={name: known[name] for name in missing})
            words = listed([GIVEN[name] for name in missing if name not in known]) or str(error)
            raise InputError(f"{path} lacks what makes forces of its voltages; give the {words}") from error
        except (Exception, library.errors.AFMFileFormatError) as error:  # of a damaged file its readers raise anything
            raise InputError(f"{path} cannot be read as {path.suffix} ({_why(error)}); save it as CSV") from error

    return [_columns(path, curve) for curve in tried()]


def _why(error: BaseException) -> str:
    """First line of an error, or its name."""
    return str(error).partition("\n")[0] or type(error).__name__


def _columns(path: Path, curve: Any) -> Columns:
    """Columns of a curve of afmformats; where it knows of one segment alone, it is divided at the largest force."""
    travel = next((name for name in TRAVELS if name in curve.columns), None)
    if travel is None or "force" not in curve.columns:
        raise InputError(f"{path} has {listed(curve.columns)}, limit: a height and a force; export these")
    force, segment = np.asarray(curve["force"], float), np.asarray(curve["segment"])
    if np.ptp(segment) == 0:
        segment = np.arange(force.size) > np.argmax(force)
    names = {segment[0]: "approach", segment[-1]: "retract"}
    values = {TRAVELS[travel]: np.asarray(curve[travel], float), "force": force}
    return Columns(values, [names.get(each, "pause") for each in segment], curve.metadata.get("spring constant"))


def _nanosurf(path: Path) -> Sequence[Columns]:
    """Curves of a spectroscopy by NSFopen: forces in N, or deflections in m, which take a stiffness."""
    reader = _library("NSFopen.read", "nanosurf").read
    try:
        file = reader(str(path), dataframe=False)  # its tables warn of pandas 3
        heads = [each for each in file.param["HeaderDump"].values() if each.get("Frame") == "Spec forward"]
        units = {each["Dim2Name"]: each["Dim2Unit"] for each in heads}
        spring = file.param["Tip"]["Prop0"]
        sides = [file.data["Spec"][side] for side in ("Forward", "Backward")]
    except Exception as error:  # as of afmformats
        raise InputError(f"{path} cannot be read as a spectroscopy ({_why(error)}); save its curves as CSV") from error
    travel = {"Z-Axis Sensor": "sensor", "Z-Axis": "piezo"}
    channel = next((name for name in travel if name in units), "no travel")
    given = {"N": "force", "m": "deflection"}.get(units.get("Deflection", "nothing"))
    if channel not in travel or given is None:
        has = listed([f"{name} in {unit}" for name, unit in units.items()])
        raise InputError(f"{path} has {has}, limit: Z-Axis in m and Deflection in N or m; calibrate the deflection")
    own = float(spring["Value"]) if spring["Unit"] == "N/m" else None
    found = []
    for number in range(len(sides[0][channel])):
        heights, pulls = ([np.asarray(side[name][number], float) for side in sides] for name in (channel, "Deflection"))
        labels = ["approach"] * heights[0].size + ["retract"] * heights[1].size
        values = {travel[channel]: np.concatenate(heights), given: np.concatenate(pulls)}
        found.append(Columns(values, labels, own))
    return found
