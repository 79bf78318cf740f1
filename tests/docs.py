"""``make docs``: pages of both packages, from their docstrings."""

import pkgutil
import sys
from importlib import import_module
from pathlib import Path

import pdoc

import fem_adhesion
import halfspace


def packages():
    """Both packages, with what they import late and what lies in them where pdoc looks for it."""
    for package in (halfspace, fem_adhesion):
        vars(package).update({name: getattr(package, name) for name in package.__all__})
        for room in (package, *rooms(package)):
            room.__all__ += [module.name for module in pkgutil.iter_modules(room.__path__) if module.name[0] != "_"]
        yield package.__name__


def rooms(package):
    """Packages in a package that say what is public, where pdoc would look for nothing else."""
    inner = (import_module(f"{package.__name__}.{m.name}") for m in pkgutil.iter_modules(package.__path__) if m.ispkg)
    return [room for room in inner if hasattr(room, "__all__")]


if __name__ == "__main__":
    pdoc.render.configure(docformat="numpy", math=True, show_source="--quick" not in sys.argv)
    directory = Path(sys.argv[1])
    pdoc.pdoc(*packages(), output_directory=directory)
    print(f"written: {directory / 'index.html'}")
