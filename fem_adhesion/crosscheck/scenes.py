"""Comparisons of scenes beside each other, in parts: the process that hands them out loads no solver."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain

from fem_adhesion.common.jobs import WorkerDied, stream
from fem_adhesion.crosscheck.comparison import Case, Failure
from fem_adhesion.scene import Scene
from halfspace.errors import NotConverged


@dataclass(frozen=True)
class Part:
    """A scene's comparison, or what needs no solution: that is the same for all blocks of a material, of tabor 1."""

    scene: Scene
    solved: bool


def run(
    scenes: Sequence[Scene], *, rtol: float = 1e-5, jobs: int | None = None, dask: str | None = None
) -> Iterator[Case | Failure]:
    """Compare scenes beside each other and give them in their order, each as soon as it and those before it are there.

    The comparison has the accuracy rtol; jobs are local processes and dask the address of a cluster, see
    `fem_adhesion.common.jobs.stream`. One scene needs no other process.
    """
    of_scenes = [
        (Part(scene if scene.sized else replace(scene, tabor=1.0), False), Part(scene, True)) for scene in scenes
    ]
    # Those that take longest first, of the sharpest contacts: the cores end together.
    parts = sorted(dict.fromkeys(chain.from_iterable(of_scenes)), key=lambda part: (part.solved, -part.scene.tabor))
    found: dict[Part, Case | Failure | WorkerDied] = {}
    jobs = 1 if jobs is None and len(scenes) == 1 else jobs
    with closing(stream(partial(_compared, rtol=rtol), parts, jobs=jobs, dask=dask)) as results:
        for before, solved in of_scenes:
            while not {before, solved} <= found.keys():
                part, found[part] = next(results)
            yield _whole(solved.scene, found[before], found[solved])


def _compared(part: Part, *, rtol: float) -> Case | Failure:
    """A part of a comparison, or why it failed."""
    from fem_adhesion.crosscheck import study  # where the work is done, and there alone

    try:
        if part.solved:
            return study.compare(part.scene, rtol=rtol, before=())
        return Case(part.scene, {}, tuple(study.unsolved(part.scene, rtol=rtol)))
    except NotConverged as error:
        return Failure(part.scene, str(error))


def _whole(scene: Scene, before: Case | Failure | WorkerDied, solved: Case | Failure | WorkerDied) -> Case | Failure:
    """Comparison of a scene by its parts."""
    if not isinstance(before, Case):
        return Failure(scene, before.reason)
    if not isinstance(solved, Case):
        return Failure(scene, solved.reason, before.rows)
    return replace(solved, rows=(*before.rows, *solved.rows))
