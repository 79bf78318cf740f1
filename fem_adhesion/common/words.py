"""Parts of a scene in one word, as ``layer:2,sliding``: a name and, after a colon, the parameters between commas.

Which parameters a part takes, in which order, stands in `fem_adhesion.registry.PARTS`; a choice, such as ``sliding``,
may stand anywhere among them. Strata come from the surface down between slashes, what carries them last:
``layers:0.4,0.3/0.5,0.45,2/substrate:5,0.1`` has strata of thickness, Poisson's ratio and modulus.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from fem_adhesion.registry import PARTS
from halfspace.errors import InputError, nearest

Length = Callable[[str, str], float]
"""Takes the name of a length and its text, and gives it in beta; a length of a law in eps."""


def in_beta(name: str, text: str, unit: str = "beta") -> float:
    """Length, or what has another unit, that is a plain number."""
    try:
        return float(text)
    except ValueError as error:
        raise InputError(f"{name} = {text} is not a plain number in {unit}; give one, or a material") from error


def part_in(
    kind: str, word: str, length: Length = in_beta, known: Mapping[str, object] | None = None, /, **given: Any
) -> Any:
    """Part of a kind from its word.

    The word does not give what is `known`, as R/eps of a material is; what is `given` besides holds unless the word
    says otherwise. InputError, with what the part takes, if the word lacks something or has something too much.
    """
    name, _, rest = word.partition(":")
    if name not in PARTS[kind]:
        near = nearest(name, PARTS[kind])
        remedy = f"did you mean {usage(kind, near)}?" if near else "take one of these"
        raise InputError(f"{kind} = {name}, limit: one of {', '.join(PARTS[kind])}; {remedy}")
    part, known = PARTS[kind][name], known or {}
    own = {parameter: unit for parameter, unit in part.parameters.items() if parameter not in known}
    values = _strata(rest, length, given) if name == "layers" else _values(kind, word, own, length)
    takes = {field.name: field for field in fields(part.made_by)}
    values = {parameter: value for parameter, value in {**known, **given}.items() if parameter in takes} | values
    for parameter, unit in own.items():
        if parameter not in values and takes[parameter].default is MISSING:
            raise InputError(f"{kind} = {word}, limit: {usage(kind, name, own)}; give {parameter}, {unit}")
    return part.made_by(**values)


def usage(kind: str, name: str, own: Mapping[str, str] | None = None) -> str:
    """How the word of a part is written."""
    if name == "layers":
        return "layers:thickness,poisson,modulus/.../BASE, BASE being bonded|sliding|substrate:modulus,poisson"
    taken = PARTS[kind][name].parameters if own is None else own
    words = [unit.replace(" or ", "|") if " or " in unit else each for each, unit in taken.items()]
    return f"{name}:{','.join(words)}".rstrip(":")


def _values(kind: str, word: str, own: Mapping[str, str], length: Length) -> dict[str, Any]:
    """Values of the parameters that a word gives."""
    name, _, rest = word.partition(":")
    # The name of a file may have commas in it, and comes first.
    texts = rest.rsplit(",", max(len(own) - 1, 0)) if "file" in own.values() else rest.split(",")
    choices = {choice: each for each, unit in own.items() if " or " in unit for choice in unit.split(" or ")}
    numbers, values = iter(each for each in own if each not in choices.values()), dict[str, Any]()
    for text in filter(None, texts):
        each = choices.get(text) or next(numbers, None)
        if each is None or each in values:
            raise InputError(f"{kind} = {word}, limit: {usage(kind, name, own)}; leave out {text}")
        values[each] = text if text in choices else _value(each, own[each], text, length)
    return values


def _value(name: str, unit: str, text: str, length: Length) -> float | Path:
    if unit == "file":
        return Path(text)
    if unit == "beta":
        return length(name, text)
    try:
        return float(text)
    except ValueError as error:
        if unit in ("eps", "1/eps") and length is not in_beta:
            return length(name, text) if unit == "eps" else 1 / length(name, text)
        raise InputError(f"{name} = {text}, limit: a plain number{unit and f', in {unit}'}; give one") from error


def _strata(rest: str, length: Length, given: Mapping[str, object]) -> dict[str, Any]:
    """Strata and what carries them; a stratum without a Poisson's ratio has the body's."""
    *strata, last = rest.split("/")
    base: Any = last
    if not last[:1].isalpha():
        strata, base = [*strata, last], "bonded"
    elif last not in ("bonded", "sliding"):
        base = part_in("base", last)
    if not all(strata) or not strata:
        raise InputError(f"body = layers:{rest}, limit: {usage('body', 'layers')}; give a stratum")
    own = {name: given[name] for name in ("poisson",) if given.get(name) is not None}
    return {"strata": tuple(part_in("strata", f"stratum:{one}", length, **own) for one in strata), "base": base}
