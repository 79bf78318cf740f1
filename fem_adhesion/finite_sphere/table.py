"""The results of the finite sphere as a table: each quantity of each case beside the same without one cause.

Of its lines `Samples` are taken, of which figures and sentences speak.
"""

from __future__ import annotations

import csv
import importlib
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from fem_adhesion.bodies.body import GripName
from fem_adhesion.common.page import data_rows
from fem_adhesion.finite_sphere.bulk import bulk_compliance
from fem_adhesion.finite_sphere.cases import APPROACH_SCALE, MODELS, QUANTITIES, Record, case_of
from halfspace.values import Array, Estimate

BulkCompliance = Callable[[GripName, float, float], Estimate]
"""Of grip, Poisson's ratio and R/beta: what a body yields more than the half-space under a load, in 1/(E* R)."""

LESS_BULK = {f"{name}_less_bulk": name.removesuffix("_approach") for name in QUANTITIES if name.endswith("_approach")}
"""Approaches with the linear yield of the body taken out, and the event that each is of."""

UNITS = QUANTITIES | dict.fromkeys(LESS_BULK, "eps")
SHOWN = {
    "pull_off_load": "pull-off force",
    "zero_load_radius": "contact radius under no load",
    "jump_on_approach": "approach at jump-on",
    "jump_on_approach_less_bulk": "approach at jump-on, elastic compression of the bulk taken out",
    "jump_off_approach": "approach at jump-off",
    "jump_off_approach_less_bulk": "approach at jump-off, elastic compression of the bulk taken out",
    "hysteresis": "energy lost in a cycle",
}
"""Quantities on the page, in words; the files have the others besides."""
DRAWN = ("pull_off_load", "jump_on_approach")  # quantities that have a panel in figures


@dataclass(frozen=True)
class Cause:
    """An assumption in words, and the keys of `MODELS`: the model that drops it, less the baseline that makes it.

    A cause that is drawn has a colour, a marker and words of the legend.
    """

    model: str
    baseline: str
    meaning: str
    colour: str
    marker: str
    label: str


CAUSES = {row.pop("cause"): Cause(**row) for row in data_rows("finite_sphere", "causes.csv")}


@dataclass(frozen=True)
class DeviationRow:
    """One quantity of one case beside the case without its cause.

    Inputs are None where the case does not depend on them, as it always does on the first. Cause and quantity are keys
    of `CAUSES` and of `UNITS`, the unit that of values and errors. `value` is with the
    cause, `baseline` without it, `half_space` on the half-space under a paraboloid; the deviation is (value -
    baseline)/half_space, of an approach over the scale of those of the half-space's curve in the place of its value,
    see `halfspace.equilibrium.events.approach_scale`; its error is bounded by those of all three.

    The status is ``solved``; ``absent`` where one of the three contacts does not have the quantity; else what ended the
    case, as in `Record`, like its reason, seconds and kind.
    """

    tabor: float
    radius_ratio: float | None
    poisson: float | None
    cause: str
    quantity: str
    unit: str
    value: Estimate | None
    baseline: Estimate | None
    half_space: Estimate | None
    deviation: Estimate | None
    status: str
    reason: str
    seconds: float
    kind: str = ""

    @property
    def known(self) -> bool:
        """Whether there is a deviation, and its error."""
        number = self.deviation
        return number is not None and math.isfinite(number.value) and math.isfinite(number.error)

    @property
    def ending(self) -> str:
        """How the contact ended: the status, or the kind of error that refused it."""
        return self.kind if self.status == "refused" else self.status

    def within(self, level: float) -> bool:
        """Whether the deviation is known to be smaller than a level."""
        number = self.deviation
        return number is not None and abs(number.value) + number.error < level


def rows(records: Sequence[Record], bulk: BulkCompliance = bulk_compliance) -> tuple[DeviationRow, ...]:
    """Lines of the table, of records in any order; approaches of jumps also less the body's yield."""
    found, lines = {record.case: record for record in records}, []
    causes = [(record, name) for record in found.values() for name in CAUSES if CAUSES[name].model == record.case.model]
    for record, cause in causes:
        case = record.case
        point = case.tabor, case.radius_ratio, case.poisson, case.rtol
        others = [found.get(case_of(model, *point)) for model in (CAUSES[cause].baseline, "half_space")]
        tables = [{**one.values, **less_bulk(one, bulk)} if one else {} for one in (record, *others)]
        for name, unit in UNITS.items():
            value, baseline, half_space = three = [table.get(name) for table in tables]
            scale = half_space and tables[-1].get(APPROACH_SCALE) if unit == "eps" else half_space
            deviation = (value - baseline) / scale if value and baseline and scale else None
            head = (case.given("tabor"), case.radius_ratio, case.poisson, cause, name, unit)
            ending = (*_ending(record, others, three), record.seconds, record.kind)
            lines.append(DeviationRow(*head, value, baseline, half_space, deviation, *ending))
    return tuple(lines)


def less_bulk(record: Record, bulk: BulkCompliance) -> dict[str, Estimate]:
    """Approaches of the jumps without the linear yield of the body, alpha* - kappa mu W/(R/beta)."""
    case, values, yielding = record.case, record.values, Estimate(0.0, 0.0)
    if grip := MODELS[case.model].grip:
        tabor = case.given("tabor")
        R = math.sqrt(case.given("radius_ratio") / tabor)
        yielding = bulk(grip, case.given("poisson"), R) * (tabor / R)
    return {
        name: values[f"{event}_approach"] - yielding * values[f"{event}_load"]
        for name, event in LESS_BULK.items()
        if f"{event}_approach" in values
    }


def _ending(record: Record, others: Sequence[Record | None], three: Sequence[Estimate | None]) -> tuple[str, str]:
    """Status of a line and why it has no deviation."""
    if record.status != "solved":
        return record.status, record.reason
    for one, number, role in zip((record, *others), three, ("case", "baseline", "half-space"), strict=True):
        if one is None or one.status != "solved":
            return "absent", f"the {role} was not solved"
        if number is None:
            return "absent", f"the {role} has none: it does not jump, or was solved for pull-off and jumps alone"
    return "solved", ""


def borders(records: Sequence[Record]) -> list[Record]:
    """Where the jumps begin: on the half-space, then on spheres of growing size."""
    found = [record for record in records if record.case.model in ("first_jump_half_space", "first_jump")]
    return sorted(found, key=lambda record: (record.case.poisson or 0.0, record.case.radius_ratio or 0.0))


# Files: CSV for all, Parquet for those who have the library

NUMBERS = ("value", "baseline", "half_space", "deviation")  # each followed by its error
FIELDS = tuple(field.name for field in fields(DeviationRow))
COLUMNS = tuple(n for name in FIELDS for n in ((name, f"{name}_error") if name in NUMBERS else (name,)))
TEXTS = ("cause", "quantity", "unit", "status", "reason", "kind")
NO_PARQUET = "no Parquet file is written, which needs the extra parquet; pip install '.[parquet]' in a clone"


def write_tables(rows: Sequence[DeviationRow], directory: Path) -> str:
    """Write finite_sphere.csv, and finite_sphere.parquet where pyarrow is installed, else return how to get it."""
    with (directory / "finite_sphere.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(_cells(row) for row in rows)
    try:
        arrow, parquet = importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
    except ModuleNotFoundError:
        return NO_PARQUET
    schema = arrow.schema([(name, arrow.string() if name in TEXTS else arrow.float64()) for name in COLUMNS])
    table = arrow.Table.from_pylist([_cells(row) for row in rows], schema=schema)
    parquet.write_table(table, directory / "finite_sphere.parquet")
    return ""


def _cells(row: DeviationRow) -> dict[str, object]:
    """Cells of a line by the names of their columns, None where there is nothing."""
    cells: dict[str, object] = {name: getattr(row, name) for name in FIELDS}
    for name in NUMBERS:
        number: Estimate | None = getattr(row, name)
        cells |= {name: number and number.value, f"{name}_error": number and number.error}
    return cells


# What figures and sentences speak of


Samples = np.recarray[Any, Any]
"""Points with a deviation of one quantity for one cause; their fields are those of `SAMPLE`."""
SAMPLE = np.dtype([(name, float) for name in ("tabor", "radius_ratio", "poisson", "deviation", "error", "stretch")])


def sampled(tabor: Array, radius_ratio: Array, poisson: Array, deviation: Array, error: Array) -> Samples:
    """Relative deviations at n points, and the bounds of their errors, all (n,); with the stretch, beta/R.

    Poisson's ratio is nan where there is none.
    """
    stretch = np.sqrt(tabor / radius_ratio)
    return np.rec.fromarrays([tabor, radius_ratio, poisson, deviation, error, stretch], SAMPLE)


def significant(data: Samples) -> Samples:
    """Those that exceed their errors."""
    found: Samples = data[np.abs(data.deviation) > data.error]
    return found


def samples(rows: Iterable[DeviationRow], cause: str, quantity: str, **at: float | None) -> Samples:
    """Deviations of a quantity for a cause at the inputs given, of the rows that have one, and a finite one."""
    chosen = [
        (row.tabor, row.radius_ratio, row.poisson, row.deviation.value, row.deviation.error)
        for row in rows
        if (row.cause, row.quantity) == (cause, quantity) and row.deviation and row.known and row.radius_ratio
        if all(getattr(row, name) == value for name, value in at.items())
    ]
    return sampled(*np.array(chosen, float).reshape(-1, 5).T)
