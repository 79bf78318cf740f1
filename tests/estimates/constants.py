"""What each number of an algorithm decides, at its half and at its double.

Settings are frozen dataclasses, all fields of which have defaults; numbers that stand in modules are none. In a process
of its own a field of every instance is replaced, the quick nets of some families are solved, and with the field as it
was their truths are found. A row says how many numbers are within their estimates, by how much the worst is off, how
wide the median estimate is, and what it cost. A field whose rows are all like the usual ones decides nothing that these
families can tell.
"""

import gc
import importlib
import pkgutil
import sys
import time
from dataclasses import MISSING, fields, is_dataclass
from functools import cache

from families import FAMILIES
from judging import Row, each, judge, shown

import fem_adhesion
import halfspace
from halfspace.errors import InputError, NotConverged

FACTORS = (1.0, 0.5, 2.0)
BY_ROOM = {  # families that a room's settings decide
    "halfspace.elastic": ("layers", "sphere's profile"),
    "halfspace": ("half-space", "laws and profiles", "sphere's profile", "layers"),
    "fem_adhesion.bodies.layers": ("layers by elements",),
    "fem_adhesion.discretise": ("block", "hemisphere, bonded", "layers by elements"),
    "fem_adhesion.finite_strain": ("finite strain",),
}


@cache
def settings():
    """Every field with a number, as ``Class.field``, with its class, of the rooms of both solvers."""
    found = {}
    for package in (halfspace, fem_adhesion):
        names = [m.name for m in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")]
        for name in names:
            if name.startswith(tuple(BY_ROOM)):
                found |= {one: kind for kind in _kinds(importlib.import_module(name)) for one in _numbers(kind)}
    return dict(sorted(found.items()))


def _kinds(module):
    own = [kind for kind in vars(module).values() if isinstance(kind, type) and kind.__module__ == module.__name__]
    return [kind for kind in own if is_dataclass(kind) and kind.__name__.endswith("Settings")]


def _numbers(kind):
    return [f"{kind.__name__}.{f.name}" for f in fields(kind) if f.default is not MISSING and _is_number(f.default)]


def _is_number(value):
    values = value if isinstance(value, tuple) else (value,)
    return bool(values) and all(isinstance(one, int | float) and not isinstance(one, bool) for one in values)


def changed(value, factor):
    """A number times a factor; of ratios between 1 and 2, which tell by how much they exceed 1, that excess."""
    if isinstance(value, tuple):
        return tuple(changed(one, factor) for one in value)
    if isinstance(value, int):
        return max(1, round(value * factor))
    return 1 + (value - 1) * factor if 1 < value < 2 else value * factor


def replaced(kind, name, factor):
    """Replace a field of every instance of a class; how each was."""
    usual = [(one, getattr(one, name)) for one in gc.get_objects() if type(one) is kind]
    for one, value in usual:
        object.__setattr__(one, name, changed(value, factor))
    return usual


def families_of(kind):
    """Families that a class decides: those of the longest beginning of its module's name."""
    return next(families for room, families in BY_ROOM.items() if kind.__module__.startswith(room))


def measured(item):
    """Rows of a field times a factor, each with the CPU s that it took without the truths."""
    field, factor = item
    kind, rows = settings()[field], []
    for name in families_of(kind):
        family, row, seconds = FAMILIES[name], Row(name), 0.0
        for scene in family.quick.of(0, name):
            usual, began, answers = replaced(kind, field.split(".")[1], factor), time.process_time(), {}
            for rtol in family.quick.rtols:
                try:
                    answers[rtol] = family.solve(scene, rtol)
                    answers[rtol] = answers[rtol], family.numbers(answers[rtol])
                except (InputError, NotConverged) as why:
                    row.ends.append(f"{shown(scene)} at rtol {rtol:g}: {why}")
                    answers.pop(rtol, None)
            seconds += time.process_time() - began
            for one, value in usual:
                object.__setattr__(one, field.split(".")[1], value)
            for rtol, (found, numbers) in answers.items():
                row.numbers += judge(numbers, family.truth(scene, found, rtol), shown(scene), rtol)
        rows.append((row, seconds))
    return rows


def measure(names=None, random=None, count=5):
    """Print rows of the fields named, of so many drawn at random, or of all; 1 if a name is none."""
    known = settings()
    chosen = [field for field in known if not names or field in names or field.split(".")[0] in names]
    if random is not None and chosen:
        chosen = sorted(random.choice(chosen, min(count, len(chosen)), replace=False).tolist())
    if unknown := set(names or ()) - {part for field in known for part in (field, field.split(".")[0])}:
        print(f"no field {', '.join(sorted(unknown))}; there are {', '.join(known)}", file=sys.stderr)
        return 1
    print(f"{'field, family':56}{'times':>6}{'numbers':>8}{'within':>9}{'worst':>8}{'median':>8}{'CPU s':>8}")
    for (field, factor), rows in each(measured, [(field, factor) for field in chosen for factor in FACTORS]):
        for row, seconds in rows or ():
            held = 1 - len(row.outside) / max(len(row.numbers), 1)
            worst = max((n.ratio for n in row.numbers), default=0.0)
            numbers = f"{len(row.numbers):8}{held:9.2%}{worst:8.2g}{row.width:8.3g}{seconds:8.1f}"
            print(f"{f'{field}, {row.name}':56}{factor:6g}{numbers}", flush=True)
            for end in row.ends:
                print(f"    not solved: {end}")
        if rows is None:
            print(f"{field:56}{factor:6g} DIED", flush=True)
    return 0
