#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs what pages show, as their reader would: each command behind `$ ` in a block ```console, in the order in which they
stand, in a folder of its own.

    docs/examples/shown.py README.md docs/*.md     # writes what they print, and their pictures, anew
    docs/examples/shown.py --check README.md       # changes nothing: is what they print of mu still so?
    docs/examples/shown.py --small docs/*.md       # changes nothing: coarse meshes, do they all end well?

`<!-- small: KEY=VALUE -->` above a block says what is coarse there. A line `<!-- from FILE -->` above a picture names the file that a command made: it is kept in docs/pictures, small enough
for a page. A block that begins with `# docs/examples/NAME` (or `//`) shows that file. In a sentence, `0.329 +- 0.003<!-- mu_M of results/NAME -->` is what
the command with `-o results/NAME` prints behind mu_M; `mu_M of ./amontons run SCENE ...` names a command that the page does not show. --check: each mu within the larger of both bars, 1 of the last digit shown, or 1 % (runs differ by that
from processor to processor, as slip goes one cell farther or not); only what prints a mu is run, and what it needs.
"""
import argparse
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("AMONTONS_BIN", SOURCE / "build" / "bin")).resolve().parent
WIDTH = 900   # of a picture, pixels
COARSE = "mesh.set.refine=0.15"
CLOSE = 0.01   # of mu
VALUE = r"[\d.]+(?:e[-+]?\d+)?"
MU = re.compile(rf"^ +(mu_\w+) +(({VALUE})(?: \+- ({VALUE}))?)(?=[ :,]|$)", re.M)   # a line of what a run ends with
BLOCK = r"^(?:<!-- small: (\S+) -->\n)?```console\n(.*?)^```\n"
RESULT = re.compile(r" -o (\S+)")
IN_SENTENCE = re.compile(rf"(({VALUE})(?:\s\+-\s({VALUE}))?)(<!-- (mu_\w+) of (\./amontons [^>]+|\S+) -->)")
# Coarse meshes, wide error bars or none, whatever the command asks for.
SMALL = r"""#!/bin/bash
words=()
for word; do
    [[ ${before-} == --to ]] && word=50%
    before=$word
    words+=("$word")
done
case $1 in run | static | stability) words+=(--set "$COARSE") ;; sweep) words+=(-j 1 --set "$COARSE" accuracy.mu=0) ;; esac
exec PROGRAM "${words[@]}"
"""


def prepare(folder, small):
    """What the reader has: a checkout, built."""
    for name in ("docs", "meshes", "validation"):
        (folder / name).symlink_to(SOURCE / name)
    text = SMALL if small else "#!/bin/bash\nexec PROGRAM \"$@\"\n"
    (folder / "amontons").write_text(text.replace("PROGRAM", f"'{BUILD}/bin/amontons'"))
    (folder / "amontons").chmod(0o755)
    return dict(os.environ, PATH="/usr/bin:/bin", PYTHONPATH=str(BUILD / "python"), MPLBACKEND="Agg",
                AMONTONS_CACHE=os.environ.get("AMONTONS_CACHE") or str(folder / "cache"), LC_ALL="C.UTF-8", COLUMNS="100")


def printed(command, folder, environment):
    """What a command prints, without the bar of progress; it must end well."""
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    if done.returncode:
        raise SystemExit(f"{command}\nstatus {done.returncode}\n{done.stdout}")
    return "".join(line for line in done.stdout.replace("\r", "\n").splitlines(True)
                   if not re.match(r"(mesh \d+, run \d+, )? *\d+ %|.*\bleft$|amontons: building", line))


def run_here(words, folder):
    """A Python script on a coarse mesh, in this process: matplotlib takes longer to load than the script runs."""
    sys.argv = [*words[1:], COARSE]
    os.chdir(folder)
    runpy.run_path(words[1], run_name="__main__")


def commands(block):
    """Each command of a block ```console with what is printed below it."""
    return re.findall(r"^\$ ((?:[^\n]*\\\n)*[^\n]*)\n(.*?)(?=^\$ |\Z)", block, re.S | re.M)


def agree(shown, made):
    """Of two (value, bar or None), as written."""
    bars = [float(bar) for _, bar in (shown, made) if bar]
    digit = 10.0 ** -len(shown[0].partition(".")[2])
    return abs(float(shown[0]) - float(made[0])) <= 1.001 * max([*bars, digit, CLOSE * abs(float(made[0]))])


def that_tell(text):
    """Commands of a page that print a mu, a result that a sentence quotes, or what such a command needs."""
    every = [each for block in re.findall(BLOCK, text, re.S | re.M) for each in commands(block[1])]
    wanted, tell = {result for *_, result in IN_SENTENCE.findall(text)}, set()
    for command, shown in reversed(every):
        makes = set(RESULT.findall(command))
        if MU.search(shown) or makes & wanted:
            tell.add(command)
            wanted |= set(re.findall(r"results/[\w.-]+", command)) - makes
    return tell


def mu_lines(text):
    """{name: (as written, value, bar or None)}"""
    return {name: found for name, *found in MU.findall(text)}


def beginnings(text):
    """Of its lines, up to the first number: that does not differ from run to run."""
    return [" ".join(re.match(r"\D*", line)[0].split()) for line in text.splitlines()]


def differences(shown, made):
    """Sentences on what a block shows and a command does not print, or prints otherwise: each mu, and how each line begins."""
    before, now, lines = mu_lines(shown), mu_lines(made), beginnings(made)
    gone = [f"a line is shown that is no longer printed: {line} ..." for line in beginnings(shown) if line not in lines]
    return gone + [f"{name}: {before[name][0]} is shown, {now[name][0] if name in now else 'nothing'} comes out" for name in before
            if name not in now or not agree(before[name][1:], now[name][1:])]


def sentences(text, printed_by, small, apart):
    """The page with the numbers in its sentences as printed. `apart` takes sentences on what does not agree."""
    def number(found):
        shown, value, bar, mark, name, result = found.groups()
        made = mu_lines(printed_by.get(result, "")).get(name)
        if small and result.startswith("./"):
            return found[0]
        if not made:
            raise SystemExit(f"no command prints {name} of {result}")
        if not small and not agree((value, bar), made[1:]):
            apart.append(f"{name} of {result}: {shown} in a sentence, {made[0]} comes out")
        return made[0] + mark
    return IN_SENTENCE.sub(number, text)


def keep_picture(made, kept):
    from PIL import Image
    if made.suffix == ".gif":   # a film
        shutil.copyfile(made, kept)
        return
    picture = Image.open(made).convert("RGB")
    if picture.width > WIDTH:
        picture = picture.resize((WIDTH, round(picture.height * WIDTH / picture.width)), Image.LANCZOS)
    kept.parent.mkdir(exist_ok=True)
    # Refined: the colours of a map are many and near to each other.
    picture.quantize(256, kmeans=4, dither=Image.Dither.NONE).save(kept, optimize=True)


def run_page(page, folder, environment, options):
    text, small = page.read_text(), options.small
    tell, printed_by, apart = that_tell(text), {}, []   # what each result's command prints; sentences on what does not agree

    def block(found):
        shown = ""
        environment["COARSE"] = found[1] or COARSE
        for command, before_now in commands(found[2]):
            if options.check and command not in tell:
                continue
            before = os.times()
            if small and command.startswith("python3 "):
                run_here(command.split(), folder)
            else:
                made = printed(command, folder, environment)
                shown += f"$ {command}\n" + made
                printed_by.update({result: made for result in RESULT.findall(command)})
                apart.extend([] if small else differences(before_now, made))
            after = os.times()
            print(f"{page.name}: {sum(after[:4]) - sum(before[:4]):5.1f} s  {command}", file=sys.stderr, flush=True)
        return found[0][:found.start(2) - found.start()] + shown + "```\n"

    written = re.sub(BLOCK, block, text, flags=re.S | re.M)
    for made, kept in () if options.check else re.findall(r"<!-- from (\S+) -->\n!\[[^\]]*\]\((\S+)\)", text):
        if not (folder / made).is_file():
            raise SystemExit(f"{page.name}: no command makes {made}")
        if not small:
            keep_picture(folder / made, page.parent / kept)
    for mark, name, shown in re.findall(r"^```\w*\n((?:#|//) (docs/examples/\S+)\n)(.*?)^```", text, re.S | re.M):
        if (SOURCE / name).read_text() != shown:
            written = written.replace(mark + shown, mark + (SOURCE / name).read_text())
            if small:
                raise SystemExit(f"{page.name} shows another {name}")
    for *_, source in [] if small else IN_SENTENCE.findall(text):
        if source.startswith("./"):
            printed_by[source] = printed_by.get(source) or printed(f"{source} -o results/sentence --overwrite", folder, environment)
    written = sentences(written, printed_by, small, apart)
    if not small and not options.check:
        page.write_text(written)
    return apart


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--small", action="store_true", help="coarse meshes; no page is changed")
    parser.add_argument("--check", action="store_true", help="no page is changed; exit status 1: a mu is no longer what is shown")
    parser.add_argument("pages", nargs="+", type=Path)
    options = parser.parse_args()
    folder, apart = Path(tempfile.mkdtemp(prefix="amontons-shown-")), []
    try:
        environment = prepare(folder, options.small)
        os.environ.update(environment)
        sys.path.insert(0, environment["PYTHONPATH"])
        for page in options.pages:
            shutil.rmtree(folder / "results", ignore_errors=True)
            (folder / "results").mkdir()
            apart += [f"{page.name}: {each}" for each in run_page(page.resolve(), folder, environment, options)]
    finally:
        shutil.rmtree(folder)
    print("\n".join(apart))
    return 1 if apart and options.check else 0


if __name__ == "__main__":
    sys.exit(main())
