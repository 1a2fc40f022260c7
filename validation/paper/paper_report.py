# SPDX-License-Identifier: GPL-2.0-or-later
"""REPORT.md: tables of what was computed, beside what the paper says."""
from collections import Counter

import numpy as np

import fronts
import theory
from interface import History, peak_made_of, same
from refinement import NAMES
from windows import AGREE, CELLS_RESOLVED, END_CELLS, branch_words, mu_of, reason

WHOLE = "all"   # in the table of times


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(cell(value) for value in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def cell(value):
    if isinstance(value, str):
        return value
    if value is None or not np.isfinite(value):
        return "-"
    return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.3e}"


def regime(row):
    if row["status"] != "done" or not np.isfinite(row["period"]):
        return row["status"]
    if not np.isfinite(row["mu_M"]):
        return "slides slowly"
    return f"{row['period']:.0f}" if row["period"] > 0 else "none found"


def even_table(pairs, finer=True):
    """The pairs of the coarsest mesh, every branch, and why two meshes differ. finer: the second mesh was computed."""
    out = []
    for pair in pairs:
        window, other = pair.coarse, pair.fine
        row = (window.length, window.P, window.mu, 100 * window.scatter / window.mu, branch_words(window), regime(window.centre),
               window.l_c, pair.cells_in_front())
        if finer:
            row += (other.mu, 100 * other.scatter / other.mu, branch_words(other), 100 * pair.difference(),
                    reason(window, other, pair.cells))
        out.append(row)
    heads = ["L", "P", "mu_M", "a run's scatter, %", "branches (peaks)", "period", "l_c/L", "l_c, cells"]
    if finer:
        heads += ["mu_M, twice as many cells", "a run's scatter, %", "branches (peaks)", "difference, %", "why more than 1 %"]
    return table(heads, out)


def line_against(rows, material):
    """Answers with error bars (bars.read_rows) beside the 1D theory in closed form."""
    out = []
    for row in rows:
        if row["mu_M"] == "none":
            continue
        mu, bar = row["mu_M"]
        line = material.mu(row["mesh.set.length"], row["load.pressure"])
        known = bar is not None
        out.append((row["mesh.set.length"], row["load.pressure"], f"{mu:.4f} ± {bar:.4f}" if known else f"{mu:.4f}, not known",
                    line, 100 * (line / mu - 1), 100 * bar * line / mu**2 if known else None))
    return table(["L", "P", "mu_M of the block", "1D theory", "the theory is above, %", "± %"], out)


def windows_against(rows, pairs):
    """Of how many points the mean over a window, on meshes chosen by hand, lies within the bar of the answer."""
    found = [abs(pair.fine.mu - row["mu_M"][0]) / row["mu_M"][1] for pair in pairs for row in rows
             if same(row["mesh.set.length"], pair.length) and same(row["load.pressure"], pair.P)
             and row["mu_M"] != "none" and row["mu_M"][1] is not None and np.isfinite(pair.fine.mu)]
    return (f"\nOf {len(found)} points the windows' mean (below) is within the bar at {sum(off <= 1 for off in found)}, "
            f"at most {max(found, default=0):.1f} bars off.\n")


def pair_table(pairs):
    """What the figures show: each point on its own pair of meshes."""
    return table(["L", "P", "N", "l_c/L", "l_c, cells of N", "runs, N and 2N", "mu_M, N", "mu_M, 2N", "difference, %", "a run's scatter, %",
                  "standard error, %", "branches (peaks), 2N", "period"],
                 [(pair.length, pair.P, mesh_name(pair), pair.fine.l_c, pair.cells_in_front(),
                   f"{len(pair.coarse.rows)}, {len(pair.fine.rows)}", pair.coarse.mu, pair.fine.mu, 100 * pair.difference(), pair.scatter(), pair.error(),
                   branch_words(pair.fine), regime(pair.fine.centre)) for pair in pairs])


def mesh_name(pair):
    return f"{pair.cells} {NAMES[pair.grade]}".strip()


def meshes_words(pairs):
    """How many points have which N."""
    count = Counter((pair.cells, mesh_name(pair)) for pair in pairs)
    return "N is " + ", ".join(f"{name} at {count[cells, name]}" for cells, name in sorted(count))


def agreement_words(pairs, even):
    """Of the meshes chosen, and of the coarsest everywhere, whose windows' central runs alone are compared as well."""
    size = lambda at: np.array([abs(pair.difference()) for pair in at])  # noqa: E731
    found, first, cells = size(pairs), size(even), even[0].cells
    alone = np.array([abs(mu_of(pair.fine.centre) / mu_of(pair.coarse.centre) - 1) for pair in even])
    resolved = np.array([pair.cells_in_front() >= CELLS_RESOLVED and pair.coarse.l_c <= 1 - END_CELLS / cells for pair in even])
    words = (f"N and 2N cells agree within 1 % at {(found <= AGREE).sum()} of {len(pairs)} points, median {100 * np.median(found):.2g} %, "
             f"largest {100 * found.max():.2g} %; {meshes_words(pairs)}. With {cells} and {2 * cells} even cells everywhere it is {(first <= AGREE).sum()} "
             f"(single runs: {(alone <= AGREE).sum()})")
    if resolved.any():
        words += (f"; where l_c is {CELLS_RESOLVED} cells of {cells} or more, and {END_CELLS} or more from L, "
                  f"{(first[resolved] <= AGREE).sum()} of {resolved.sum()}, largest {100 * first[resolved].max():.2g} %")
    return words + ".\n"


def line_words(parts):
    """The answer to why mu_M is not on the line, from the numbers of this run."""
    text = []
    for name in ("A", "B"):
        at = [p for p in parts if p["set"] == name]
        if not at:
            continue
        mean = {key: np.mean([p[key] for p in at]) for key in ("distance", "by_behind", "by_left", "by_carried", "by_load")}
        text.append(f"Set {name}, mean over its rows: mu lies {mean['distance']:+.3f} from the line; friction behind the front "
                    f"gives {mean['by_behind']:+.3f}, what sliding left ahead of it {mean['by_left']:+.3f}, what was carried "
                    f"ahead of it {mean['by_carried']:+.3f}, and pressure growing with x {mean['by_load']:+.3f}.")
    return "\n" + "\n".join(text) + """
Two of the three things that the line takes for granted do not hold in these runs: tau/p ahead of the front is above mu_K
from the start, for sliding ends at slip rates of a few v_c, where friction is no longer mu_K; and it grows further ahead
of the front while the front is on its way, since the stuck part is elastic. The pressure's growth with x acts against both.
`model1d.py` splits the same distance against the 1D model's pressure.
"""


def depends_table(rows):
    keys = list(rows[0])
    keys = keys[keys.index("point") + 1:keys.index("mu_M")]
    out = []
    for P in sorted({row["load.pressure"] for row in rows}):
        at = [row for row in rows if same(row["load.pressure"], P)]
        base = at[0]
        for row in at:
            changed = [f"{key} = {cell(row[key])}" for key in keys
                       if key not in ("load.pressure", "time.until.U") and str(row[key]) != str(base[key])]
            out.append((P, ", ".join(changed) or "(standard)", row["mu_M"], 100 * (row["mu_M"] / base["mu_M"] - 1),
                        row["low"], row["high"], regime(row), row["l_c"], row["steps"]))
    return table(["P", "changed", "mu_M", "by, %", "lowest peak", "highest", "period", "l_c/L", "steps"], out)


def line_parts(rows):
    parts = []
    for row in rows:
        if row["status"] != "done":
            continue
        history = History(row["folder"])
        if history.cycles():
            m = peak_made_of(history)
            parts.append({**m, "set": "A" if history.mu_static < 1 else "B", "P": row["load.pressure"],
                          "distance": m["mu"] - m["line"]})
    return parts


def line_table(parts):
    keys = ["set", "P", "mu", "l", "line", "distance", "by_behind", "by_left", "by_carried", "by_load", "f", "left", "ahead"]
    return table(["set", "P", "mu, peak", "l/L", "line", "mu - line", "behind", "left by sliding", "carried ahead",
                  "load not uniform", "f", "tau/p ahead, after sliding", "tau/p ahead, at the peak"],
                 [[p[key] for key in keys] for p in parts])


def median_of(values):
    values = [v for v in values if np.isfinite(v)]
    return np.median(values) if values else np.nan


def velocity_table(rows):
    """Slip rates and front speeds of both kinds against V."""
    out = []
    for row in rows:
        cells = [row["rod.velocity"], row["mu_M"], regime(row)]
        run = fronts.load(row["folder"])
        for kind in ("bounded rapid", "leading rapid"):
            found = [fronts.Front(event, run) for event in fronts.events_of(row) if event["kind"] == kind]
            rates = fronts.rates(row, kind)
            halves = [front.mean_speed(0.5 * (front.x[0] + front.x[-1]), front.x[-1]) for front in found]
            c = run["model"]["wave_speeds"]
            cells += [len(found), np.median(rates), np.median(rates) / row["rod.velocity"],
                      median_of(np.max(front.speeds) for front in found if len(front.speeds)) / c["longitudinal"],
                      median_of(halves) / c["rayleigh"]]
        out.append(cells)
    heads = ["V", "mu_M", "period"]
    for kind in ("bounded", "leading"):
        heads += [kind, "median slip rate", "over V", "front: fastest/c_L", "second half/c_R"]
    return table(heads, out)


def catalogue(cases, scene):
    """Each rapid event of the last cycle. scene: V and v_c."""
    text = []
    for label, run in cases:
        rows = [fronts.catalogue_row(front, *scene) for front in fronts.rapid_of_last_cycle(run)]
        slow = [e["front_speed"] for e in run["results"]["events"] if e["kind"] == "quasi-static" and e["front_speed"]]
        text.append(f"\n{label.replace('~', '').replace('{', '').replace('}', '')}: {len(rows)} rapid precursors in the last cycle; the "
                    f"slow front between slidings runs at {np.median(slow) / scene[0]:.3g} V (median).\n\n"
                    + table(fronts.HEADS, rows))
    return "".join(text)


def critical_table(rows):
    keys = [("P", "P"), ("line_l_c", "l_c, 1D formula"), ("line_l_c_full", "1D, all terms"), ("simulated_l_c", "1D, simulated"),
            ("block_l_sc", "l_sc, block"), ("block_l_c", "l_c, block, V → 0"), ("block_l_c_at_V", "at V"),
            ("line_mu", "mu, 1D formula"), ("line_mu_full", "1D, all terms"), ("simulated_mu", "1D, simulated"),
            ("block_mu", "block, V → 0"), ("block_mu_at_V", "at V")]
    return table([name for _, name in keys], [[row[key] for key, _ in keys] for row in rows])


def readings_table(rows):
    out = [(row["material.density"], row["friction.critical_velocity"], row["rod.kind"], row["mesh.set.length"],
            row["load.pressure"], row["mu_M"], row["l_c"], theory.B.line(row["l_c"])) for row in rows]
    return table(["density", "v_c", "rod", "L", "P", "mu_M", "l_c/L", "line at this l_c"], out)


def profile_words(history, rows):
    after, peak = rows[0], rows[-1]
    f, behind, ahead = history.split(peak, history.front[peak])
    return (f"At the peak (U = {history.U[peak]:.5f}) the front stands at {history.front[peak] / history.length:.3f} L; "
            f"tau/p is {behind:.4f} behind it (mu_S = {history.mu_static}) and {ahead:.4f} ahead of it on average "
            f"(mu_K = {history.mu_kinetic}). Just after sliding, tau/p is {history.split(after, -1)[2]:.4f} over the whole "
            f"interface. p/P is {history.pressure[peak][0] / history.P:.3f} at x = 0 and "
            f"{history.pressure[peak][-1] / history.P:.3f} at x = L.\n")


INTRO = """# The paper's figures, recomputed

Otsuki and Matsukawa, Sci. Rep. 3, 1586 (2013). Everything here was computed by `./amontons reproduce`; meshes have {mesh} by
{mesh} cells unless another number is named. mu_M of a run is the mean of its peaks in whole rounds of the periodic regime;
where no period up to 8 was found, of all peaks but the start's. Where no sliding was fast (no peak), mu_M stands
for the steady F_T/F_N of slow sliding.

## Figures 2a and 2b: mu_M against pressure

"""

TWO_MESHES = """Each point is computed on N and 2N cells along the contact. N is 40, even, or where these two meshes are more than 1 % apart or l_c
is less than 8 cells of N, or sliding waits for the last two nodes to let go, 80 or else 160. Those have 40 rows and are graded to
the contact and to both its ends (graded: three to one; steep: a hundred to one, for the last nodes). The marks are of 2N, the
dashed lines of N.

"""

ONE_MESH = """**Quick: one mesh, {mesh} even cells along the contact.** Not computed: any finer mesh, so the error of this one is unknown; nor
what mu_M depends on. Without `--quick` each point comes from two meshes, N and 2N cells, at least 40 and 80.

"""

WINDOWS = """Sliding starts with one of a row of bursts, and the slip front then stands at a node, so that a single run's mu_M is a staircase in
P with steps that lie elsewhere on each mesh. So a point is the mean of three to five runs at pressures within 13 % of P, of one
where runs scatter by less than 0.25 %. Scatter is what a run departs from the window's trend; bars reach from the lowest to
the highest branch of a run, less that trend.

"""

EVEN = """
### {points} on {mesh}{finer} even cells

"""

LINE = """
The paper has all points on mu_K + (mu_S - mu_K) l_c/L. Where ours lie off it, the last peak of each run says why. With f
the part of the load that lies behind the front l, and tau/p averaged by load behind and ahead of it,
mu - line = (r_behind - mu_S) f + (r_left - mu_K)(1 - f) + (r_ahead - r_left)(1 - f) + (mu_S - mu_K)(f - l/L), exactly:
what friction lacks behind the front, what sliding left ahead of it, what was carried ahead of it since, and pressure that
is not uniform ({cells} cells).

"""

CRITICAL = """
## Critical lengths: the 1D model and the block

l_sc, where a disturbance first grows swinging, and l_c, where one first grows without, over L. The 1D model (alpha = 0.2): by
the paper's formula, with all terms of its linear problem, and as its simulation finds them at the first peak. The block:
by `amontons stability`, for V towards 0 and at V, and by time stepping (the circles: of the {mesh} above).

"""

FRONTS = """
## Fronts of precursors, set A

How fast the front of a rapid precursor runs along the contact, {cells} by {cells} cells, steps of at most L/(20 c_L). It sets out within
what slipped slowly before, where slip has only to speed up.

"""

READINGS = """
The density in the equation of motion, the rod's kind, and L at constant P L change nothing here: inertia is negligible at
this size. What counts is (mu_S - mu_K) P L / (v_c eta): the last rows have v_c smaller by sqrt 2, the factor by which the
authors later corrected v_c, V and eta1 in the 3D follow-up.
"""


def write(place, parts):
    picture = lambda name, words: f"![{words}](figures/{name}.png)\n" if name in place.pictures else ""  # noqa: E731
    finer = not place.quick
    line_cells = 80 if finer else parts["cells"]
    text = [INTRO.format(mesh=parts["cells"]), TWO_MESHES if finer else ONE_MESH.format(mesh=parts["cells"]), WINDOWS,
            picture("fig2a", "mu_M against P, set A"), picture("fig2b", "mu_M against P, set B"),
            *[part for name in "ab" if finer for part in (f"\nSet {name.upper()}, bars of 95 %:\n\n", parts[f"block_{name}"])],
            *[part for name in "ab" if finer
              for part in (f"\nSet {name.upper()}:\n\n", parts[name], "\n", parts[f"agreement_{name}"])],
            "\nThe paper: mu_M falls as P or L grows, and becomes nearly constant at both ends.\n",
            EVEN.format(points="The same points" if finer else "Each point", mesh=parts["cells"], finer=" and twice as many" if finer else ""), "Set A:\n\n", parts["even_a"], "\nSet B:\n\n", parts["even_b"],
            "\n## Figure 3a\n\n", picture("fig3a", "mu_M against l_c"), LINE.format(cells=line_cells), parts["line"], parts["words"],
            "\n## Figures 3b and 3c\n\n", picture("fig3b", "p over P"), picture("fig3c", "tau over p"), parts["profile"],
            CRITICAL.format(mesh="2N cells" if finer else "runs"), picture("critical-a", "critical lengths, set A"), picture("critical-b", "critical lengths, set B"),
            picture("growth", "growth rates"), "\nSet A, L = 1:\n\n", parts["critical_a"], "\nSet B, L = 0.04:\n\n", parts["critical_b"],
            "\n## Set B at P L = 2.3e-6: the paper's mu_M = 0.6\n\n", parts["readings"], READINGS,
            "\nAnd V towards 0 (the sweeps above have V / v_c = 0.03):\n\n",
            picture("velocity-b", "mu_M against V/v_c"), parts["adiabatic"],
            FRONTS.format(cells=line_cells), picture("front-path", "where the fronts are"), picture("front-speed", "how fast they run"), parts["catalogue"],
            "\n## Precursors and the rod's velocity, set A, L = 1, P = 0.003\n\n",
            picture("velocity-a", "slip rates against V"), parts["velocity"],
            "\nThe paper: the slip rate of bounded precursors falls with V, that of leading ones does not; their fronts do not "
            "depend on V.\n",
            "\n## What mu_M depends on, set A, L = 1\n\n", parts["depends"],
            "\n## Time\n\n", table(["part", "wall time, s"], [(k, round(v, 1)) for k, v in place.seconds.items()]),
            f"\n{place.jobs} points at a time, in either set of Figure 2, whose parts share the processors.\n"]
    path = place.folder / "REPORT.md"
    path.write_text("".join(text))
    print(f"report: {path}\nfigures: {place.figures}")
