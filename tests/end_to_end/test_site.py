# SPDX-License-Identifier: GPL-2.0-or-later
"""The site that `./amontons docs` makes: no warnings, every page, nothing fetched from a network, all that is public in C and
Python. Its folder is kept, so that only the first build reads every page."""
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")).resolve().parent
PYTHON = BUILD / "python"


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = BUILD / "tests" / "site"
        cls.site.parent.mkdir(exist_ok=True)
        done = subprocess.run([SOURCE / "docs/site/build", cls.site], capture_output=True, text=True,
                              env=dict(os.environ, AMONTONS_PYTHON=str(PYTHON)))
        if done.returncode or done.stderr:
            raise AssertionError(done.stdout + done.stderr)
        cls.pages = {path: path.read_text() for path in cls.site.rglob("*.html")}

    def test_every_page_can_be_reached(self):
        contents = self.pages[self.site / "README.html"]
        for page in SOURCE.glob("docs/*.md"):
            self.assertIn(f'href="docs/{page.stem}.html"', contents)
        self.assertIn("README.html", self.pages[self.site / "index.html"])

    def test_nothing_comes_from_a_network(self):
        for page, text in self.pages.items():
            sources = re.findall(r"<(?:script|img|iframe)[^>]*\bsrc=\"([^\"]*)\"|<link[^>]*\bhref=\"([^\"]*)\"", text)
            for name in (one or other for one, other in sources):
                self.assertNotRegex(name, r"^(https?:)?//", page)
                if not name.startswith(("#", "data:")):
                    self.assertTrue((page.parent / name.split("?")[0]).exists(), f"{page}: {name}")

    def test_formulas_are_shown(self):
        """The page of the method brings what draws them; fonts come along."""
        text = self.pages[self.site / "docs/method.html"]
        self.assertGreater(text.count('class="math'), 100)
        for name in ("katex.min.js", "contrib/auto-render.js", "formulas.js", "katex.min.css"):
            self.assertIn(f"_static/{name}", text)
        self.assertTrue(list(self.site.glob("_static/fonts/KaTeX_Main-Regular.*")))

    def test_references_are_complete(self):
        reference = self.pages[self.site / "docs/site/c.html"]
        headers = "".join(path.read_text() for path in SOURCE.glob("src/amontons*.h"))
        functions = re.findall(r"^\w[^;{}/#]*?\b(amontons_\w+)\(", headers, re.M)
        self.assertGreater(len(functions), 30)
        for name in functions + re.findall(r"^\} (\w+);", headers, re.M):
            self.assertIn(f'id="c.{name}"', reference)
        sys.path.insert(0, str(PYTHON))
        import amontons
        reference = self.pages[self.site / "docs/site/python.html"]
        for name in amontons.__all__:
            if not name.startswith("NODE_"):
                self.assertRegex(reference, rf'id="amontons\.({name}|_\w+\.{name})"')


if __name__ == "__main__":
    unittest.main()
