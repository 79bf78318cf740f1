"""Make the atlas's file from `halfspace.trace`, or check it: ``python -m halfspace.atlas``, a minute or two."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

from halfspace.atlas import build
from halfspace.atlas.events import birth_of_folds
from halfspace.atlas.series import stored
from halfspace.values import Array


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the file, or check it at random Tabor parameters; 1 if a number is off by more than both errors."""
    parser = argparse.ArgumentParser(prog="python -m halfspace.atlas", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).with_name("atlas.json"), help="file that is made")
    parser.add_argument("--nodes", type=Path, default=Path("build/atlas"), help="directory of the nodes solved so far")
    parser.add_argument("--check", type=int, metavar="N", help="compare the file with the source at N Tabor parameters")
    parser.add_argument("--seed", type=int, default=1, help="of the Tabor parameters of --check")
    given = parser.parse_args(arguments)
    given.nodes.mkdir(parents=True, exist_ok=True)
    node = build.Store(given.nodes / f"{build.digest()}.jsonl", _told)
    if given.check:
        return _check(node, build.sample(given.check, given.seed, birth_of_folds().value))
    content = build.built(node)
    given.out.write_text(json.dumps(content, separators=(",", ":")).replace('],"', '],\n"') + "\n", encoding="utf-8")
    print(f"\n{given.out}: {given.out.stat().st_size / 1000:.0f} kB")
    return 0


def _told(count: int, tabor: float) -> None:
    print(f"\r{count} nodes, the last at tabor {tabor:.4g}   ", end="", flush=True)


def _check(node: build.Node, tabors: Array) -> int:
    """Print by number the largest deviation from the source, relative to its scale and to both errors."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for tabor in tabors.tolist():
        for name, off in build.deviations(stored()["series"], node(tabor), tabor).items():
            rows.setdefault(name, []).append((off.relative, off.of_errors, tabor))
    print(f"\n{'number':36}{'relative':>10}{'at tabor':>12}{'of errors':>11}{'at tabor':>12}")
    for name, found in rows.items():
        relative, share = max(found), max(found, key=lambda row: row[1])
        print(f"{name:36}{relative[0]:10.1e}{relative[2]:12.6g}{share[1]:11.2f}{share[2]:12.6g}")
    return int(any(share > 1 for found in rows.values() for _, share, _ in found))


if __name__ == "__main__":
    raise SystemExit(main())
