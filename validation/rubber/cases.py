#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Do error bars hold where the block has a spectrum? Ten cases, laid down before anything was computed (ten_cases.py says how).

    validation/rubber/cases.py [--list] [--limit N] [-o FOLDER]

Blocks and pads of set A with one to five branches, or with those of a table of moduli (cases.csv, shifted), and every third with a
soft rod; pressure, moduli, relaxation times and stiffness are points of Halton sequences. References of some cases are not reduced,
of others their steps are finer. Every run is kept in FOLDER/cases.jsonl (default validation/rubber) as it ends: the same command
goes on where it was stopped. cases.sha256 is the digest of the list; --table writes cases.csv."""
import cmath
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "validation/benchmark"))
sys.dont_write_bytecode = True
import promise   # noqa: E402
from promise import between, halton, rounded   # noqa: E402
from ten_cases import Case, TenCases   # noqa: E402

SHEAR_MODULUS = 1 / (2 * 1.34)
WAYS = ((), ("reduction.use=never",), (), ("time.accuracy=fine",), ())     # of the references, in turn


def branches(index, count):
    """Each ten times as slow as the one before; together 0.2 to 3 times the block's own modulus. A viscosity resolves slip."""
    fastest, share = between(0.03, 3, halton(index, 5)), between(0.2, 3, halton(index, 7)) / count
    terms = ", ".join(f"{{time: {rounded(fastest * 10 ** k):g}, shear: {rounded(share * SHEAR_MODULUS):g}}}" for k in range(count))
    return f"material.relaxation=[{terms}]", f"material.eta1={rounded(between(0.3, 1, halton(index, 11))):g}"


def table(index):
    """The moduli of cases.csv, of a material faster or slower than it."""
    return (f"material={{from: {HERE / 'cases.csv'}, poisson: 0.34, plane: stress, bulk: relaxes, "
            f"shift: {rounded(between(0.3, 3, halton(index, 5))):g}}}",)


def case(number):
    index, count = number + 1, 1 + number % 5
    pressure = rounded(between(0.003, 0.012, halton(index, 2)))
    material, words = (table(index), "table") if number % 4 == 3 else (branches(index, count), f"{count} branches")
    stiffness = rounded(between(0.1, 1, halton(index, 3))) if number % 3 == 2 else None
    rod = (f"rod.stiffness={stiffness:g}",) if stiffness else ()
    way = 12 * pressure * (1 + 0.5 / stiffness if stiffness else 1)
    settings = (*material, *rod, f"time.until={{U: {way:g}}}")
    shape = "pads" if number % 4 == 1 else "block"
    name = f"{number}: {shape}, {words}, P = {pressure:g}" + (f", k = {stiffness:g}" if stiffness else "")
    if shape == "block":
        return Case(name, promise.BLOCK, settings, pressure, {"length": 1, "height": 0.5, "shape": "quad"}, True, WAYS[number % 5])
    feet = {"n": 2 + number % 3, "total_height": 0.5, "pad_height": 0.05, "fill": 0.6, "ends": "open"}
    return Case(name, promise.PADS, settings, pressure, feet, False, WAYS[number % 5])


def write_table():
    """A spring, a springpot of order 0.4 with a spring in line, and a dashpot that resolves slip:
    E* = 1 + 0.6 (i w)^0.4 / (1 + 0.3 (i w)^0.4) + 0.7 i w."""
    lines = ["# A spring beside a springpot and a dashpot, not measured: validation/rubber/cases.py --table", "f, E', E''"]
    for k in range(-40, 6, 3):
        frequency = 2j * cmath.pi * 10 ** (k / 10)
        pot = frequency ** 0.4
        modulus = 1 + 0.6 * pot / (1 + 0.3 * pot) + 0.7 * frequency
        lines.append(f"{10 ** (k / 10):.5g}, {modulus.real:.5g}, {modulus.imag:.5g}")
    (HERE / "cases.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


CASES = TenCases(case, graded=True)

if __name__ == "__main__":
    if "--table" in sys.argv:
        sys.exit(write_table())
    sys.exit(CASES.main(__doc__.splitlines()[0], HERE))
