"""``make gallery``: pictures that are kept beside the pages, drawn anew where the code that draws them has changed.

All others are drawn while the site is built. A digest of the code that draws a picture is kept with it, by which
`outdated` knows those that are older than that code.
"""

import ast
import hashlib
import json
import shlex
import sys
import tempfile
from contextlib import chdir
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
COLOURS = 128  # of a kept picture, which makes it a third as large
DIGESTS = HERE / "digests.json"
FIGURES = ["1a", "1b", "1c", "2a", "2b", "3a", "3b", "3c", "4a", "4b", "5", "6a", "6b", "7"]

DRAWN = {
    "fem-adhesion curve --tabor 2 --plot curve.png": (
        ["curve"],
        ["fem_adhesion/curve/figure.py", "fem_adhesion/common/style.py"],
    ),
    "fem-adhesion greenwood --out .": (
        [f"fig_{number}" for number in FIGURES],
        [
            "fem_adhesion/greenwood/data/figures.toml",
            "fem_adhesion/greenwood/figures.py",
            "fem_adhesion/greenwood/drawing.py",
            "fem_adhesion/common/style.py",
        ],
    ),
}
"""By the command that draws them: pictures, and files of the code that does; what is computed for them counts not."""


def digest(files):
    """Digest of what the code in files does: its comments and line breaks do not count."""
    texts = [(ROOT / file).read_text(encoding="utf-8") for file in files]
    code = [
        ast.dump(ast.parse(text)) if file.endswith(".py") else text for file, text in zip(files, texts, strict=True)
    ]
    return hashlib.sha256("".join(code).encode()).hexdigest()[:16]


def outdated():
    """Command lines whose pictures are older than the code that draws them."""
    kept = json.loads(DIGESTS.read_text()) if DIGESTS.exists() else {}
    return [line for line, (_, files) in DRAWN.items() if kept.get(line) != digest(files)]


def make(line):
    """Run a command line in an empty directory, take its pictures from there, and keep the digest."""
    from PIL import Image

    from fem_adhesion import cli

    names, files = DRAWN[line]
    with tempfile.TemporaryDirectory() as place, chdir(place):
        code = cli.main(shlex.split(line)[1:])
        if code:
            sys.exit(code)
        for name in names:
            Image.open(f"{name}.png").convert("RGB").quantize(COLOURS).save(HERE / f"{name}.png", optimize=True)
    kept = json.loads(DIGESTS.read_text()) if DIGESTS.exists() else {}
    DIGESTS.write_text(json.dumps(kept | {line: digest(files)}, indent=1) + "\n")


if __name__ == "__main__":
    for line in list(DRAWN) if "--all" in sys.argv else outdated():
        print(line, flush=True)
        make(line)
