"""Configuration of the documentation, for Sphinx: ``make docs``. Nothing in the pages is loaded from elsewhere."""

import logging
import os
import sys
from importlib.metadata import version as version_of
from pathlib import Path

import matplotlib

sys.path.insert(0, str(Path(__file__).parent))
import extension

os.environ["COLUMNS"] = "80"  # columns of the commands' output, as wide as the text of a page
matplotlib.use("agg")
logging.getLogger("skfem").setLevel(logging.WARNING)

project = "fem-adhesion"
copyright = "the fem-adhesion developers"  # noqa: A001  Sphinx's own name
version = release = version_of("fem-adhesion")
extensions = ["myst_parser", "numpydoc", "sphinx.ext.autodoc", "sphinx_gallery.gen_gallery", "extension"]
exclude_patterns = ["gallery/*"]
suppress_warnings = ["config.cache"]  # the scrapers of pictures are objects
nitpicky = True

html_theme = "furo"
html_title = "fem-adhesion"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_math_renderer = "mathml"
html_copy_source = html_show_sourcelink = html_show_sphinx = False
pygments_style, pygments_dark_style = "a11y-high-contrast-light", "a11y-high-contrast-dark"

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3

default_role = "code"  # one backtick in a docstring is code
autodoc_typehints = "none"  # docstrings say types, with shapes and units
autodoc_member_order = "bysource"
numpydoc_show_class_members = False  # autodoc shows them

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "generated/gallery",
    "filename_pattern": "/",
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": ("matplotlib", extension.Pictures()),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
    "remove_config_comments": True,
    "min_reported_time": 1e9,
}
