"""What these pages need beyond Sphinx: commands that are run, and formulas as MathML."""

import io
import shlex
import shutil
import tempfile
from contextlib import chdir, redirect_stdout
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import directives
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util.docutils import SphinxDirective
from sphinx.util.math import get_node_equation_number
from sphinx_gallery.scrapers import figure_rst

from fem_adhesion import cli


class Pictures:
    """Pictures that a script of the gallery leaves in its folder, as those of a command's ``--plot``."""

    def __repr__(self):
        """Name by which sphinx-gallery knows whether its settings changed."""
        return "pictures"

    def __call__(self, block, block_vars, gallery_conf):
        """Move the pictures to where the page looks for them, and return what shows them."""
        found = sorted(Path(block_vars["src_file"]).parent.glob("*.png"))
        moved = [shutil.move(png, place) for png, place in zip(found, block_vars["image_path_iterator"], strict=False)]
        return figure_rst(moved, gallery_conf["src_dir"])


def run_command(line):
    """Run a command line of fem-adhesion here, and return what it prints; SystemExit if it fails."""
    printed = io.StringIO()
    with redirect_stdout(printed):
        try:
            code = cli.main(shlex.split(line.replace("\\\n", " "))[1:])
        except SystemExit as end:  # of --help
            code = end.code
    if code:
        raise SystemExit(f"{line}: exit code {code}")
    return printed.getvalue().rstrip()


class Run(SphinxDirective):
    """Command line of fem-adhesion, run while the page is built, with what it prints; `lines` of it unless all."""

    has_content = True
    option_spec = {"lines": directives.nonnegative_int}  # noqa: RUF012  docutils' own name

    def run(self):
        """Run it in an empty directory."""
        line = "\n".join(self.content)
        with tempfile.TemporaryDirectory() as place, chdir(place):
            printed = run_command(line).splitlines()
        kept = printed[: self.options.get("lines", len(printed))]
        text = "\n".join([f"$ {line}", *kept, *(["..."] if len(kept) < len(printed) else [])])
        return [nodes.literal_block(text, text, language="text")]


def inline_formula(translator, node):
    """Write a formula within the text as MathML, which browsers draw by themselves."""
    translator.body.append(tex2mathml(node.astext()))
    raise nodes.SkipNode


def formula(translator, node):
    """Write a formula on a line of its own, with its number if it has one."""
    translator.body.append(translator.starttag(node, "div", CLASS="math", tabindex="0", role="group"))
    if node["number"]:
        translator.body.append(f'<span class="eqno">({get_node_equation_number(translator, node)})</span>')
    translator.body.append(tex2mathml(node.astext(), as_block=True) + "</div>\n")
    raise nodes.SkipNode


def leave_out(app, what, name, obj, options, lines):
    """Take no text from the head of a module: the pages say it for readers, with tables and formulas."""
    if what == "module":
        lines.clear()


REACHED = {
    "<pre>": '<pre tabindex="0">',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="pages">',
    '<aside class="toc-drawer">': '<aside class="toc-drawer" aria-label="on this page">',
}
"""In a page: what scrolls, so that keys reach it, and what has no name to be read aloud."""


def reach(app, exception):
    """Let whatever scrolls be reached by key, in every page."""
    for file in Path(app.outdir).rglob("*.html"):
        text = file.read_text(encoding="utf-8")
        for old, new in REACHED.items():
            text = text.replace(old, new)
        file.write_text(text, encoding="utf-8")


def setup(app):
    """Tell Sphinx what is made here."""
    app.connect("build-finished", reach)
    app.connect("autodoc-process-docstring", leave_out, priority=1000)
    app.add_html_math_renderer("mathml", (inline_formula, None), (formula, None))
    app.add_directive("run", Run)
    return {"parallel_read_safe": True}
