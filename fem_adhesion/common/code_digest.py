"""A digest of the code that computes something: two results of the same inputs and digest are the same.

The code is read, not run: it is that of the module asked for and of all modules of this project that it imports, at
whatever place and through whatever others; of the packages of `WHOLE`, all modules. The versions of the libraries that
compute with it count as code.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator, Sequence
from functools import cache
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

PROJECT = ("fem_adhesion", "halfspace")
WHOLE = ("halfspace",)
LIBRARIES = ("numpy", "scipy", "scikit-fem")


@cache
def code_digest(module: str) -> str:
    """Digest, 16 hexadecimal digits, of the code that a module of this project runs.

    Parameters
    ----------
    module : str
        Its full name.
    """
    found = hashlib.sha256()
    for name, file in sorted(sources(module).items()):
        found.update(f"{name} {hashlib.sha256(file.read_bytes()).hexdigest()}\n".encode())
    for library in LIBRARIES:
        found.update(f"{library} {version(library)}\n".encode())
    return found.hexdigest()[:16]


def sources(module: str) -> dict[str, Path]:
    """Files of a module of this project and of all others of it that it imports, by their full names."""
    found: dict[str, Path] = {}
    waiting = [module, *(name for package in WHOLE for name in _modules(package))]
    while waiting:
        name = waiting.pop()
        file = _file(name)
        if file is None or name in found:
            continue
        found[name] = file
        waiting += _imported(file)
    return found


def _modules(package: str) -> Iterator[str]:
    folder = _folder(package)
    for file in folder.rglob("*.py"):
        parts = file.relative_to(folder).with_suffix("").parts
        yield ".".join((package, *parts[: -1 if parts[-1] == "__init__" else None]))


def _imported(file: Path) -> Iterator[str]:
    """What may be modules among the names that a file imports, and the packages that they are in."""
    for node in ast.walk(ast.parse(file.read_bytes())):
        names: Sequence[str] = ()
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        for name in names:
            parts = name.split(".")
            yield from (".".join(parts[: n + 1]) for n in range(len(parts)))


def _file(name: str) -> Path | None:
    """File of a module of this project; None of what is none, as a function that is imported from one."""
    package, *parts = name.split(".")
    if package not in PROJECT:
        return None
    place = _folder(package).joinpath(*parts)
    return next((file for file in (place / "__init__.py", place.with_suffix(".py")) if file.is_file()), None)


@cache
def _folder(package: str) -> Path:
    """Folder of a package, wherever it is installed."""
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"{package} is not installed as files")
    return Path(spec.origin).parent
