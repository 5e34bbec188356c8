#!/usr/bin/env python3
"""Photographs every page of a running `hasard serve`: three widths, light and dark.

    hasard serve runs --listen 127.0.0.1:8351
    python3 tools/photograph.py 127.0.0.1:8351 docs/pictures

It drives Chromium through chromedriver, which must be installed, and needs runs of at least two
experiments. Files are called serve_PAGE_WIDTH_light.png and serve_PAGE_WIDTH_dark.png.
"""

import base64
import json
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

WIDTHS = {390: 1700, 1280: 1000, 1920: 1080}


def ask(address, path, body=None, method=None):
    """Asks chromedriver or the page's server; gives the JSON of its answer."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(f"http://{address}{path}", data, {"content-type": "application/json"}, method=method)
    with urllib.request.urlopen(request, timeout=120) as answer:
        return json.load(answer)


class Browser:
    """A window of Chromium without a screen."""

    def __init__(self, width, height, dark):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL)
        self.address = f"127.0.0.1:{port}"
        for _ in range(200):
            try:
                ask(self.address, "/status")
                break
            except OSError:
                time.sleep(0.1)
        flags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", f"--window-size={width},{height}"]
        options = {"args": flags}
        wanted = {"capabilities": {"alwaysMatch": {"browserName": "chrome", "goog:chromeOptions": options}}}
        self.session = "/session/" + ask(self.address, "/session", wanted)["value"]["sessionId"]
        media = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.chrome("Emulation.setEmulatedMedia", {"features": media})
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.chrome("Emulation.setDeviceMetricsOverride", size)

    def chrome(self, command, params):
        """A command of Chromium's own protocol."""
        return ask(self.address, self.session + "/goog/cdp/execute", {"cmd": command, "params": params})["value"]

    def go(self, address):
        """Opens an address anew."""
        ask(self.address, self.session + "/url", {"url": "about:blank"})
        ask(self.address, self.session + "/url", {"url": address})

    def script(self, text):
        """What a script in the page returns."""
        return ask(self.address, self.session + "/execute/sync", {"script": text, "args": []})["value"]

    def wait(self, text, seconds=90):
        """Waits until a script says yes."""
        end = time.time() + seconds
        while time.time() < end:
            if self.script(f"try {{ return Boolean({text}) }} catch {{ return false }}"):
                return
            time.sleep(0.3)
        raise SystemExit(f"waited {seconds} s in vain for: {text}")

    def photograph(self, path):
        """Keeps what the window shows."""
        picture = self.chrome("Page.captureScreenshot", {"format": "png"})["data"]
        path.write_bytes(base64.b64decode(picture))

    def end(self):
        """Closes the window."""
        try:
            ask(self.address, self.session, method="DELETE")
        finally:
            self.driver.kill()
            self.driver.wait()


def evaluated(run):
    """Whether its selected checkpoint was evaluated."""
    return bool((run.get("evaluation") or {}).get("return"))


def family(runs):
    """The evaluated runs of the environment that has most of them, the longest first."""
    count = {}
    for run in filter(evaluated, runs):
        count[run["env"]] = count.get(run["env"], 0) + 1
    env = max(count, key=lambda name: (count[name], name))
    own = [run for run in runs if run["env"] == env and evaluated(run)]
    return sorted(own, key=lambda run: (-run["last"].get("frames", 0), run["algo"], run["seed"]))


def pages(server):
    """Name, address and what is there when the page is drawn."""
    runs = ask(server, "/api/runs")["runs"]
    some = family(runs)[:8]
    run, chosen = some[-1], ",".join(one["id"] for one in some)
    numbers = "document.querySelector('#numbers b')"
    watched = f"watch?agent=run:{run['id']}&best=true&seed=2&step=150&paused=true"
    yield "runs", "runs", "document.querySelectorAll('tbody tr').length > 0"
    yield "compare", f"runs?chosen={chosen}", "document.querySelectorAll('.facet svg.chart path').length > 8"
    yield "run", f"run?id={run['id']}", "document.querySelectorAll('svg.chart path').length > 20 && document.querySelector('.ends').innerText.includes('%')"
    strip = "document.querySelectorAll('#episodes circle').length > 9"
    yield "watch", watched, f"{numbers} && {strip} && document.querySelectorAll('[data-kind]').length > 3"
    scenario = run["env"].removesuffix("-v0")
    beside = f"{watched}&second=zoo:{scenario}"
    yield "beside", beside, f"{numbers} && document.getElementById('second-words').innerText.includes('step 150')"
    yield "play", "play?env=RemedyRushLevel1-v0", f"{numbers} && document.querySelectorAll('#best tbody tr').length > 0"


def main():
    """Photographs them all."""
    server, folder = sys.argv[1], Path(sys.argv[2])
    for width, height in WIDTHS.items():
        for dark in (False, True):
            browser = Browser(width, height, dark)
            try:
                for name, page, ready in pages(server):
                    browser.go(f"http://{server}/#{page}")
                    browser.wait(ready)
                    if name == "compare":
                        browser.script("document.querySelector('.facet').scrollIntoView()")
                    time.sleep(1.5)
                    browser.photograph(folder / f"serve_{name}_{width}_{'dark' if dark else 'light'}.png")
            finally:
                browser.end()


if __name__ == "__main__":
    main()
