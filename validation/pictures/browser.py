#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Opens pages of `amontons report` in headless Chromium, as a reader would: wide and narrow, light and dark, printed, by
keyboard, without a script. Leaves a picture of each, and fails on any word on the console, any request beyond the page, a
key or link that does not do what it should, or a page wider than its window.

    browser.py FOLDER PAGE.html ...     pictures into FOLDER

Needs Debian's chromium and python3-websocket.
"""
import argparse
import base64
import json
import re
import subprocess
import tempfile
import time
import urllib.request
from pathlib import Path

import websocket

WIDE, NARROW = (1280, 900), (390, 844)
KEYS = {"Tab": 9, "Enter": 13, "End": 35, "Home": 36, "ArrowRight": 39}


class Browser:
    """Chromium behind its DevTools protocol: commands, and the events that came meanwhile."""

    def __init__(self, folder):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.process = subprocess.Popen(
            ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0",
             "--remote-allow-origins=*", f"--user-data-dir={self.profile.name}", "about:blank"],
            stderr=subprocess.PIPE, text=True)
        for line in self.process.stderr:
            found = re.search(r"ws://[^/]+", line)
            if found:
                break
        port = found[0].split(":")[-1]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list") as answer:
            page = next(p for p in json.load(answer) if p["type"] == "page")
        self.socket = websocket.create_connection(page["webSocketDebuggerUrl"], timeout=120)
        self.number, self.events, self.folder = 0, [], folder
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self.socket.recv())
            if answer.get("id") == self.number:
                assert "error" not in answer, (method, answer)
                return answer["result"]
            self.events.append(answer)

    def ask(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, (expression, result)
        return result["result"].get("value")

    def open(self, address, size, dark=False, script=True, media=""):
        self.call("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia", media=media,
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.call("Emulation.setScriptExecutionDisabled", value=not script)
        for url in ("about:blank", address):
            self.events.clear()
            self.call("Page.navigate", url=url)
            while not any(e.get("method") == "Page.loadEventFired" for e in self.events):
                self.events.append(json.loads(self.socket.recv()))
        time.sleep(0.3)

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            extra = {"text": "\r"} if name == "Enter" and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=KEYS[name], **extra)

    def picture(self, name, whole=True):
        shot = self.call("Page.captureScreenshot", captureBeyondViewport=whole, **(
            {"clip": {"x": 0, "y": 0, "scale": 1, **{k: v for k, v in self.call("Page.getLayoutMetrics")["cssContentSize"].items()
                                                      if k in ("width", "height")}}} if whole else {}))
        (self.folder / f"{name}.png").write_bytes(base64.b64decode(shot["data"]))

    def print(self, name):
        done = self.call("Page.printToPDF", preferCSSPageSize=False, paperWidth=8.27, paperHeight=11.69)
        (self.folder / f"{name}.pdf").write_bytes(base64.b64decode(done["data"]))

    def complaints(self, address):
        """Console, exceptions, and requests of anything but the page itself and what it holds."""
        found = [e for e in self.events if e.get("method") in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")]
        for event in self.events:
            if event.get("method") == "Network.requestWillBeSent":
                url = event["params"]["request"]["url"]
                if url.split("#")[0] != address and not url.startswith(("data:", "about:")):
                    found.append(url)
        return found

    def close(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait()
        self.profile.cleanup()


def look(browser, address, name, checks):
    """Pictures of one page in every way it may be read."""
    for way, size, dark in (("wide", WIDE, False), ("dark", WIDE, True), ("narrow", NARROW, False)):
        browser.open(address, size, dark)
        browser.picture(f"{name}-{way}")
        checks[f"{name} {way}: nothing on the console, nothing requested"] = not browser.complaints(address)
        wide = browser.ask("document.documentElement.scrollWidth - innerWidth")
        checks[f"{name} {way}: not wider than the window"] = wide <= 0
        broken = browser.ask("Promise.all(Array.from(document.images, i => i.decode().then(() => 0, () => 1)))"
                             ".then(all => all.reduce((a, b) => a + b, 0))")
        checks[f"{name} {way}: every picture can be decoded"] = broken == 0
    browser.open(address, WIDE, script=False)
    browser.picture(f"{name}-no-script", whole=False)
    browser.open(address, WIDE, dark=True)
    browser.print(name)


def press(browser, address, name, checks):
    """The keyboard alone: skip link, slider, a link of the table of events, play."""
    browser.open(address, WIDE)
    number = "Number(document.getElementById('slider').value)"
    shown = "document.querySelector('.frame.now').id"
    browser.key("Tab")
    checks[f"{name}: the first key leads to the skip link"] = browser.ask("document.activeElement.className") == "skip"
    browser.key("Enter")
    checks[f"{name}: which leads to the results"] = browser.ask("document.activeElement.id") == "main"
    if not browser.ask("!!document.querySelector('.frames')"):
        return
    for _ in range(20):
        if browser.ask("document.activeElement.id") == "slider":
            break
        browser.key("Tab")
    checks[f"{name}: the slider is reached"] = browser.ask("document.activeElement.id") == "slider"
    browser.key("Home")
    checks[f"{name}: Home shows the first frame"] = browser.ask(shown) == "frame-1"
    browser.key("ArrowRight")
    checks[f"{name}: an arrow shows the next"] = (browser.ask(number), browser.ask(shown)) == (2, "frame-2")
    browser.key("End")
    last = browser.ask("document.querySelectorAll('.frame').length")
    checks[f"{name}: End shows the last"] = browser.ask(shown) == f"frame-{last}"
    words = browser.ask("document.getElementById('slider').getAttribute('aria-valuetext')")
    checks[f"{name}: a reader hears which"] = words.startswith(f"Frame {last} of {last}")
    target = browser.ask("(() => {const a = document.querySelector('.events a'); a.focus(); return a.getAttribute('href')})()")
    if target:
        browser.key("Enter")
        time.sleep(0.3)
        checks[f"{name}: a link of the events shows its frame"] = "#" + browser.ask(shown) == target
        checks[f"{name}: and brings it into sight"] = browser.ask(
            "(r => r.top >= 0 && r.top < innerHeight)(document.querySelector('.frame.now').getBoundingClientRect())")
        browser.picture(f"{name}-event", whole=False)
    browser.ask("document.getElementById('slider').value = 1, document.getElementById('back').click(), "
                "document.getElementById('play').focus()")
    browser.key("Enter")
    time.sleep(1)
    checks[f"{name}: Play goes on"] = browser.ask(number) > 1
    browser.key("Enter")
    checks[f"{name}: nothing on the console"] = not browser.complaints(address)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("pages", type=Path, nargs="+", metavar="PAGE.html")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    browser, checks = Browser(given.folder), {}
    try:
        for page in given.pages:
            name = f"{page.resolve().parent.name}-{page.stem}"
            address = page.resolve().as_uri()
            look(browser, address, name, checks)
            press(browser, address, name, checks)
    finally:
        browser.close()
    for check, holds in checks.items():
        print("ok  " if holds else "FAIL", check)
    print(f"{sum(checks.values())} of {len(checks)} checks hold; pictures in {given.folder}")
    return 0 if all(checks.values()) else 1


if __name__ == "__main__":
    raise SystemExit(main())
