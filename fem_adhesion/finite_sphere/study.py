"""The finite sphere: how far the half-space under a paraboloid is from it, and which assumption makes the difference.

Every point of the plan is solved under several sets of assumptions (`fem_adhesion.finite_sphere.cases`), in parallel,
the results of a body stored as they come; `fem_adhesion.finite_sphere.table` sets them beside each other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from itertools import product
from math import log
from typing import Any

import numpy as np

from fem_adhesion.common.facts import code_digest
from fem_adhesion.common.files import Store
from fem_adhesion.common.jobs import solve_all
from fem_adhesion.common.numbers import counted
from fem_adhesion.finite_sphere.cases import MODELS, Record, SphereCase, case_of, compute, from_plain, to_plain
from fem_adhesion.finite_sphere.table import DeviationRow, Samples, rows, samples
from halfspace.errors import InputError
from halfspace.limits import require_poisson, require_radius_ratio, require_tabor


@dataclass(frozen=True)
class Study:
    """All records of a study, with those left out, and whether it was a quick one: few points, a lower accuracy."""

    records: Sequence[Record]
    quick: bool = False

    @cached_property
    def rows(self) -> tuple[DeviationRow, ...]:
        """All quantities of all cases beside those without one cause."""
        return rows(self.records)

    @cached_property
    def poisson(self) -> float | None:
        """Poisson's ratio of the figures that show one: 0.3, or the nearest to it in the table."""
        known = {row.poisson for row in self.rows if row.poisson is not None}
        return min(known, key=lambda nu: abs(nu - 0.3), default=None)

    def samples(self, cause: str, quantity: str, **at: float) -> Samples:
        """Deviations at that Poisson's ratio, which those by the profile do not depend on, and at further inputs."""
        return samples(self.rows, cause, quantity, poisson=None if cause == "profile" else self.poisson, **at)

    @property
    def panel_tabors(self) -> list[float]:
        """Tabor parameters that have a panel: those nearest to 0.3, 1 and 3 in the table."""
        known = {row.tabor for row in self.rows if row.cause == "all" and row.deviation}
        return sorted({min(known, key=lambda mu: abs(log(mu / wanted))) for wanted in (0.3, 1.0, 3.0) if known})

    @property
    def points_by_poisson(self) -> list[tuple[float, float]]:
        """Tabor parameters and R/eps whose pull-off is known at two Poisson's ratios or more."""
        data = samples(self.rows, "all", "pull_off_load")
        points, counts = np.unique([data.radius_ratio, data.tabor], axis=1, return_counts=True)
        return [(float(mu), float(rho)) for rho, mu in points[:, counts > 1].T]

    @property
    def jumping_tabors(self) -> list[float]:
        """Tabor parameters whose jump-on is known on spheres of two sizes or more."""
        tabors, counts = np.unique(self.samples("all", "jump_on_approach").tabor, return_counts=True)
        return [float(tabor) for tabor in tabors[counts > 1]]

    @property
    def failed(self) -> tuple[Record, ...]:
        """Cases that were tried and have no solution."""
        return tuple(record for record in self.records if record.failed)

    @property
    def headline(self) -> str:
        """How the study went, in one line."""
        failed, left_out = self.failed, sum(record.status == "left out" for record in self.records)
        tried = len(self.records) - left_out
        kinds = Counter(record.kind or record.status for record in failed)
        ended = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
        lost = f"{len(failed)} of {counted(tried, 'case')} not solved ({ended})"
        parts = [
            "quick study, of few points" if self.quick else "",
            lost if failed else f"{counted(tried, 'case')}, all solved" if tried else "no case",
            f"{counted(left_out, 'case')} left out, beyond the limits" if left_out else "",
        ]
        return "; ".join(filter(None, parts))


TABORS = (0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0)
RADIUS_RATIOS = (5.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5)
FAVOURED = (0.3, 1.0, 3.0)  # Tabor parameters of what takes long
FINITE_STRAIN = ("finite_strain", "finite_strain_normal", "finite_strain_reference")
DENSE = tuple(name for name in MODELS if name not in ("surface_traction", *FINITE_STRAIN))
Combinations = tuple[Sequence[float], Sequence[float], Sequence[float], Sequence[str]]
"""Tabor parameters, R/eps, Poisson's ratios and models, of which all are combined."""
USUAL: Sequence[Combinations] = (  # some four minutes on two cores
    (TABORS, RADIUS_RATIOS, (0.3,), DENSE),
    (FAVOURED, RADIUS_RATIOS, (0.3,), ("surface_traction",)),
    (FAVOURED, (30.0, 100.0, 1e3, 1e4), (0.3,), FINITE_STRAIN),
    (FAVOURED, (30.0, 1e3), (0.0, 0.17, 0.45, 0.499), DENSE),
)
QUICK: Sequence[Combinations] = (  # 20 s
    ((0.3, 1.0), (30.0, 300.0, 3e3), (0.3,), [n for n in DENSE if n not in ("finite_body", "bonded")]),
    ((1.0,), (30.0, 3e3), (0.3,), ("finite_body", "bonded")),
)


def plan(
    tabors: Sequence[float] | None = None,
    radius_ratios: Sequence[float] | None = None,
    poissons: Sequence[float] | None = None,
    *,
    quick: bool = False,
) -> tuple[tuple[SphereCase, ...], tuple[Record, ...]]:
    """Cases of the study, each once: those to compute, and those beyond the limits of the solvers, with reasons.

    They are all combinations of the inputs; a sphere may be too small for its Tabor parameter.
    Poisson's ratio is 0.3 unless given. If none of the three inputs is given, it is varied besides, at some points. A
    quick study has two by three points unless given, and a lower accuracy. InputError if an input is out of range, or
    a sphere is too small for every Tabor parameter.
    """
    grids = QUICK if quick else USUAL
    if tabors or radius_ratios or poissons:
        asked = tabors or grids[0][0], radius_ratios or grids[0][1], poissons or grids[0][2]
        grids = [(*asked, tuple(MODELS))]
        for tabor in asked[0]:
            require_tabor(tabor)
        for poisson in asked[2]:
            require_poisson(poisson)
        for ratio in asked[1]:
            require_radius_ratio(ratio, min(asked[0]))
    rtol = 1e-4 if quick else 1e-5
    points = (point for mu, rho, nu, models in grids for point in product(mu, rho, nu, models))
    cases = tuple(dict.fromkeys(case_of(model, mu, rho, nu, rtol) for mu, rho, nu, model in points))
    left_out = {case: record for case in cases if (record := _left_out(case))}
    return tuple(case for case in cases if case not in left_out), tuple(left_out.values())


def _left_out(case: SphereCase) -> Record | None:
    """Record of a case whose sphere is too small for its Tabor parameter, or for its model besides."""
    if case.tabor is None or case.radius_ratio is None:
        return None
    try:
        require_radius_ratio(case.radius_ratio, case.tabor)
        MODELS[case.model].check(case)
    except InputError as error:
        return Record(case, "left out", {}, str(error), 0.0, type(error).__name__)
    return None


def code() -> str:
    """Digest of the code that computes a case."""
    return code_digest(compute.__module__)


def run(
    cases: Sequence[SphereCase], store: Store | None, *, work: Callable[[SphereCase], Record] = compute, **how: Any
) -> tuple[Record, ...]:
    """Records of cases of a plan, by the work: `fem_adhesion.common.jobs.solve_all`, whose keywords are `how`."""
    return solve_all(
        cases,
        store,
        work=work,
        inputs=asdict,
        name=lambda case: case.name,
        write=to_plain,
        read=from_plain,
        died=lambda case, why: Record(case, "died", {}, why),
        **how,
    )
