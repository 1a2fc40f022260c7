#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""A published table beside a static equilibrium: u_x along the floor of SSNV128, a square pressed onto it with friction 1.

    amontons static validation/exact/ssnv128.yaml -o results/ssnv128
    python3 docs/examples/contact_table.py       # results/ssnv128/contact.png, and contact-compared.csv with each number
"""
import json
import shutil
import subprocess
from pathlib import Path

import h5py

RESULT, TABLE = Path("results/ssnv128"), Path(__file__).with_name("ssnv128.csv")
with h5py.File(RESULT / "static.h5") as file:
    nodes = file["contact/node"][:]
    x, u_x = (file[f"nodes/{name}"][:][nodes, 0] for name in ("position", "displacement"))
order = x.argsort()
plot = {"x": {"label": "~{x} (m)", "column": "x"}, "y": {"label": "~{u}_{x} (m)", "column": "u_x"},
        "series": [{"x": x[order].tolist(), "y": u_x[order].tolist(), "line": "thin"}], "page": {"compare": TABLE.name}}
shutil.copy(TABLE, RESULT)
(RESULT / "contact.json").write_text(json.dumps(plot))
subprocess.run(["./amontons", "render", RESULT / "contact.json", "--overwrite"], check=True)
