"""The finite sphere: how far the half-space under a paraboloid is from it, and which assumption makes the difference.

Every point of the plan is solved under several sets of assumptions (`fem_adhesion.finite_sphere.cases`), in parallel,
each result stored as it comes; `fem_adhesion.finite_sphere.table` sets them beside each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from itertools import product

from fem_adhesion.common.code_digest import code_digest
from fem_adhesion.common.jobs import WorkerDied, stream
from fem_adhesion.common.progress import Progress, unheard
from fem_adhesion.common.store import Store
from fem_adhesion.finite_sphere.cases import MODELS, case_of, compute
from fem_adhesion.finite_sphere.records import STORED, Case, Record, from_plain, to_plain
from halfspace.errors import InputError
from halfspace.limits import require_poisson, require_radius_ratio, require_tabor

TABORS = (0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0)
RADIUS_RATIOS = (5.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5)
POISSON = 0.3
POISSONS = (0.0, 0.17, 0.45, 0.499)  # besides, at fewer points
FINITE_STRAIN = ("finite_strain", "finite_strain_normal", "finite_strain_reference")
SPARSE = ("surface_traction", *FINITE_STRAIN)  # models solved at fewer points
QUICK_SPARSE = ("finite_body", "bonded")  # and in a quick study, which has none of the others
RTOL, QUICK_RTOL = 1e-5, 1e-4


@dataclass(frozen=True)
class Sweep:
    """All combinations of these inputs, under these models."""

    tabors: Sequence[float]
    radius_ratios: Sequence[float]
    poissons: Sequence[float]
    models: Sequence[str] = tuple(MODELS)


@dataclass(frozen=True)
class Plan:
    """Cases of the study, each once.

    Attributes
    ----------
    cases : tuple of Case
        To be computed.
    left_out : tuple of Record
        Those beyond the limits of the solvers, with the reason.
    """

    cases: tuple[Case, ...]
    left_out: tuple[Record, ...]


def plan(
    tabors: Sequence[float] | None = None,
    radius_ratios: Sequence[float] | None = None,
    poissons: Sequence[float] | None = None,
    *,
    quick: bool = False,
) -> Plan:
    """Plan of the study.

    Parameters
    ----------
    tabors, radius_ratios, poissons : sequence of float, optional
        All combinations of these but for spheres too small for their Tabor parameter, Poisson's ratio being 0.3 unless
        given. If none of the three is given, it is varied besides, at some points.
    quick : bool
        Three by three points unless given, at a lower accuracy.

    Raises
    ------
    InputError
        If an input is out of range, or a sphere is too small for every Tabor parameter.
    """
    asked = any(values is not None for values in (tabors, radius_ratios, poissons))
    main = _main_sweep(tabors, radius_ratios, poissons, quick)
    _require_inputs(main)
    sweeps = [main] if asked else _usual_sweeps(main, quick)
    rtol = QUICK_RTOL if quick else RTOL
    cases = tuple(dict.fromkeys(case for sweep in sweeps for case in _cases(sweep, rtol)))
    left_out = {case: record for case in cases if (record := _left_out(case))}
    return Plan(tuple(case for case in cases if case not in left_out), tuple(left_out.values()))


def _main_sweep(
    tabors: Sequence[float] | None,
    radius_ratios: Sequence[float] | None,
    poissons: Sequence[float] | None,
    quick: bool,
) -> Sweep:
    usual = ((0.3, 1.0, 2.0), (30.0, 300.0, 3e3)) if quick else (TABORS, RADIUS_RATIOS)
    return Sweep(tabors or usual[0], radius_ratios or usual[1], poissons or (POISSON,))


def _usual_sweeps(main: Sweep, quick: bool) -> list[Sweep]:
    """All of a study that nothing particular is asked of: some 700 s of work on two cores, or 20 s if quick."""
    dense = tuple(name for name in MODELS if name not in SPARSE)
    if quick:
        few = tuple(name for name in dense if name not in QUICK_SPARSE)
        return [replace(main, models=few), Sweep((1.0,), (30.0, 3e3), main.poissons, QUICK_SPARSE)]
    favoured = (0.3, 1.0, 3.0)
    return [
        replace(main, models=dense),
        Sweep(favoured, RADIUS_RATIOS, (POISSON,), ("surface_traction",)),
        Sweep(favoured, (30.0, 100.0, 1e3, 1e4), (POISSON,), FINITE_STRAIN),
        Sweep(favoured, (30.0, 1e3), POISSONS, dense),
    ]


def _require_inputs(sweep: Sweep) -> None:
    for tabor in sweep.tabors:
        require_tabor(tabor)
    for poisson in sweep.poissons:
        require_poisson(poisson)
    for ratio in sweep.radius_ratios:
        require_radius_ratio(ratio, min(sweep.tabors))


def _cases(sweep: Sweep, rtol: float) -> Iterator[Case]:
    points = product(sweep.tabors, sweep.radius_ratios, sweep.poissons)
    return (case_of(model, *point, rtol) for point in points for model in sweep.models)


def _left_out(case: Case) -> Record | None:
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
    cases: Sequence[Case],
    store: Store,
    *,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress = unheard,
    fresh: bool = False,
    work: Callable[[Case], Record] = compute,
) -> tuple[Record, ...]:
    """Compute the cases that the store does not hold, and store each at once.

    Parameters
    ----------
    cases : sequence of Case
        From `plan`.
    store : Store
        From `fem_adhesion.common.store.open_store`.
    jobs, dask : int and str, optional
        Local processes, or the address of a cluster: see `fem_adhesion.common.jobs.stream`.
    progress : callable
        Called with the last case, how many cases are done, and of how many.
    fresh : bool
        Compute all, whatever the store holds.
    work : callable
        Computes a case; a function of a module.

    Returns
    -------
    tuple of Record
        In the order of the cases. A case whose worker died is among them but not in the store: it is tried again when
        the study is resumed.

    Raises
    ------
    InputError
        Before any work, if jobs is not positive or the cluster does not answer.
    """
    records = {} if fresh else dict(_stored(cases, store))
    todo = [case for case in cases if case not in records]
    with closing(stream(work, todo, jobs=jobs, dask=dask)) as results:
        progress("starting", len(records), len(cases))
        for case, result in results:
            record = Record(case, "died", {}, result.reason) if isinstance(result, WorkerDied) else result
            if record.status in STORED:
                store.put(asdict(case), to_plain(record))
            records[case] = record
            progress(case.name, len(records), len(cases))
    return tuple(records[case] for case in cases)


def _stored(cases: Sequence[Case], store: Store) -> Iterator[tuple[Case, Record]]:
    """Cases that the store holds."""
    for case in cases:
        if (plain := store.get(asdict(case))) is None:
            continue
        try:
            yield case, from_plain(case, plain)
        except InputError as error:
            store.distrust(asdict(case), str(error))
