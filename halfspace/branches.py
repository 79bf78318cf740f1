"""Branches of a curve along which a coordinate goes in one direction: their names, and the one that is asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from halfspace.errors import InputError

ENDS = ("separated", "contact")
WHOLE = "whole"


def branch_names(count: int) -> Sequence[str]:
    """Names of branches in order: of one that is the whole curve, of two that meet, or with unstable ones between."""
    if count < 3:
        return ENDS if count == 2 else (WHOLE,)
    inner = ["unstable"] if count == 3 else [f"unstable {i + 1}" for i in range(count - 2)]
    return (ENDS[0], *inner, ENDS[1])


def chosen_branch(
    ranges: Mapping[str, tuple[float, float]], coordinate: str, unit: str, value: float, branch: str | None
) -> str:
    """Name of the branch that is asked for, if it has the value, or of the only one that has; InputError otherwise."""
    if branch and branch not in ranges and not (branch in ENDS and WHOLE in ranges):
        raise InputError(f'branch = "{branch}" is none of {", ".join(ranges)} of the {coordinate}; take one of these')
    names = [branch] if branch and branch in ranges else list(ranges)
    having = [name for name in names if ranges[name][0] <= value <= ranges[name][1]]
    if len(having) > 1:
        raise InputError(
            f"{coordinate} = {value:g} {unit} is met on {', '.join(having)}, limit: one; name it by branch"
        )
    if not having:
        low, high = min(ranges[name][0] for name in names), max(ranges[name][1] for name in names)
        where = f"on {names[0]}" if len(names) == 1 else "on this curve"
        raise InputError(
            f"{coordinate} = {value:g} is outside {low:.6g} <= {coordinate} <= {high:.6g} {unit} {where}; take one "
            "inside"
        )
    return having[0]
