# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes amontons/_structs.py: the structs, callbacks and functions of the public headers for ctypes.

    python3 structs.py SONAME OUTPUT HEADER ...

The headers are read as they are written here (one statement ends with `;`, comments begin with `//`); what is not
understood is an error. A struct's docstring is what the header says of its fields, shapes and units included.
"""
import re
import sys
from pathlib import Path

SIMPLE = {"double": "c_double", "int32_t": "c_int32", "int64_t": "c_int64", "bool": "c_bool", "char": "c_char",
          "uint8_t": "c_uint8", "int": "c_int", "void": "None", "ErrorCode": "c_int", "sig_atomic_t": "c_int"}
OPAQUE = {"Scene", "Simulation", "FILE"}


class Headers:
    def __init__(self, paths):
        self.constants, self.known, self.lines, self.functions = {}, set(), [], {}
        for path in paths:
            self.read(path.read_text())

    def read(self, text):
        text = re.sub(r"(?m)^#(?:.*\\\n)*.*\n", "", text)          # the preprocessor's
        text = re.sub(r'extern "C" \{\n|(?m:^\}\n)', "", text)
        text = re.sub(r"(?s)typedef enum ErrorCode \{.*?\} ErrorCode;", self.codes, text)
        comments = r"^((?:^//[^\n]*\n)*)"
        statements = r"^((?:[a-z][^;{\n]*\{[^\n]*\};)|(?:[a-z][^;{\n]*\{[^\n]*\n.*?^\}[^;]*;)|(?:\w[^;{]*;))"
        for note, statement in re.findall(comments + statements, text, re.S | re.M):
            self.take(note, statement)

    def codes(self, _):
        return ""

    def take(self, note, statement):
        plain = " ".join(re.sub(r"//[^\n]*", "", statement).split())
        if found := re.fullmatch(r"enum \{ (.*?),? \};", plain):
            self.take_constants(found[1])
        elif found := re.fullmatch(r"typedef struct (\w+) \{.*\} \1;", plain):
            self.take_struct(found[1], note, statement)
        elif found := re.fullmatch(r"typedef (\w+) \(\*(\w+)\)\((.*)\);", plain):
            types = ", ".join([SIMPLE[found[1]], *self.arguments(found[3])])
            self.lines.append(f"{found[2]} = CFUNCTYPE({types})\n")
            self.known.add(found[2])
        elif found := re.fullmatch(r"(.*?)(amontons_\w+)\((.*)\);", plain):
            self.functions[found[2]] = (self.type_of(found[1].strip(), found[1].count("*")), self.arguments(found[3]))
        elif not re.fullmatch(r"typedef struct (\w+) \1;", plain):
            raise SystemExit(f"structs.py: what is this? {plain}")

    def take_constants(self, text):
        value = -1
        for entry in text.split(","):
            name, _, given = entry.partition("=")
            value = int(given) if given else value + 1
            self.constants[name.strip()] = value

    def take_struct(self, name, note, statement):
        body = statement[statement.index("{") + 1:statement.rindex("}")]
        fields, said = [], []   # said: [names of one declaration, what the header says of them]
        code = note_above = ""
        for line in body.splitlines():
            before, _, comment = line.partition("//")
            comment = comment.strip()
            if not before.strip():   # a comment on a line of its own: of what was declared, or of what comes
                deeper = len(before) > 4 or comment[:1].islower()
                if comment and deeper and said and not note_above:
                    said[-1][1] += " " + comment
                elif comment:
                    note_above += " " + comment
                continue
            code += " " + before
            trailing = comment
            while ";" in code:
                declared, _, code = code.partition(";")
                names = self.take_fields(name, " ".join(declared.split()), fields)
                said.append([names, f"{note_above} {trailing}".strip()])
                note_above = trailing = ""
        intro = " ".join(re.findall(r"//[ ]?([^\n]*)", note))
        text = "\n".join([intro or name, "", *(f"    {', '.join(names)}: {words}" for names, words in said if words)])
        text = text.replace("\\", "\\\\")
        self.lines.append(f'class {name}(Structure):\n    """{text}\n    """\n    _fields_ = [\n' +
                          "".join(f'        ("{f}", {k}),\n' for f, k in fields) + "    ]\n")
        self.known.add(name)

    def take_fields(self, name, declared, fields):
        base = re.match(r"((?:const |volatile |struct )*\w+(?: const)?)(.*)", declared)
        names = []
        for entry in base[2].split(","):
            field = re.fullmatch(r"\s*((?:\*\s*(?:const\s+)?)*)(\w+)((?:\[\w+\])*)\s*", entry)
            if not field:
                raise SystemExit(f"structs.py: {name}: what is this? {declared}")
            kind = self.type_of(base[1], field[1].count("*"))
            for size in reversed(re.findall(r"\[(\w+)\]", field[3])):
                kind += f" * {self.constants[size] if size in self.constants else int(size)}"
            fields.append((field[2], kind))
            names.append(field[2])
        return names

    def type_of(self, words, stars):
        base = re.sub(r"\b(const|volatile|struct)\b|\*", "", words).strip()
        if base == "char" and stars:
            return "c_char_p" if stars == 1 else "POINTER(c_char_p)"
        if base in OPAQUE or (base == "void" and stars):
            return "c_void_p" if stars < 2 else "POINTER(c_void_p)"
        if base not in SIMPLE and base not in self.known:
            raise SystemExit(f"structs.py: unknown type {base}")
        kind = SIMPLE.get(base, base)
        for _ in range(stars):
            kind = f"POINTER({kind})"
        return kind

    def arguments(self, text):
        if text.strip() == "void":
            return []
        kinds = []
        for argument in text.split(","):
            stars = argument.count("*") + argument.count("[")
            words = re.sub(r"\[\w*\]", "", argument).split()
            base = " ".join(words[:-1]) if len(words) > 1 else words[0]
            kinds.append(self.type_of(base.replace("*", " "), stars))
        return kinds


def write(soname, output, paths):
    headers = Headers(paths)
    codes = re.findall(r'X\((ERROR_\w+), \d, "', next(p for p in paths if p.name == "amontons_error.h").read_text())
    text = ["# SPDX-License-Identifier: GPL-2.0-or-later", "# Written by structs.py from the public headers.",
            "from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_int, c_int32,",
            "                    c_int64, c_uint8, c_void_p)", "", f'LIBRARY = "{soname}"']
    text += [f"{name} = {value}" for name, value in headers.constants.items()]
    text += [f"{name} = {k}" for k, name in enumerate(codes)]
    text += ["", ""] + ["\n".join(headers.lines)]
    text += ["FUNCTIONS = {"]
    text += [f'    "{name}": ({result}, [{", ".join(kinds)}]),' for name, (result, kinds) in headers.functions.items()]
    text += ["}", ""]
    Path(output).write_text("\n".join(text))


if __name__ == "__main__":
    write(sys.argv[1], sys.argv[2], [Path(name) for name in sys.argv[3:]])
