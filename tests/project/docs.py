"""``make docs``: pages of both packages, from their docstrings."""

import pkgutil
import sys
from dataclasses import is_dataclass
from importlib import import_module
from inspect import isclass
from pathlib import Path
from typing import get_type_hints

import pdoc

import fem_adhesion
import halfspace


def packages():
    """Both packages, with what they import late and what lies in them where pdoc looks for it."""
    for package in (halfspace, fem_adhesion):
        vars(package).update({name: getattr(package, name) for name in package.__all__})
        for room in (package, *rooms(package)):
            room.__all__ += [module.name for module in pkgutil.iter_modules(room.__path__) if module.name[0] != "_"]
        name_types(package)
        yield package.__name__


def rooms(package):
    """Packages in a package that say what is public, where pdoc would look for nothing else."""
    inner = (import_module(f"{package.__name__}.{m.name}") for m in pkgutil.iter_modules(package.__path__) if m.ispkg)
    return [room for room in inner if hasattr(room, "__all__")]


def name_types(package):
    """Tell constructors the types of fields that they inherit, whose names their own module need not know."""
    modules = [m.name for m in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")]
    for module in (import_module(name) for name in modules if not name.endswith("__main__")):
        for kind in filter(is_dataclass, filter(isclass, vars(module).values())):
            known, own = kind.__init__.__annotations__, vars(kind).get("__annotations__", {})
            for base in kind.__mro__[1:]:
                if is_dataclass(base) and base.__module__ != kind.__module__:
                    types = get_type_hints(base.__init__)
                    known.update({name: types[name] for name in types.keys() & known.keys() - own.keys()})


if __name__ == "__main__":
    whole = "--quick" not in sys.argv
    pdoc.render.configure(docformat="numpy", math=True, show_source=whole, search=whole)
    directory = Path(sys.argv[1])
    pdoc.pdoc(*packages(), output_directory=directory)
    print(f"written: {directory / 'index.html'}")
