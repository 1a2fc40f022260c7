# SPDX-License-Identifier: GPL-2.0-or-later
"""The site for Sphinx: `./amontons docs`. Its pages are the Markdown files that GitHub shows too; what only the site has
(the contents, the references of C and Python) stands in this folder."""
import os
import re
import sys
from pathlib import Path

SITE = Path(__file__).resolve().parent
SOURCE = SITE.parents[1]
sys.path[:0] = [str(SITE), os.environ.get("AMONTONS_PYTHON", str(SOURCE / "build/python"))]

project = "amontons"
author = "the amontons authors"
version = release = re.search(r"VERSION ([\d.]+) LANGUAGES", (SOURCE / "CMakeLists.txt").read_text())[1]
html_title = f"amontons {version}"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "c_headers"]
root_doc = "README"
include_patterns = ["*.md", "docs/*.md", "docs/site/*.rst", "src/README.md", "validation/**.md"]
exclude_patterns = ["validation/*/tables.md", "validation/*/bars.md"]   # numbers in bulk, as files
suppress_warnings = ["myst.header"]                # tables that programs wrote begin at a lower level
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
smartquotes = False
autodoc_member_order = "bysource"

html_theme = "furo"
html_show_sphinx = html_copy_source = False
html_extra_path = ["index.html"]
# Formulas by KaTeX, which Debian has, from the site itself: no network is asked. Sphinx writes the marks that
# auto-render looks for when it believes to serve MathJax.
html_static_path = ["/usr/share/javascript/katex", "formulas.js", "site.css"]
html_css_files = ["katex.min.css", "site.css"]
mathjax_path = "katex.min.js"
mathjax_options = {"defer": "defer"}
html_js_files = [("contrib/auto-render.js", {"defer": "defer"}), ("formulas.js", {"defer": "defer"})]


def as_sphinx_reads(app, page, source):
    """GitHub's words for what Sphinx calls otherwise; the contents stand at the end of the first page."""
    text = source[0].replace("```math\n", "```{math}\n")
    text = re.sub(r"\[([^\]]+)\]\(([\w./]*\b(?:tables|bars)\.md)\)", r"{download}`\1 <\2>`", text)
    if page == root_doc:
        app.env.note_dependency(str(SITE / "contents.txt"))
        text += "\n" + (SITE / "contents.txt").read_text()
    source[0] = text


def struct_fields(app, what, name, struct, options, lines):
    """`name: words` of python/structs.py as a list, in which nothing is markup."""
    if what == "class" and hasattr(struct, "_fields_"):
        lines[:] = [re.sub(r"([*_|`])", r"\\\1", line) for line in lines]
        lines[:] = [re.sub(r"^([\w\\, ]+): ", r"- **\1**: ", line) for line in lines]


def setup(app):
    app.connect("source-read", as_sphinx_reads)
    app.connect("autodoc-process-docstring", struct_fields)
