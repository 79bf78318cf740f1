"""Comparisons of scenes beside each other, in parts: the process that hands them out loads no solver."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial
from itertools import chain

from fem_adhesion.common.jobs import Progress, WorkerDied, stream, unheard
from fem_adhesion.crosscheck.comparison import Case
from fem_adhesion.scene import Scene
from halfspace.errors import tried

Part = tuple[Scene, bool]
"""A scene, and whether it is to be solved; the rows that need no solution are those of tabor 1 for all blocks of a
material."""


def run(
    scenes: Sequence[Scene],
    *,
    rtol: float = 1e-5,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress = unheard,
) -> list[Case]:
    """Compare scenes beside each other, and return the comparisons in their order.

    The comparison has the accuracy rtol; jobs are local processes and dask the address of a cluster, see
    `fem_adhesion.common.jobs.stream`. One scene needs no other process. `progress` is called as the scenes are done.
    """
    of_scenes = [((scene if scene.sized else replace(scene, tabor=1.0), False), (scene, True)) for scene in scenes]
    # Those that take longest first, of the sharpest contacts: the cores end together.
    parts = sorted(dict.fromkeys(chain.from_iterable(of_scenes)), key=lambda part: (part[1], -part[0].tabor))
    found, cases = dict[Part, Case](), list[Case]()
    jobs = 1 if jobs is None and len(scenes) == 1 else jobs
    with closing(stream(partial(_compared, rtol=rtol), parts, jobs=jobs, dask=dask)) as results:
        for before, solved in of_scenes:
            progress(f"tabor {solved[0].tabor:g}", len(cases), len(scenes))
            while not {before, solved} <= found.keys():
                part, case = next(results)
                found[part] = Case(part[0], reason=case.reason) if isinstance(case, WorkerDied) else case
            first, second = found[before], found[solved]
            solutions = {} if first.reason else second.solutions
            cases.append(Case(solved[0], solutions, (*first.rows, *second.rows), first.reason or second.reason))
    return cases


def _compared(part: Part, *, rtol: float) -> Case:
    """A part of a comparison, or why it failed."""
    from fem_adhesion.crosscheck import study  # where the work is done, and there alone

    scene, solved = part
    if not solved:
        return Case(scene, rows=tuple(study.unsolved(scene, rtol=rtol)))
    case = tried(study.compare, scene, rtol=rtol, before=())
    return case or Case(scene, reason=case.reason)
