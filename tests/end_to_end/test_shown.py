# SPDX-License-Identifier: GPL-2.0-or-later
"""What the pages show can be done: every command of tutorial and cookbook ends well (on coarse meshes), makes the pictures that
are shown, and the scenes, studies and scripts on the pages are those of docs/examples/."""
import os
import re
import subprocess
import unittest
from pathlib import Path

from sanitizer_fixture import preload

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
BIN = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin"))
# The gallery shows pictures of the others, and two runs more.
PAGES = [page for page in [SOURCE / "README.md", *sorted(SOURCE.glob("docs/*.md"))]
         if "\n```console\n" in page.read_text() and page.name != "gallery.md"]
PICTURES_MAX = 3_000_000   # bytes in all, a film among them: pages are read on the web


class Shown(unittest.TestCase):
    def test_numbers(self):
        """A page shows the mu that its commands print, in blocks and in sentences. The pages that show one are all among those that
        `validation/pages --check` runs, for minutes."""
        words = re.search(r"--check \]\] && exec \S+ --check (.*)", (SOURCE / "validation/pages").read_text())[1]
        checked = [SOURCE / name for name in subprocess.run(["bash", "-c", f"echo {words}"], capture_output=True, text=True,
                                                            check=True).stdout.split()]
        self.assertEqual([page.name for page in SOURCE.glob("docs/*.md")
                          if page not in checked and re.search(r"^ +mu_\w+ +[\d.]+", page.read_text(), re.M)], [])
        page = SOURCE / "docs/commands.md"
        self.assertIn("<!-- mu_", page.read_text())
        done = subprocess.run([SOURCE / "docs/examples/shown.py", "--check", page], capture_output=True, text=True,
                              env=os.environ | preload(BIN / "libamontons.so"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_one_command_makes_all_pages(self):
        """validation/pages names a script for each page of numbers, and each script knows its options."""
        said = subprocess.run([SOURCE / "validation/pages", "--help"], capture_output=True, text=True, check=True).stdout
        scripts = {SOURCE / name for name in re.findall(r"(?:docs|validation)/[\w/]+(?:\.py|/run)(?= |$)", said, re.M)}
        for script in scripts:
            self.assertTrue(os.access(script, os.X_OK), script)
        by_hand = {"pictures"}   # judged by eye, not computed
        made = set(re.findall(r"validation/(\w+)", said))
        for page in SOURCE.glob("validation/*/README.md"):
            self.assertIn(page.parent.name, made | by_hand)

    def test_commands(self):
        self.assertGreaterEqual(len(PAGES), 2)
        done = subprocess.run([SOURCE / "docs/examples/shown.py", "--small", *PAGES], capture_output=True, text=True,
                              env=os.environ | preload(BIN / "libamontons.so"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_each_study_has_a_picture(self):
        studies = re.split(r"^## \d+\. ", (SOURCE / "docs/cookbook.md").read_text(), flags=re.M)[1:]
        self.assertEqual(len(studies), 15)
        for study in studies:
            self.assertRegex(study, r"<!-- from \S+ -->\n!\[", study[:40])

    def test_pictures(self):
        """None is missing, none is left over, all are small."""
        shown = {name for page in SOURCE.glob("docs/*.md")
                 for name in re.findall(r"\]\(pictures/([\w.-]+)\)", page.read_text())}
        kept = {path.name: path.stat().st_size for path in SOURCE.glob("docs/pictures/*")}
        self.assertEqual(shown, set(kept))
        self.assertLess(sum(kept.values()), PICTURES_MAX)


if __name__ == "__main__":
    unittest.main()
