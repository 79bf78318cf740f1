"""Pictures as part of a page: the SVG itself, with a text alternative, and nothing that leaks into the page."""

from __future__ import annotations

import re
from dataclasses import dataclass
from xml.etree import ElementTree

from halfspace.errors import InputError

SVG = "http://www.w3.org/2000/svg"
XLINK = "http://www.w3.org/1999/xlink"
REFERENCE = re.compile(r"url\(#([^)]*)\)")


@dataclass(frozen=True)
class Figure:
    """A picture as SVG that can stand inside HTML, and its caption, which is the text alternative too."""

    markup: str
    caption: str


def figure(svg: bytes, name: str, caption: str) -> Figure:
    """A picture made ready for a page.

    Parameters
    ----------
    svg : bytes
        The file.
    name : str
        Different for each picture of a page: it keeps the pictures' identifiers apart.
    caption : str
        What is to be seen.

    Raises
    ------
    InputError
        If the file is not SVG.
    """
    root = _parsed(svg, name)
    _strip(root)
    for element in root.iter():
        _keep_apart(element, name)
    root.attrib.pop("height", None)  # follows from the width and the view box
    root.set("role", "img")
    root.set("aria-label", caption)
    return Figure(_markup(root), caption)


def _parsed(svg: bytes, name: str) -> ElementTree.Element:
    try:
        root = ElementTree.fromstring(svg)
    except ElementTree.ParseError as error:
        raise InputError(f"the picture {name} is not SVG: {error}; write it anew") from error
    if root.tag != f"{{{SVG}}}svg":
        raise InputError(f"the picture {name} is not SVG: its first element is {root.tag}; write it anew")
    return root


def _strip(element: ElementTree.Element) -> None:
    """Leave out metadata, scripts, and styles, which would hold for the whole page; the page has the latter."""
    for child in list(element):
        if child.tag.rpartition("}")[2] in ("metadata", "style", "script"):
            element.remove(child)
        else:
            _strip(child)


def _keep_apart(element: ElementTree.Element, name: str) -> None:
    """Put the picture's name before each identifier and each reference to one."""
    for key, value in element.attrib.items():
        if key == "id":
            element.set(key, f"{name}-{value}")
        elif key in ("href", f"{{{XLINK}}}href") and value.startswith("#"):
            element.set(key, f"#{name}-{value[1:]}")
        else:
            element.set(key, REFERENCE.sub(rf"url(#{name}-\1)", value))


def _markup(root: ElementTree.Element) -> str:
    ElementTree.register_namespace("", SVG)
    ElementTree.register_namespace("xlink", XLINK)
    return ElementTree.tostring(root, encoding="unicode")
