"""Make the atlas's files from `halfspace.trace`, or check it: ``python -m halfspace.atlas``, some minutes."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from functools import partial
from operator import itemgetter
from pathlib import Path

import numpy as np

from halfspace.atlas import build, build_curves
from halfspace.atlas.curves import curve
from halfspace.atlas.events import birth_of_folds
from halfspace.atlas.series import series_of, stored
from halfspace.values import Array, Estimate


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the files, or check them at random Tabor parameters; 1 if a number is off by more than both errors."""
    parser = argparse.ArgumentParser(prog="python -m halfspace.atlas", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent, help="directory of the files made")
    parser.add_argument("--nodes", type=Path, default=Path("build/atlas"), help="directory of the nodes solved so far")
    parser.add_argument("--check", type=int, metavar="N", help="compare them with the source at N Tabor parameters")
    parser.add_argument("--seed", type=int, default=1, help="of the Tabor parameters of --check")
    given = parser.parse_args(arguments)
    digest = build.digest()
    directory = given.nodes / digest
    directory.mkdir(parents=True, exist_ok=True)
    node = build.Store(directory / "events.jsonl", build.solved, lambda pair: Estimate(*pair))
    if given.check:
        return _check(node, build.sample(given.check, given.seed, birth_of_folds().value))
    content = build.built(node, digest)
    gap = series_of(content["series"]["zero_load.central_gap"])
    states = build.Store(directory / "curves.jsonl", partial(build_curves.states, gap=gap), np.array)
    curves = build_curves.built(states)
    text = json.dumps(content, separators=(",", ":")).replace('],"', '],\n"')
    (given.out / "atlas.json").write_text(text + "\n", encoding="utf-8")
    np.savez_compressed(given.out / "curves.npz", allow_pickle=False, **curves)
    for name in ("atlas.json", "curves.npz"):
        print(f"\n{given.out / name}: {(given.out / name).stat().st_size / 1000:.0f} kB", end="")
    print()
    return 0


def _check(node: build.Node, tabors: Array) -> int:
    """Print by number the largest deviation from the source, relative to its scale and to both errors."""
    points = [point for tabor in tabors.tolist() for point in build.compared(stored()["series"], node(tabor), tabor)]
    print(f"\n{'number':36}{'relative':>10}{'at tabor':>12}{'of errors':>11}{'at tabor':>12}")
    for name in sorted({point["number"] for point in points}):
        own = [point for point in points if point["number"] == name]
        off, share = (max(own, key=itemgetter(key)) for key in ("relative", "of_errors"))
        worst = f"{off['relative']:10.1e}{off['tabor']:12.6g}{share['of_errors']:11.2f}{share['tabor']:12.6g}"
        print(f"{name:36}{worst}")
    few = tabors[:: max(1, len(tabors) // 20)].tolist()
    relative, of_errors = map(max, zip(*(build_curves.deviations(tabor, curve(tabor)) for tabor in few), strict=True))
    print(f"{'curves at ' + str(len(few)) + ' of them':36}{relative:10.1e}{'':12}{of_errors:11.2f}")
    return int(max(of_errors, *(point["of_errors"] for point in points)) > 1)


if __name__ == "__main__":
    raise SystemExit(main())
