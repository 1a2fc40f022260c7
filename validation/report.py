# SPDX-License-Identifier: GPL-2.0-or-later
"""The report: report.md, and its page of charts, charts.png (validation/plot.py)."""
from collections import Counter

from plot import draw_page


def shown(value):
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def verdict(good):
    return "pass" if good else "**FAIL**"


def row_lines(rows):
    yield "| case | quantity | reference | amontons | error | allowed | order | |"
    yield "|---|---|---|---|---|---|---|---|"
    for r in rows:
        note = f" ({r.note})" if r.note else ""
        yield (f"| {r.case} | {r.quantity}{note} | {shown(r.reference)} | {shown(r.ours)} | "
               f"{r.error:.1e} | {r.tolerance:.2g} | {r.order_text} | {verdict(r.passed)} |")


def invariant_lines(invariants):
    """The worst of each kind and allowance over all runs, and where."""
    worst, count = {}, Counter((name, tolerance) for _, name, _, tolerance in invariants)
    for case, name, value, tolerance in invariants:
        if not value <= worst.get((name, tolerance), ("", -1))[1]:
            worst[name, tolerance] = (case, value)
    yield "| invariant | checks | largest | in | allowed there | |"
    yield "|---|---|---|---|---|---|"
    for (name, tolerance), (case, value) in sorted(worst.items()):
        yield (f"| {name} | {count[name, tolerance]} | {value:.1e} | {case} | {tolerance:.2g} | "
               f"{verdict(value <= tolerance)} |")


def control_lines(controls):
    yield "| group | deliberate mistake in the program | rows, invariants broken | the worst | |"
    yield "|---|---|---|---|---|"
    for c in controls:
        good = "nothing broke" if c.mistake == "none" else "caught"
        yield (f"| {c.group} | `{c.mistake}`: {c.broken} | {len(c.failed)} of {len(c.rows)}, "
               f"{len(c.broken_invariants)} of {len(c.invariants)} | {worst_of(c)} | "
               f"{good if c.caught else '**MISSED**'} |")


def worst_of(control):
    """The row that is off by most, else the invariant, else what the program said."""
    def excess(value, tolerance):
        return value / tolerance if tolerance else value
    if control.failed:
        r = max(control.failed, key=lambda r: excess(r.error, r.tolerance))
        return f"{r.case}, {r.quantity}: error {r.error:.1e}, allowed {r.tolerance:.2g} {r.order_text}"
    if control.broken_invariants:
        case, name, value, tolerance = max(control.broken_invariants, key=lambda i: excess(i[2], i[3]))
        return f"{case}, {name}: {value:.1e}, allowed {tolerance:.2g}"
    return " ".join(control.refused.splitlines()[1:2])


def order_lines(rows):
    yield "| case | order | |"
    yield "|---|---|---|"
    for r in rows:
        if r.seen is not None:
            yield f"| {r.case}, {r.quantity} | {r.order_text} | {verdict(r.seen >= r.least)} |"


def write_report(study, folder, how):
    """True: everything passed."""
    folder.mkdir(parents=True, exist_ok=True)
    failed = [r for r in study.rows if not r.passed]
    broken = [i for i in study.invariants if not i[2] <= i[3]]
    missed = [c for c in study.controls if not c.caught]
    good = not (failed or broken or missed)
    lines = ["# Validation of amontons", "",
             f"Computed by {how}. {len(study.rows)} rows, {len(failed)} failed; "
             f"{len(study.invariants)} checks of invariants, {len(broken)} broken; "
             f"{len(study.controls)} deliberate mistakes, {len(missed)} missed.", "",
             "The reference of each row comes from outside: FreeFem++ run now on the same mesh, an "
             "exact solution, a published value; only rows marked `consistency` compare two methods of "
             "amontons itself. Errors are relative where not said otherwise.", ""]
    for group in dict.fromkeys(r.group for r in study.rows):
        lines += [f"## {group[0].upper()}{group[1:]}", "",
                  *row_lines(r for r in study.rows if r.group == group), ""]
    lines += ["## Orders of convergence", "", *order_lines(study.rows), "",
              "## Invariants, on every run above", "", *invariant_lines(study.invariants), "",
              "## Deliberate mistakes", "",
              "Rows above are computed once more by the program with one function of it replaced by a "
              "wrong one when it is linked (validation/mistakes); what fails then is shown.", "",
              *control_lines(study.controls), "", "## Charts", ""]
    if study.charts:
        draw_page(study.charts, folder / "charts.png")
        lines += ["![" + "; ".join(chart.title for chart in study.charts) + "](charts.png)", ""]
    (folder / "report.md").write_text("\n".join(lines))
    for r in failed:
        print(f"FAIL {r.group}: {r.case}: {r.quantity}: {shown(r.ours)} against {shown(r.reference)}, "
              f"error {r.error:.2e}, allowed {r.tolerance:.2g} {r.order_text}")
    for case, name, value, tolerance in broken:
        print(f"FAIL invariant: {case}: {name} {value:.2e}, allowed {tolerance:.2g}")
    for c in missed:
        print(f"MISSED {c.group}: {c.mistake}: all {len(c.rows)} rows pass, {c.broken}")
    return good
