#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""How long files and functions of src/, render/ and tests/ are, and how many static functions have one caller. A report for who
reads it: nothing fails.

    tests/reports/lengths.py
"""
import re
import statistics
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


def functions(text):
    """(name, lines, arguments) of each function: in our format a body stands between a "{" and a
    "}" in the first column, and its head follows an empty line, a comment or a directive."""
    lines = text.splitlines()
    found = []
    for start, line in enumerate(lines):
        if line != "{":
            continue
        end = lines.index("}", start) if "}" in lines[start:] else len(lines) - 1
        head = start
        while head > 0 and lines[head - 1] and not lines[head - 1].startswith(("//", "#", "}")):
            head -= 1
        match = re.match(r"[^(]*?(\w+)\((.*)\)", " ".join(lines[head:start]))
        if match:
            found.append((match[1], end - head + 1, count_arguments(match[2])))
    return found


def count_arguments(inside):
    """Of "const double *a, void (*f)(int, int)": 2."""
    if inside.strip() in ("", "void"):
        return 0
    depth, count = 0, 1
    for letter in inside:
        depth += (letter == "(") - (letter == ")")
        count += letter == "," and depth == 0
    return count


def quantiles(numbers):
    """"10 / 23 / 60": median, ninth decile, largest."""
    ordered = sorted(numbers)
    return f"{statistics.median(ordered):g} / {ordered[int(0.9 * len(ordered))]} / {ordered[-1]}"


def main():
    print("lengths in lines: median / ninth decile / largest")
    for top in ("src", "render", "tests"):
        texts = {path: path.read_text() for path in sorted((SOURCE / top).rglob("*.c"))}
        found = {path: functions(text) for path, text in texts.items()}
        each = [one for several in found.values() for one in several]
        once = static = 0
        for text in texts.values():
            names = re.findall(r"(?m)^static [^=;]*?(\w+)\([^;]*\)\n\{", text)
            static += len(names)
            once += sum(len(re.findall(rf"\b{name}\b", text)) == 2 for name in names)
        print(f"{top}: {len(texts)} files {quantiles(len(text.splitlines()) for text in texts.values())}; {len(each)} functions "
              f"{quantiles(length for _, length, _ in each)}; arguments {quantiles(count for _, _, count in each)}; "
              f"{static} static, {100 * once // max(1, static)} % of them called once")
        for path, length, name in sorted(((path, length, name) for path, several in found.items() for name, length, _ in several),
                                         key=lambda row: -row[1])[:5]:
            print(f"  {name} of {path.relative_to(SOURCE)}: {length} lines")


if __name__ == "__main__":
    main()
