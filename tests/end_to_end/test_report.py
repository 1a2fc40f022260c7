# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages of `amontons report`, read back strictly: elements nest, links have their targets, numbers are those of run.json,
pictures decode, nothing is loaded from elsewhere, and the words of a scene stay words."""
import base64
import hashlib
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
import zlib
from html.parser import HTMLParser
from pathlib import Path

import h5py
import numpy as np

import render_fixture

PROGRAM = Path(os.environ["AMONTONS_BIN"]) / "amontons"
SOURCE = Path(os.environ["AMONTONS_SOURCE"])
HOSTILE = """</title><script>alert(1)</script><img src=x onerror='alert(2)'> & "µ" ]]> -->"""
VOID = {"meta", "img", "input", "source", "br"}
ROUNDED = 0.6   # of the last digit shown


class Element:
    def __init__(self, name, attributes, parent):
        self.name, self.attributes, self.parent = name, dict(attributes), parent
        self.children, self.pieces = [], []

    def all(self, name=None, **wanted):
        for child in self.children:
            if (name is None or child.name == name) and all(
                    child.attributes.get(k.rstrip("_").replace("_", "-")) == v for k, v in wanted.items()):
                yield child
            yield from child.all(name, **wanted)

    @property
    def text(self):
        return "".join(p if isinstance(p, str) else p.text for p in self.pieces)


class Page(HTMLParser):
    """A tree, where every element must be closed by its own end tag."""

    def __init__(self, path):
        super().__init__(convert_charrefs=True)
        self.source = path.read_text()
        self.root = self.at = Element("", [], None)
        self.feed(self.source)
        self.close()
        assert self.at is self.root, f"<{self.at.name}> is not closed"

    def handle_starttag(self, name, attributes):
        element = Element(name, attributes, self.at)
        assert len(element.attributes) == len(attributes), "an attribute is given twice"
        self.at.children.append(element)
        self.at.pieces.append(element)
        if name not in VOID:
            self.at = element

    def handle_startendtag(self, name, attributes):
        self.handle_starttag(name, attributes)
        self.at = self.at if name in VOID else self.at.parent

    def handle_endtag(self, name):
        assert name == self.at.name, f"</{name}> ends <{self.at.name}>"
        self.at = self.at.parent

    def handle_data(self, data):
        self.at.pieces.append(data)

    def all(self, *name, **wanted):
        return list(self.root.all(*name, **wanted))


def report(*words, status=0, cwd=None):
    done = subprocess.run([PROGRAM, "report", *words], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == status, done
    return done.stdout if status == 0 else done.stderr


def decode(address):
    head, body = address.split(",", 1)
    assert head.endswith(";base64"), head
    return head[len("data:"):-len(";base64")], base64.b64decode(body, validate=True)


def png_size(data):
    """(width, height) of a PNG, whose checksums and pixels are whole."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, size, pixels, bits = 8, None, b"", 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            size, bits = struct.unpack(">II", body[:8]), {2: 3, 3: 1}[body[9]]
        pixels += body if kind == b"IDAT" else b""
        at += 12 + length
    assert len(zlib.decompress(pixels)) == size[1] * (1 + bits * size[0])
    return size


def number(words):
    """(value, half of the last digit) of what stands first in a cell."""
    found = re.match(r"([−]?)([\d.]+)(?:\D*10([−]?\d+))?", words.replace("\u202f", "").replace("×", " "))
    power = int((found[3] or "0").replace("−", "-"))
    decimals = len(found[2].partition(".")[2])
    return float(found[1].replace("−", "-") + found[2]) * 10**power, 10.0**(power - decimals)


class Sound(unittest.TestCase):
    def check_sound(self, page):
        """What every page must be."""
        ids = [e.attributes["id"] for e in page.all() if "id" in e.attributes]
        self.assertEqual(len(ids), len(set(ids)))
        for element in page.all():
            for name, value in element.attributes.items():
                self.assertFalse(name.startswith("on"), name)
                if name in ("src", "srcset"):
                    self.check_picture(*decode(value))
                elif name in ("href", "xlink:href") and value.startswith("#"):
                    self.assertIn(value[1:], ids)
                elif name == "href" and not value.startswith(("data:application/json", "./")):
                    self.assertEqual((element.name, value), ("a", "https://doi.org/10.1038/srep01586"))
            if element.name == "img":
                self.assertTrue(element.attributes["alt"])
        self.assertEqual([e.name for e in page.all() if e.name in ("link", "iframe", "object", "base", "form")], [])
        self.assertNotRegex(page.all("style")[0].text, r"url\(|@import")
        self.assertLess(len(page.source), 2e6)
        policy = page.all("meta", http_equiv="Content-Security-Policy")[0].attributes["content"]
        self.assertIn("default-src 'none'", policy)
        for kind in ("style", "script"):
            self.assertEqual(len(page.all(kind)), 1)
            digest = base64.b64encode(hashlib.sha256(page.all(kind)[0].text.encode()).digest()).decode()
            self.assertIn(f"{kind}-src 'sha256-{digest}'", policy)

    def check_picture(self, kind, data):
        if kind == "image/png":
            self.assertGreater(min(png_size(data)), 100)
        else:
            self.assertEqual(kind, "image/svg+xml")
            self.assertTrue(xml.etree.ElementTree.fromstring(data).tag.endswith("svg"))

    def check_number(self, cell, value):
        shown, last = number(cell.text)
        self.assertLessEqual(abs(shown - value), ROUNDED * last, cell.text)


class Run(Sound):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons_report_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.result = cls.folder / "one"
        subprocess.run([PROGRAM, "run", SOURCE / "validation/paper/fig1.yaml", "-o", cls.result, "--quiet", "--set",
                        f"title={HOSTILE}", "mesh.set.nx=10", "mesh.set.nz=4", "time.until.U=0.0045",
                        "output.fields.every_U=4e-4", "output.figures=[]"], check=True)
        cls.report = json.loads((cls.result / "run.json").read_text())
        said = report(cls.result)
        cls.file = cls.result / "report.html"
        assert said == f"report written: {cls.file}\n", said
        cls.page = Page(cls.file)

    def copy(self, name):
        shutil.copytree(self.result, self.folder / name)
        self.addCleanup(shutil.rmtree, self.folder / name)
        return self.folder / name

    def test_is_sound(self):
        self.check_sound(self.page)

    def test_words_of_a_scene_stay_words(self):
        self.assertEqual(self.report["scene"]["title"], HOSTILE)
        self.assertEqual([e.text for e in self.page.all("h1")], [HOSTILE])
        self.assertEqual([e.text for e in self.page.all("title")], [HOSTILE])
        self.assertIn(HOSTILE.split("'")[0].replace('"', '\\"'), self.page.all("pre", class_="scene")[0].text)

    def test_numbers(self):
        seen = {}
        for cell in self.page.all("td"):
            path = cell.attributes.get("data-path")
            kind = cell.attributes.get("data-events")
            if kind:
                seen[kind] = int(cell.text)
            if not path:
                continue
            value = self.report
            for key in path.split("."):
                value = value[key]
            seen[path] = value
            if value is None:
                self.assertEqual(cell.text, "none")
                continue
            self.check_number(cell, value)
            self.assertNotIn("±", cell.text)   # no error bar was asked for
            if path in ("results.mu_M", "results.mu_hold", "results.mu_max"):
                last = number(cell.text)[1]
                self.assertTrue(last <= self.report["results"][path.split(".")[1] + "_known_to"] < 10 * last, path)
        self.assertGreater(len(seen), 15)
        self.assertIsNotNone(seen["results.mu_M"])
        for kind in ("quasi-static", "bounded rapid", "leading rapid"):
            self.assertEqual(seen[kind], sum(e["kind"] == kind for e in self.report["results"]["events"]))

    def test_events_lead_to_their_frames(self):
        frames = {e.attributes["id"]: e for e in self.page.all("figure") if e.attributes.get("id", "").startswith("frame-")}
        shown = {name: number(re.search(r"= ([^,]+),", frame.text)[1])[0] for name, frame in frames.items()}
        self.assertEqual(list(shown.values()), sorted(shown.values()))
        rows = self.page.all("table", class_="events")[0].children[-1].children
        events = self.report["results"]["events"]
        self.assertEqual(len(rows), len(events))
        for row, event in zip(rows, events):
            cells = [c.text for c in row.children]
            self.assertEqual(cells[1], event["kind"].replace("leading rapid", "bulk sliding"))
            for cell, value in zip(row.children[2:7], (event["U_start"], event["U_stop"], event["t_stop"] - event["t_start"],
                                                       event["reach"], event["peak_slip_rate"] / 1e-5)):
                self.check_number(cell, value)
            link = next(row.all("a"))
            U = shown[link.attributes["href"][1:]]
            within = event["U_start"] - 1e-8 <= U <= event["U_stop"] + 1e-8
            self.assertEqual(within, not link.text.startswith("nearest"), (cells, U))
        stored = (self.result / "fields.pvd").read_text().count("bulk_")
        self.assertIn(f"{len(frames)} of {stored} stored times are shown", self.page.source)
        self.assertGreater(len(frames), 10)
        for frame in frames.values():
            self.assertEqual(len(list(frame.all("img"))), 1)

    def test_scene_can_be_run_again(self):
        link = self.page.all("a", download="scene.json")[0]
        self.assertEqual(json.loads(decode(link.attributes["href"])[1]), self.report["scene"])

    def test_states(self):
        folder = self.copy("states")
        (folder / "fields.pvd").unlink()
        told = dict(self.report, status="failed", message="the <b>step</b> got too small", warnings=["doubt & <i>doubt</i>"])
        (folder / "run.json").write_text(json.dumps(told, indent=2))
        report(folder)
        page = Page(folder / "report.html")
        self.check_sound(page)
        boxes = [b.text for b in page.all("p") if b.attributes.get("class", "").startswith("box")]
        self.assertEqual(boxes, ["Not complete: this run failed: the <b>step</b> got too small", "Warning: doubt & <i>doubt</i>"])
        (folder / "run.json").unlink()
        os.rename(folder / "history.h5", folder / "history.h5.part")
        report(folder)
        page = Page(folder / "report.html")
        self.check_sound(page)
        self.assertIn("has not ended", page.all("p", class_="box failure")[0].text)
        self.assertEqual(page.all("td", data_path="results.mu_M"), [])
        self.assertRegex(page.source, r"\d+ of \d+ steps of the history are shown")

    def test_without_mu_M(self):
        """271 peaks none of which counts, as of a run that is run in all the time: the page says that there is no mu_M and why, and
        calls no peak one of it."""
        why = "what slidings of the whole block there were belong to the start or run-in"
        folder = self.copy("no-mu")
        none = {"mu_M": None, "mu_M_error": None, "mu_M_known_to": None, "mu_M_peaks": 271}
        told = json.loads((folder / "run.json").read_text())
        for words, reason in ((f"none: {why}", why), (None, "the block as a whole did not slide after the start")):
            told["results"] |= none | {"mu_M_is": words}
            (folder / "run.json").write_text(json.dumps(told, indent=2))
            report(folder)
            page = Page(folder / "report.html")
            self.check_sound(page)
            self.assertIn(f"There is no μM: {reason}.", page.all("p", class_="lead")[0].text)
            rows = {row.children[1].attributes["data-path"]: [c.text for c in row.children]
                    for row in page.all("tr") if len(row.children) > 2 and "data-path" in row.children[1].attributes}
            self.assertEqual(rows["results.mu_M"][1], "none")
            self.assertEqual(rows["results.mu_M_peaks"][:2], ["peaks behind the start", "271"])
            self.assertNotRegex(page.all("section", id="numbers")[0].text, "count[, ]* for")

    def test_damage_is_told(self):
        """A picture that cannot be drawn costs its place, not the page."""
        folder = self.copy("damaged")
        for file in (folder / "fields").glob("bulk_*5.vtu"):
            file.write_text("damaged")
        with h5py.File(folder / "history.h5", "a") as history:
            del history["interface/slip_rate"]
        (folder / "figures").mkdir(exist_ok=True)
        (folder / "figures/accuracy.json").write_text('{"title": "x", "series": [{"label": "a", "x": [1, 2], "y": [1, 2]}]}')
        report(folder)
        page = Page(folder / "report.html")
        self.assertEqual(len(page.all("picture")), 2, "the force curve needs no slip rates; and the error bar's figure")
        self.check_sound(page)
        self.assertGreaterEqual(len(page.all("p", class_="box failure")), 1)
        self.assertTrue(page.all("td", data_path="results.mu_M"))

    def test_comparison(self):
        other = self.copy("other")
        told = json.loads((other / "run.json").read_text())
        told["scene"]["load"]["pressure"] = 0.004
        told["results"]["mu_M"] = 0.25
        (other / "run.json").write_text(json.dumps(told, indent=2, ensure_ascii=False))
        file = self.folder / "both.html"
        report(self.result, other, "-o", file)
        page = Page(file)
        self.check_sound(page)
        for cell, value in zip(page.all("td", data_path="results.mu_M"), (self.report["results"]["mu_M"], 0.25), strict=True):
            self.check_number(cell, value)
        differences = next(page.all("section", id="differences")[0].all("tbody"))
        self.assertEqual([[c.text for c in row.children] for row in differences.children],
                         [["load.pressure", "0.003", "0.004"]])
        (self.folder / "there").mkdir(exist_ok=True)
        shutil.copytree(other, self.folder / "there/one", dirs_exist_ok=True)
        (self.folder / "there/one/history.h5").unlink()
        report("one", "there/one", "-o", "names.html", cwd=self.folder)
        named = Page(self.folder / "names.html")
        self.assertEqual([h.text for h in next(named.all("thead")[0].all("tr")).children[1:3]], ["one", "there/one"])
        self.assertIn("1 of 2 runs kept no history", named.source)
        curves = [p for p in page.all("path") if re.fullmatch(r"curve\d", p.attributes["class"]) and len(p.attributes["d"]) > 99]
        self.assertEqual(len(curves), 2)

    def test_same_page_again(self):
        report(self.result, "-o", self.folder / "again.html")
        self.assertEqual((self.folder / "again.html").read_bytes(), self.file.read_bytes())

    def test_errors(self):
        empty = self.folder / "empty"
        empty.mkdir(exist_ok=True)
        self.assertIn("not the result of a run or a sweep", report(empty, status=2))
        self.assertEqual(list(empty.iterdir()), [])
        self.assertIn("cannot open the result", report(self.folder / "nowhere", status=2))
        self.assertIn("is a file, not a result folder", report(self.file, status=2))
        self.assertIn("needs a result folder", report(status=2))
        self.assertIn("cannot write", report(self.result, "-o", self.folder / "no/such.html", status=1))
        self.assertIn("up to 8", report(*[self.result] * 9, "-o", empty / "many.html", status=2))
        (empty / "run.json").write_text('{"status": "done"')
        self.assertIn("ends before its last bracket", report(empty, status=2))
        (empty / "run.json").unlink()
        self.assertEqual(list(empty.iterdir()), [])


class Sweep(Sound):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="amontons_report_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        study = {"title": "Two of <three>", "scene": str(SOURCE / "validation/paper/fig1.yaml"),
                 "set": {"mesh.set.nz": 4, "time.until.U": 0.0042, "output.fields": "none"},
                 "vary": {"mesh.set.nx": [8, 10, 0]}, "plot": {"x": "mesh.set.nx", "y": "mu_hold"},
                 "rank": {"by": "mu_hold", "order": "highest", "top": 3}}
        (cls.folder / "study.json").write_text(json.dumps(study))
        subprocess.run([PROGRAM, "sweep", cls.folder / "study.json", "-o", cls.folder / "sweep", "-q", "-j1"],
                       capture_output=True)
        report(cls.folder / "sweep")
        cls.page = Page(cls.folder / "sweep/report.html")

    def test_page(self):
        self.check_sound(self.page)
        self.assertEqual(self.page.all("h1")[0].text, "Two of <three>")
        self.assertIn("2 of 3 points are done, 1 failed", self.page.all("p", class_="box failure")[0].text)
        points = next(self.page.all("section", id="points")[0].all("table"))
        names = [c.text for c in points.all("th")]
        with h5py.File(self.folder / "sweep/sweep.h5") as table:
            hold = table["result/mu_hold"][:].ravel()
        for row, value in zip(points.children[-1].children, hold, strict=True):
            cell = row.children[names.index("mu_hold")]
            if np.isfinite(value):
                self.check_number(cell, value)
            else:
                self.assertEqual(cell.text, "none")
            self.assertNotIn("±", cell.text)   # no error bar was asked for
        self.assertEqual([row.children[names.index("status")].text for row in points.children[-1].children],
                         ["done", "done", "failed"])
        self.assertEqual(len(self.page.all("picture")), 2)
        failed = next(self.page.all("section", id="doubts")[0].all("tbody"))
        self.assertIn("nx", failed.children[0].children[1].text)

    def test_runs_alone_are_compared(self):
        said = report(self.folder / "sweep", self.folder, "-o", self.folder / "x.html", status=2)
        self.assertIn("is a sweep: only runs are compared", said)


class History(Sound):
    """A history alone, of pads in SI units."""

    def test_pads(self):
        folder = Path(tempfile.mkdtemp(prefix="amontons_report_"))
        self.addCleanup(shutil.rmtree, folder)
        render_fixture.make(str(folder), pads=3, units="si", length=0.1)
        report(folder)
        page = Page(folder / "report.html")
        self.check_sound(page)
        frame = page.all("figure", id="frame-1")[0]
        curve = [p for p in frame.all("path") if p.attributes["class"] == "curve1"][0]
        self.assertEqual(curve.attributes["d"].count("M"), 3)
        self.assertIn("(mm)", page.all("g", id="common-axes")[0].text)


if __name__ == "__main__":
    unittest.main()
