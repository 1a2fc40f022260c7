#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Blocks in space beside what is exact, beside explicit steps, and beside their limits in the plane; and pictures of one.

    validation/space/limits.py [PART ...]     # exact, explicit, held, thin, pictures; all where none is named

Each run is kept in results/space and not computed again (remove the folder to begin anew). Writes limits.md and the pictures
beside this file, from what is there."""
import argparse
import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.dont_write_bytecode = True

from harness import PROGRAMS, SOURCE, Study, scratch   # noqa: E402
import exact.space                                     # noqa: E402

KEPT = SOURCE / "results/space"
EXACT = HERE.parent / "exact"
PARTS = ("exact", "explicit", "held", "thin", "pictures")


def run(name, scene, **sets):
    """The run.json of a scene, computed where it is not there yet."""
    folder = KEPT / name
    if not (folder / "run.json").exists():
        words = [word for key, value in sets.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]
        subprocess.run([PROGRAMS / "amontons", "run", scene, "-q", "--overwrite", "-o", folder, *words], check=True)
    return json.loads((folder / "run.json").read_text())


def peaks(report):
    return [peak["mu"] for peak in report["results"]["peaks"]]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def numbers(values):
    return ", ".join(f"{v:.5f}" for v in values)


# --- parts ----------------------------------------------------------------------------------------

def part_exact():
    """As `validation/run space` has it, without its mistakes."""
    kept = KEPT / "exact.json"
    if not kept.exists():
        study = Study(folder=scratch())
        for part in (exact.space.patch, exact.space.orders, exact.space.waves, exact.space.hertz, exact.space.hertz_curved, exact.space.mindlin, exact.space.punch, exact.space.plate):
            part(study)
        kept.write_text(json.dumps([[r.case, r.quantity, str(r.reference), str(r.ours), r.error, r.tolerance, r.passed, r.seen]
                                    for r in study.rows]))
        shutil.rmtree(study.folder)
    rows = json.loads(kept.read_text())

    def short(word):
        try:
            return f"{float(word):.4g}"
        except ValueError:
            return word
    return table(("case", "what", "exact", "ours", "off by", "allowed", "order"),
                 [(case, what, short(reference), short(ours), f"{error:.1e}" if error < 1e-3 else f"{error:.2%}",
                   f"{allowed:.0e}" if allowed < 1e-3 else f"{allowed:.1%}", "" if seen is None else f"{seen:.2f}")
                  for case, what, reference, ours, error, allowed, _, seen in rows])


def part_explicit():
    """A cube of 6 x 6 x 6 cells and pads, by the program's steps and by explicit ones of the same mesh."""
    rows = []
    for name, mesh in (("cube", "{length: 0.5, breadth: 0.5, height: 0.5, nx: 6, ny: 6, nz: 6}"),
                       ("wide", "{length: 0.5, breadth: 1, height: 0.5, nx: 6, ny: 10, nz: 5}")):
        for scheme, words in (("sdirk2", {}), ("sdirk2", {"time__tolerance": 3e-4}), ("explicit", {})):
            tag = f"{name}-{scheme}" + ("-fine" if words else "")
            report = run(tag, EXACT / "held.yaml", mesh__set=mesh, load__supports="[]", time__scheme=scheme, time__until="{U: 0.004}", **words)
            rows.append((name, "explicit" if scheme == "explicit" else "fine" if words else "usual", report["steps"]["accepted"],
                         f"{report['timing_s']['total']:.1f} s", numbers(peaks(report))))
    return table(("block", "steps", "how many", "elapsed", "peaks of F_T/F_N"), rows)


def part_held():
    """Held across the drive, and plane strain."""
    rows = []
    flat = {"mesh__file": SOURCE / "meshes/block.geo", "mesh__set": "{length: 0.5, height: 0.5, nx: 10, nz: 8}",
            "material__plane": "strain", "load__supports": "[]"}
    for words, how in (({}, "usual"), ({"time__tolerance": 3e-4}, "tolerance 3e-4"), ({"time__scheme": "explicit"}, "explicit")):
        tag = how.replace(" ", "-")
        for name, sets in (("plane strain", flat), ("held, 1 cell across", {}),
                           ("held, 2 cells across", {"mesh__set": "{length: 0.5, height: 0.5, breadth: 0.2, nx: 10, nz: 8, ny: 2}"})):
            report = run(f"held-{name.replace(' ', '-').replace(',', '')}-{tag}", EXACT / "held.yaml", **sets, **words)
            rows.append((how, name, report["steps"]["accepted"], ", ".join(f"{p:.6f}" for p in peaks(report))))
    return table(("steps", "block", "how many", "peaks of F_T/F_N"), rows)


def part_thin():
    """Free across the drive, thinner and thinner, and plane stress; steps of tolerance 3e-4."""
    fine, rows = {"time__tolerance": 3e-4, "load__supports": "[]"}, []
    report = run("thin-plane", EXACT / "held.yaml", mesh__file=SOURCE / "meshes/block.geo", mesh__set="{length: 0.5, height: 0.5, nx: 20, nz: 16}", **fine)
    rows.append(("plane stress", report["steps"]["accepted"], numbers(peaks(report))))
    for breadth in (0.2, 0.05, 0.0125, 0.003):
        report = run(f"thin-{breadth}", EXACT / "held.yaml", mesh__set=f"{{length: 0.5, height: 0.5, breadth: {breadth}, nx: 20, nz: 16, ny: 1}}", **fine)
        rows.append((f"breadth {breadth}", report["steps"]["accepted"], numbers(peaks(report))))
    report = run("thin-strain", EXACT / "held.yaml", mesh__file=SOURCE / "meshes/block.geo", material__plane="strain",
                 mesh__set="{length: 0.5, height: 0.5, nx: 20, nz: 16}", **fine)
    rows.append(("plane strain", report["steps"]["accepted"], numbers(peaks(report))))
    return table(("block", "steps", "peaks of F_T/F_N"), rows)


PICTURES = (   # figure, its file, options, what it shows
    ("contact-plane", "contact-plane.png", (), "The contact from above, driven to the right: slow slip grows from the trailing end, fastest in the middle, where the rod pushes, before it turns rapid"),
    ("contact-plane", "contact-plane-arrival.png", ("--of", "arrival"), "When rapid slip came to each node: all of the contact within three steps of the history"),
    ("contact-plane", "contact-plane-shear_over_pressure.png", ("--of", "shear_over_pressure"), "Shear over pressure: friction at rest is 0.38, at full speed 0.1"),
    ("field", "field-velocity.png", ("--of", "velocity", "--cut", "x=0.25,y=0.375"), "The block cut along both middles, its contact below it"))


def part_pictures():
    run("wide-block", SOURCE / "docs/examples/space.yaml")
    shown = []
    for figure, name, words, shows in PICTURES:
        words = (*words, "--dpi", "250")
        command = ["render", KEPT / "wide-block", "--figure", figure, *words, "--overwrite"]
        subprocess.run([PROGRAMS / "amontons", *command], check=True, stdout=subprocess.DEVNULL)
        shutil.copy(KEPT / "wide-block/figures" / name, HERE / name)
        shown.append(f"{shows}:\n\n![{shows}]({name})\n\n`amontons render results/space/wide-block --figure {figure}{''.join(' ' + w for w in words)}`\n")
    return "Of the block of [docs/examples/space.yaml](../../docs/examples/space.yaml), pushed by a rod 0.3 broad in the middle of its face.\n\n" + "\n".join(shown)


HEADS = {"exact": "Against what is exact", "explicit": "Against explicit steps of the same mesh", "held": "Held across the drive: plane strain",
         "thin": "Thin: plane stress", "pictures": "Pictures"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART")
    wanted = parser.parse_args().parts or PARTS
    KEPT.mkdir(parents=True, exist_ok=True)
    texts = json.loads((KEPT / "texts.json").read_text()) if (KEPT / "texts.json").exists() else {}
    for part in wanted:
        if part not in PARTS:
            parser.error(f"unknown part {part}; there are {', '.join(PARTS)}")
        texts[part] = globals()[f"part_{part}"]()
        (KEPT / "texts.json").write_text(json.dumps(texts))
        print(f"{part}: done", file=sys.stderr, flush=True)
    page = ["<!-- by validation/space/limits.py -->\n# Blocks in space: what is exact, explicit steps, limits\n\nWritten by `validation/space/limits.py`; "
            "what it means stands in [README.md](README.md).\n"]
    page += [f"## {HEADS[part]}\n\n{texts[part]}" for part in PARTS if part in texts]
    (HERE / "limits.md").write_text("\n".join(page))


if __name__ == "__main__":
    main()
