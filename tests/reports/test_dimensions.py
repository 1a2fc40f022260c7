# SPDX-License-Identifier: GPL-2.0-or-later
"""No second dimension is built in: how many displacements a node has, and how many unknowns a contact node, is said by
`dim` of mesh, bulk and interface alone. Where numbers of a node stand is said by mesh_place, node_dof, dof_node, dof_axis
and interface_unknown; nothing else counts in twos. Idioms are looked for, so that a new one is seen where it is written."""
import os
import re
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("AMONTONS_SOURCE", Path(__file__).resolve().parents[2]))
# Where there are nodes. base/, cli/, page/, scene/ and the rest of io/ know none.
FOLDERS = ["src/fem", "src/friction", "src/contact", "src/reduction", "src/stepping", "src/record", "src/answers", "src/model", "src/run", "src/study",
           "src/io/mesh", "src/io/fields", "render"]
COUNTED = r"(?:\(int64_t\))?\(?[\w>.-]*\b(?:nodes?|node_count|contact_count|contacts|neighbour\w*)\b"
IDIOMS = [
    r"\bposition ?[\[+] ?2 \*",                                    # position[2 * i], position + 2 * i
    r"\b2 \* " + COUNTED,                                         # 2 * node_count, 2 * nodes[k]
    COUNTED + r"(?:\[\w+\])? \* 2\b",                             # node * 2
    r"\[2 \* [a-z]\w*(?: \+ [01df])?\]",                          # u[2 * i + 1]
    r"\b(?:dof|unknown|row|column|node|dof_count|k|i|j|t|n) [/%] 2\b",   # dof / 2, k % 2
    r"\] [/%] 2\b",                                               # dofs[k] % 2
    r"[|^] 1\]",                                                  # position[k | 1]
    r"\b(?:d|axis|component) < 2\b",                              # for (d = 0; d < 2; d++)
    r"\b(?:dof|row|unknown) \+= 2\b",
    r"NODES_MAX\]\[2\]|POINTS_MAX\]\[2\]|\(\*\w*\)\[2\]",         # positions [nodes][2]
]
# What is flat by its nature, or counts in twos what is no node: why, and the lines where not the whole file.
REASONS = {
    "render/figures/block_page.c": ("a picture is flat", r".*"),
    "render/mesh/mesh_picture.c": ("a picture is flat", r".*"),
    "render/plot/map_cells.c": ("a picture is flat", r"d < 2; d"),
    "render/view/contact_plane.c": ("a floor is flat", r".*"),
    "render/view/surface.c": ("a face is flat", r".*"),
    "render/view/result_view.h": ("begin and end of a stretch of time", r"\(\*rapid\)"),
    "render/view/space_time.h": ("begin and end of a stretch of time", r"\(\*events\)"),
    "render/frames/frames.c": ("two arrays", r"frames->x"),
    "src/contact/interface.c": ("a floor is flat", r"d < 2; d"),
    "src/reduction/training_points.c": ("points of a path, and points between", r"path\S*at\[|2 \* steps"),
    "src/run/info/info_curves.c": ("x and y of a picture", r"d < 2; d"),
    "render/events_table.c": ("half of a length", r"NUMBER_LENGTH\] / 2"),
    "render/figures/figure_maps.c": ("begin and end of a stretch of time", r"events"),
    "src/run/static/static_solve.c": ("two arrays", r"contact = NEW_ARRAY"),
    "src/study/line/modes.c": ("even modes", r"j % 2 == 0"),
    "src/study/stability/file.c": ("real and imaginary part", r"modes/slip"),
    "src/study/sweep/showing/sweep_plot.c": ("x and y of a figure", r"places\["),
}


def code_of(line):
    return line.split("//")[0]


def found_in(root):
    """Every line of code with an idiom that has no reason, as "file:line: code"."""
    found = []
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".c", ".h", ".cc"):
                continue
            name = str(path.relative_to(root))
            allowed = REASONS.get(name, ("", r"(?!)"))[1]
            for number, line in enumerate(path.read_text().splitlines(), 1):
                code = code_of(line)
                if any(re.search(idiom, code) for idiom in IDIOMS) and not re.search(allowed, code):
                    found.append(f"{name}:{number}: {code.strip()}")
    return found


class Dimensions(unittest.TestCase):
    def test_sources(self):
        self.assertEqual(found_in(SOURCE), [])

    def test_reasons_are_needed(self):
        for name, (_, allowed) in REASONS.items():
            lines = [code_of(line) for line in (SOURCE / name).read_text().splitlines()]
            self.assertTrue(any(re.search(allowed, line) and any(re.search(idiom, line) for idiom in IDIOMS)
                                for line in lines), name)

    def test_sees_each_idiom(self):
        for line in ("double x = mesh->position[2 * i];", "const double *at = mesh->position + 2 * (int64_t)node;",
                     "int32_t dofs = 2 * mesh->node_count;", "bulk->load[2 * node + 1] += 1;", "int32_t n = nodes * 2;",
                     "u[2 * i + d] = 0;", "int32_t node = dof / 2;", "if (dofs[k] % 2 == 0) return;",
                     "inside[k] = position[k | 1] == 0;", "for (int d = 0; d < 2; d++)",
                     "for (int32_t row = 0; row < size; row += 2)", "double position[ELEMENT_NODES_MAX][2];",
                     "const double (*position)[2]", "interface->count = 2 * interface->contact_count + rod;"):
            self.assertTrue(any(re.search(idiom, line) for idiom in IDIOMS), line)
        for line in ("int32_t middle = (low + high) / 2;", "double mean = (a[i] + a[j]) / 2;", "2 * root", "x[3 * node]"):
            self.assertFalse(any(re.search(idiom, line) for idiom in IDIOMS), line)


if __name__ == "__main__":
    unittest.main()
