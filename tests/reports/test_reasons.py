# SPDX-License-Identifier: GPL-2.0-or-later
"""Every row of tests/coverage_reasons.txt names something that is there: files, a function of them, words of a line."""
import fnmatch
import importlib.machinery
import importlib.util
import os
import re
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
LOADER = importlib.machinery.SourceFileLoader("everything", str(SOURCE / "tests/everything"))
everything = importlib.util.module_from_spec(importlib.util.spec_from_loader("everything", LOADER))
LOADER.exec_module(everything)


def functions(text):
    """{name: its text}. A function begins in the first column and ends with a bracket there."""
    return {match[1]: match[0] for match in
            re.finditer(r"^\w[^\n;#]*?(\w+)\([^;{]*?\)\n\{\n.*?^\}$", text, re.MULTILINE | re.DOTALL)}


def stale(listed, sources):
    """Rows that hold nowhere. sources: {path: text}."""
    return [f"{path}:{function}  {words}" for _, places in listed for path, function, words in places
            if not any(words in body for name, text in sources.items() if fnmatch.fnmatch(name, path)
                       for body in ([text] if function == "*" else
                                    [body for one, body in functions(text).items() if fnmatch.fnmatch(one, function)]))]


class Reasons(unittest.TestCase):
    def test_every_row_holds_somewhere(self):
        sources = {str(path.relative_to(SOURCE)): path.read_text() for path in (SOURCE / "src").rglob("*.c")}
        self.assertEqual(stale(everything.reasons(), sources), [])

    def test_a_row_of_something_that_is_gone_is_found(self):
        sources = {"src/a.c": "static int find(int x)\n{\n    for (;;) x++;\n}\n\nint other(void)\n{\n    return 0;\n}\n"}
        kept = [("because", [("src/*", "*", "return"), ("src/a.c", "find", "for ("), ("src/a.c", "f*", "x++")])]
        gone = [("because", [("src/b.c", "*", ""), ("src/a.c", "lost", ""), ("src/a.c", "other", "for (")])]
        self.assertEqual((stale(kept, sources), len(stale(gone, sources))), ([], 3))


if __name__ == "__main__":
    unittest.main()
