"""How error estimates are held against the truth: one scene at a time, and a table of the families of scenes.

A number is held if its true error is no more than its estimate and what is not known of its truth. A family is honest
if 99.5 % of its numbers are held and its median estimate is no more than a hundred times the true error. Each scene is
solved in a process of its own, which tells what memory and time it took.
"""

import json
import math
import multiprocessing
import os
import resource
import signal
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from multiprocessing.connection import wait
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from halfspace.errors import InputError, NotConverged
from halfspace.values import Estimate

HELD = 0.995  # part of the numbers that must be held
WIDEST = 100  # median estimate, in true errors
FEWEST = 30  # different numbers from which on a median tells more than one scene does
ROUNDED = 1e-11  # relative error that is taken for rounding
MEMORY, SECONDS = 1024, 60  # MiB and s of CPU that one scene may take at one tolerance
KILLED = 180  # s of CPU at which a scene at one tolerance is ended
Numbers = Mapping[str, Estimate]


class Net(NamedTuple):
    """Scenes, or a function that draws them by a random generator, and the tolerances at which each is solved."""

    scenes: Sequence[Any] | Callable[[Any], Sequence[Any]]
    rtols: Sequence[float]

    def of(self, seed, name, count=None):
        """Scenes of a seed; a family's name draws its own."""
        if not callable(self.scenes):
            return self.scenes
        random = np.random.default_rng([seed, *name.encode()])
        return self.scenes(random) if count is None else self.scenes(random, count=count)


@dataclass(frozen=True)
class Family:
    """Scenes of one kind.

    Attributes
    ----------
    full, quick : Net
        All scenes, and half a minute's part of them.
    solve : callable
        Answer to a scene at a tolerance: whatever carries its numbers.
    numbers : callable
        Numbers of an answer, with their estimates.
    truth : callable
        The same numbers of a scene, by its answer and tolerance; their errors say how well they are known.
    anew : bool
        Whether each tolerance needs a truth of its own, since its numbers are of places that no two share.
    share : float
        Part of the numbers that must be held.
    patience : float
        CPU s at which the search for a truth is given up.
    """

    full: Net
    quick: Net
    solve: Callable[[Any, float], Any]
    numbers: Callable[[Any], Numbers]
    truth: Callable[[Any, Any, float], Numbers]
    anew: bool = False
    share: float = HELD
    patience: float = 1800


class Judged(NamedTuple):
    """One number: its name, scene and tolerance, its estimate, its true error, how well that is known, its size."""

    what: str
    scene: str
    rtol: float
    estimate: float
    error: float
    known: float
    size: float

    @property
    def ratio(self):
        """True error, less what is not known of it, in estimates; infinite of a number that is not told or not true."""
        error = self.error - self.known
        if error <= 0 or math.inf in (self.estimate, self.known):
            return 0.0
        return error / self.estimate if self.estimate > 0 and not math.isnan(error) else math.inf

    @property
    def width(self):
        """Estimate in true errors, or in what is not known of these, or in rounding."""
        return self.estimate / max(self.error, self.known, ROUNDED * self.size)


def judge(told, truth, scene="", rtol=math.nan):
    """Each number beside its truth; one that the truth lacks, or has beyond them, is held by no estimate."""
    found = []
    for what in sorted(told.keys() | truth.keys()):
        number, true = told.get(what, Estimate(math.nan, 0.0)), truth.get(what, Estimate(math.nan, 0.0))
        error = abs(number.value - true.value)
        lost = math.isnan(error) and true.error != math.inf
        error = math.inf if lost else error
        found.append(Judged(what, scene, rtol, number.error, error, true.error, abs(true.value)))
    return found


# One scene


class Answered(NamedTuple):
    """What one scene of a family came to, at all its tolerances."""

    numbers: Sequence[Judged] = ()
    ends: Sequence[str] = ()
    seconds: float = 0.0
    memory: float = 0.0
    every: float = 0.0


def answer(family, scene, rtols):
    """Judge a scene at all tolerances, and measure what it takes."""
    began, answers, ends, seconds = time.process_time(), {}, [], [0.0]
    inherited = _peak_memory()  # a fork begins with all that its parent holds, 1.3 GB in a worker of the tests
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        for rtol in rtols:
            start = time.process_time()
            ended = _attempt(lambda rtol=rtol: answers.update({rtol: family.solve(scene, rtol)}), KILLED)
            seconds.append(time.process_time() - start)
            ends += [f"{ended}: {shown(scene)} at rtol {rtol:g}"] if ended else []
        memory = _peak_memory() - inherited
        numbers = []
        if answers:
            ended = _attempt(lambda: numbers.extend(_against_truth(family, scene, answers)), family.patience)
            ends += [f"{ended}: truth of {shown(scene)}"] if ended else []
    ends += [f"WARNED: {w.message}: {shown(scene)}" for w in heard]
    return Answered(numbers, ends, max(seconds), memory, time.process_time() - began)


def _peak_memory():
    """Most memory that this process has held, MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


class TooLong(Exception):
    """A piece of work takes more time than it may."""


def _too_long(*_):
    raise TooLong


def _attempt(work, seconds):
    """How a piece of work ended within some CPU s: nothing, a refusal, or a defect with the end of its traceback."""
    signal.signal(signal.SIGPROF, _too_long)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        work()
    except (InputError, NotConverged) as why:
        return f"{type(why).__name__}: {why}"
    except TooLong:
        return f"more than {seconds} s"
    except Exception:
        return f"DEFECT: {traceback.format_exc(limit=-3)}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return ""


def _against_truth(family, scene, answers):
    shared = None if family.anew else family.truth(scene, answers[min(answers)], min(answers))
    for rtol, found in answers.items():
        truth = shared or family.truth(scene, found, rtol)
        yield from judge(family.numbers(found), truth, shown(scene), rtol)


def shown(scene):
    """Show of a scene or contact what is not as usual."""
    if not is_dataclass(scene):
        return str(scene)
    usual = {f.name: f.default for f in fields(scene)}
    return ", ".join(f"{n} = {getattr(scene, n)}" for n in usual if getattr(scene, n) != usual[n])


# Many scenes


def each(work, items, jobs=None):
    """Do a piece of work for each item in a process of its own; pairs of item and result, None of one that died."""
    fork = multiprocessing.get_context("fork")
    jobs = jobs or int(os.environ.get("LOKY_MAX_CPU_COUNT", 0)) or os.cpu_count()
    waiting, running = list(reversed(items)), {}
    while waiting or running:
        while waiting and len(running) < jobs:
            here, there = fork.Pipe(duplex=False)
            process = fork.Process(target=_child, args=(there, work, waiting[-1]))
            process.start()
            there.close()
            running[here] = process, waiting.pop()
        for pipe in wait(running):
            process, item = running.pop(pipe)
            try:
                result = pipe.recv()
            except EOFError:
                result = None
            process.join()
            yield item, result


def _child(pipe, work, item):
    pipe.send(work(item))


@dataclass
class Row:
    """What the table says of a family."""

    name: str
    share: float = HELD
    drawn: bool = False
    numbers: list[Judged] = field(default_factory=list)
    ends: list[str] = field(default_factory=list)
    costs: list[tuple[float, float, float]] = field(default_factory=list)

    def add(self, answered):
        """Count a scene."""
        self.numbers += answered.numbers
        self.ends += answered.ends
        self.costs.append((answered.seconds, answered.memory, answered.every))

    @property
    def outside(self):
        """Numbers that their estimates do not hold, the worst first."""
        return sorted((n for n in self.numbers if n.ratio > 1), key=lambda n: -n.ratio)

    @property
    def width(self):
        """Median estimate in true errors."""
        return median([n.width for n in self.numbers if math.isfinite(n.width)] or [math.nan])

    @property
    def faults(self):
        """Ends that no scene may come to: drawn ones may be refused, or not solved."""
        return [end for end in self.ends if not self.drawn or end.startswith(("DEFECT", "WARNED", "DIED"))]

    @property
    def heavy(self):
        """Scenes that take more than one may."""
        return [cost for cost in self.costs if cost[0] > SECONDS or cost[1] > MEMORY]

    @property
    def honest(self):
        """Whether all is as it should be; of a few numbers one may lie outside, and their median says nothing.

        What two tolerances give alike, since one grid serves both, is one number.
        """
        different, outside = ({n._replace(rtol=0.0) for n in some} for some in (self.numbers, self.outside))
        few = len(outside) <= (max(1, int((1 - self.share) * len(different))) if self.share < 1 else 0)
        wide = len(different) >= FEWEST and self.width > WIDEST
        return few and not wide and not self.faults and not self.heavy

    def __str__(self):
        """One line of the table."""
        held = 1 - len(self.outside) / max(len(self.numbers), 1)
        seconds, memory, _ = (max(costs, default=0.0) for costs in zip(*self.costs, strict=True))
        worst = max((n.ratio for n in self.numbers), default=0.0)
        return (
            f"{self.name:26}{len(self.numbers):8}{held:9.2%}{worst:8.2g}{self.width:8.3g}"
            f"{sum(cost[2] for cost in self.costs):8.0f}{seconds:8.1f}{memory:7.0f}"
        )


HEAD = f"{'family':26}{'numbers':>8}{'within':>9}{'worst':>8}{'median':>8}{'CPU s':>8}{'most s':>8}{'MiB':>7}"


def rows_of(families, net="quick", seed=0, *, count=None, file=None, until=math.inf, jobs=None):
    """Rows of some families by name, in the order in which they end.

    Drawn scenes are so many if a count is given. What a file has of this seed is not done again, and what is done is
    added to it; scenes that are not begun by a time of the clock are left out.
    """
    nets = {name: getattr(family, net) for name, family in families.items()}
    scenes = {name: one.of(seed, name, count) for name, one in nets.items()}
    rows = {name: Row(name, f.share, callable(f.full.scenes)) for name, f in families.items()}
    left = Counter({name: len(found) for name, found in scenes.items()})
    known = _read(file)
    items = [(name, place) for name in families for place in range(len(scenes[name]))]

    def work(item):
        if time.time() > until:
            return "late"
        return answer(families[item[0]], scenes[item[0]][item[1]], nets[item[0]].rtols)

    done = ((item, known[seed, *item]) for item in items if (seed, *item) in known)
    to_do = each(work, [item for item in items if (seed, *item) not in known], jobs)
    for again, results in ((True, done), (False, to_do)):
        for (name, place), found in results:
            left[name] -= 1
            if found != "late":
                result = found or Answered(ends=[f"DIED: {shown(scenes[name][place])}"])
                rows[name].add(result)
                if file and not again:
                    with Path(file).open("a") as out:
                        out.write(json.dumps([[seed, name, place], *result]) + "\n")
            if not left[name] and rows[name].costs:
                yield rows[name]


def _read(file):
    """Scenes in a file, by seed, family and place."""
    lines = Path(file).read_text().splitlines() if file and Path(file).exists() else []
    found = defaultdict(Answered)
    for key, numbers, *rest in map(json.loads, lines):
        found[tuple(key)] = Answered([Judged(*n) for n in numbers], *rest)
    return found


def printed(row, most=12):
    """Print one row, and what lies outside or ended otherwise than it may."""
    print(row, flush=True)
    for n in row.outside[:most]:
        known = f", known to {n.known:.1e}" if n.known > 0.1 * n.estimate else ""
        print(f"    {n.ratio:.3g} times {n.estimate:.1e}{known}: {n.what} of {n.scene} at rtol {n.rtol:g}")
    for end in sorted({*row.ends}, key=lambda end: end not in row.faults)[:most]:
        print(f"    {end}")
    if row.heavy:
        print(f"    {len(row.heavy)} scenes above {SECONDS} s or {MEMORY} MiB", flush=True)
    return row
