"""The README as a package index shows it: its links lead to the files of the project, where pyproject.toml says so.

`Source` of its `project.urls` is where the files can be seen, as ``https://example.org/name/raw/v0.1.0``. Until the
publisher gives it, what would be a broken link there is plain text.
"""

import re
import tomllib
from pathlib import Path

from setuptools import setup

HERE = Path(__file__).parent
SOURCE = tomllib.loads((HERE / "pyproject.toml").read_text(encoding="utf-8"))["project"].get("urls", {}).get("Source")
LINK = re.compile(r"(!?\[[^\]]*\])\((?!https?:|#)([^)]+)\)")

readme = (HERE / "README.md").read_text(encoding="utf-8")
if SOURCE:
    readme = LINK.sub(lambda link: f"{link[1]}({SOURCE}/{link[2]})", readme)
else:
    readme = LINK.sub(lambda link: "" if link[1][0] == "!" else link[1][1:-1], readme)

setup(long_description=readme, long_description_content_type="text/markdown")
