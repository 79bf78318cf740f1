"""Estimates against the truth: ``python tests/estimates honesty``, ``hard``, ``constants`` or ``intervals``.

``honesty`` judges families of scenes, all or those named; ``hard`` attempts the hard cases; ``constants`` measures what
each number of an algorithm decides; ``intervals`` judges those of fitted curves. A full run of ``honesty`` ends with
five of the constants, drawn. A campaign of random scenes, which goes on where it was ended: ``honesty --families
"half-space, random" --count 500 --seed 7 --file F``.
"""

import argparse
import secrets
import sys
import time
from importlib import import_module
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "helpers"))


def honesty(asked):
    """Print a table of the families; 1 if one is not honest."""
    from families import FAMILIES
    from judging import HEAD, printed, rows_of

    seed = secrets.randbelow(10**6) if asked.seed is None else asked.seed
    net = "quick" if asked.quick else "full"
    chosen = {name: FAMILIES[name] for name in asked.families or FAMILIES}
    chosen = {name: family for name, family in chosen.items() if getattr(family, net).scenes}
    print(f"{HEAD}    seed {seed}", flush=True)
    until = time.time() + 60 * asked.minutes
    rows = rows_of(chosen, net, seed, count=asked.count, file=asked.file, until=until, jobs=asked.jobs)
    dishonest = [row.name for row in rows if not printed(row).honest]
    if not asked.quick and not asked.families:
        from constants import measure

        measure(random=np.random.default_rng(seed))
    print(f"not honest: {', '.join(dishonest) or 'none'}")
    return int(bool(dishonest))


def main(arguments=None):
    """Run what is asked for, of which no more is loaded; exit code 1 if something is not as it should be."""
    parser = argparse.ArgumentParser(prog="tests/estimates", description=__doc__)
    tools = parser.add_subparsers(required=True)
    tool = tools.add_parser("honesty")
    tool.set_defaults(run=honesty)
    tool.add_argument("--quick", action="store_true", help="half a minute's part")
    tool.add_argument("--seed", type=int, help="of the scenes that are drawn; a new one unless given")
    tool.add_argument("--families", nargs="+", metavar="FAMILY")
    tool.add_argument("--count", type=int, help="of the scenes that are drawn, in each family")
    tool.add_argument("--file", type=Path, help="where results are kept, and read if they are there")
    tool.add_argument("--minutes", type=float, default=float("inf"), help="after which no scene is begun")
    tool.add_argument("--jobs", type=int, help="processes; as many as processors unless given")
    tool = tools.add_parser("hard")
    tool.set_defaults(run=lambda asked: import_module("hard").attempt_all(asked.out))
    tool.add_argument("out", type=Path, help="directory to write")
    tool = tools.add_parser("constants")
    tool.set_defaults(run=lambda asked: import_module("constants").measure(asked.names))
    tool.add_argument("--names", nargs="+", metavar="NAME", help="Class or Class.field; all unless given")
    tool = tools.add_parser("intervals")
    tool.set_defaults(run=lambda asked: import_module("intervals").judge(asked.count))
    tool.add_argument("--count", type=int, default=200, help="of the curves")
    asked = parser.parse_args(arguments)
    return asked.run(asked)


if __name__ == "__main__":
    sys.exit(main())
