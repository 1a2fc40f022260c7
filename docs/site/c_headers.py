# SPDX-License-Identifier: GPL-2.0-or-later
"""`.. c-header:: src/amontons.h`: a public header as a reference. Structs, enums and callbacks are shown as they stand there,
each function with what is said above and behind it; all are in the index."""
import re
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList

def statements(text):
    """(comment above, statement, comment behind its end) of each, as they stand in the file."""
    above, code = [], []
    for line in text.split("\n"):
        plain = line.split("//")[0]
        if not code and line.startswith("//"):
            above.append(line)
        elif code or plain.strip():
            code.append(line)
            whole = "\n".join(entry.split("//")[0] for entry in code)
            if whole.count("{") == whole.count("}") and whole.rstrip().endswith(";"):
                yield "\n".join(above), whole.strip() if "{" not in whole else "\n".join(code), line[len(plain):]
                above, code = [], []
        elif not line.strip():
            above = []


def said(comment):
    return "\n".join(re.findall(r"//[ ]?([^\n]*)", comment)).strip()


def indented(text, width):
    return "\n".join(" " * width + line if line else "" for line in text.split("\n"))


def as_text(words):
    """A comment as reST: nothing in it is markup but names in backquotes, and what is indented is code."""
    words = re.sub(r"([*_|\\])", r"\\\1", words)
    return re.sub(r"`([^`\n]+)`", r"``\1``", words)


def entry(above, code, behind):
    above, name = said(above), re.search(r"(?:\(\*)?(\w+)\)?\(", code)
    heading = re.match(r"--- (.*?) -+\n?", above)
    out = []
    if heading:
        out += [f".. rubric:: {heading[1]}", ""]
        above = above[heading.end():]
    if name and "{" not in code and not code.startswith("typedef"):
        signature = " ".join(code.rstrip(";").split())
        out += [f".. c:function:: {signature}", "", indented(as_text(above), 3), "",
                indented(as_text(said(behind)), 3), ""]
        return out
    named = re.search(r"\}\s*(\w+);\s*$|\(\*(\w+)\)|^typedef struct \w+ (\w+);", code)
    name = next((word for word in named.groups() if word), None) if named else None
    if name:
        kind = "type" if "{" not in code else "enum" if " enum " in code else "struct"
        out += [f".. c:{kind}:: {name}", ""]
    width = 3 if name else 0
    out += [indented(as_text(above), width), "", " " * width + ".. code-block:: c", "", indented(code, width + 3), ""]
    return out


class Header(Directive):
    required_arguments = 1

    def run(self):
        settings = self.state.document.settings.env
        path = Path(settings.srcdir) / self.arguments[0]
        settings.note_dependency(str(path))
        text = path.read_text()
        codes = "".join(f"    {name},   // {words}\n" for name, words in re.findall(r'X\((\w+), \d, "(.*?)"\)', text))
        text = re.sub(r"(?m)^    ERROR_CODES\(X\)\n", codes, text)
        text = re.sub(r"(?m)^#(?:.*\\\n)*.*\n", "", text)
        text = re.sub(r'extern "C" \{\n|(?m:^\}\n)', "", text)
        lines = []
        for above, code, behind in statements(text):
            lines += entry(above, code, behind)
        node = nodes.section()
        node.document = self.state.document
        self.state.nested_parse(StringList("\n".join(lines).split("\n"), source=str(path)), 0, node)
        return node.children


def setup(app):
    app.add_directive("c-header", Header)
    return {"parallel_read_safe": True}
