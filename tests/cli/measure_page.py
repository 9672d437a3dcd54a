#!/usr/bin/env python3
"""The page of `levelray measure`, opened in a real browser: everything is drawn, nothing is fetched, nothing complains.

Usage: measure_page.py PROGRAM [FOLDER]     with FOLDER: also puts pictures of the page there
"""

import base64
import fcntl
import json
import math
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
if not BROWSER:
    print("SKIPPED: no chromium is installed (scripts/setup test)")
    sys.exit(77)


class Browser:
    """Chromium, spoken to by its DevTools protocol through two pipes."""

    def __init__(self, folder):
        to_child, to_browser = os.pipe()
        from_browser, from_child = os.pipe()
        # The child wants them as 3 and 4, which the originals might be.
        inner = [fcntl.fcntl(fd, fcntl.F_DUPFD, 20) for fd in (to_child, from_child)]
        os.close(to_child)
        os.close(from_child)

        def place():
            os.dup2(inner[0], 3)
            os.dup2(inner[1], 4)

        self.process = subprocess.Popen(
            [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-extensions",
             "--remote-debugging-pipe", "--user-data-dir=" + folder, "--window-size=1400,1000", "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=place, pass_fds=(3, 4))
        for fd in inner:
            os.close(fd)
        self.output, self.input = to_browser, from_browser
        self.buffer, self.events, self.number, self.session = b"", [], 0, None

    def receive(self, deadline):
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.input], [], [], max(0, deadline - time.monotonic()))
            if not ready:
                raise TimeoutError("the browser does not answer")
            data = os.read(self.input, 1 << 20)
            if not data:
                raise RuntimeError("the browser has ended")
            self.buffer += data
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, seconds=120, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.output, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + seconds
        while True:
            answer = self.receive(deadline)
            if answer.get("id") == self.number:
                assert "error" not in answer, (method, answer["error"])
                return answer["result"]
            self.events.append(answer)

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in result, (expression, result["exceptionDetails"])
        return result["result"].get("value")

    def attach(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def open(self, path):
        self.call("Page.navigate", url="file://" + path)
        deadline = time.monotonic() + 120
        while self.evaluate("document.documentElement?.dataset.ready") != "yes":
            assert time.monotonic() < deadline, "the page's script did not come to its end"
            time.sleep(0.1)

    def close(self):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def check(browser, page, document, word):
    browser.events.clear()
    browser.open(page)
    requests = [e["params"]["request"]["url"] for e in browser.events if e.get("method") == "Network.requestWillBeSent"]
    others = [url for url in requests if url != "file://" + page and not url.startswith("data:")]
    assert others == [], f"requests: {others}"
    assert requests, "not even the page itself was seen to be requested: the check is blind"
    complaints = [e["params"] for e in browser.events
                  if e.get("method") in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")]
    assert complaints == [], f"console: {complaints}"

    plots = [p for s in document["sections"] for p in s["plots"]]
    tables = [t for s in document["sections"] for t in s["tables"]]
    assert browser.evaluate("document.querySelectorAll('figure.plot').length") == len(plots)
    for plot in plots:
        at = f"document.getElementById('plot-{plot['id']}')"
        some = [s for s in plot["series"] if s["points"]]
        assert some, f"plot {plot['id']} is empty"
        assert browser.evaluate(f"{at}.querySelectorAll('g.series').length") == len(plot["series"])
        # A line and a mark per point, all within the picture.
        for i, series in enumerate(reversed(plot["series"])):
            shapes = browser.evaluate(f"{at}.querySelectorAll('g.series')[{i}].querySelectorAll('polyline,circle,rect,path').length")
            lines = 0 if plot.get("kind") == "trade" else 1
            assert shapes == lines + len(series["points"]), (plot["id"], series["name"], shapes)
        if plot.get("kind") == "trade":
            front = sum(point[3] for s in plot["series"] for point in s["points"])
            assert front > 0 and browser.evaluate(f"{at}.querySelectorAll('text.label').length") == front, plot["id"]
            assert browser.evaluate(f"{at}.querySelector('polyline.front').points.numberOfItems") == 2 * front - 1, plot["id"]
        inside = browser.evaluate(f"""(() => {{ const f = {at}.querySelector('svg').getBoundingClientRect();
            return f.width > 100 && [...{at}.querySelectorAll('svg g.series *:not(title)')].every(e => {{
            const r = e.getBoundingClientRect();
            return r.left >= f.left && r.right <= f.right + 1 && r.top >= f.top - 1 && r.bottom <= f.bottom + 1; }}); }})()""")
        assert inside, f"plot {plot['id']} leaves its frame"
        shown = browser.evaluate(f"{at}.textContent")
        for series in plot["series"]:
            assert series["name"] in shown, (plot["id"], series["name"])
    for table in tables:
        at = f"document.getElementById('table-{table['id']}')"
        assert browser.evaluate(f"{at}.querySelectorAll('tbody tr').length") == len(table["rows"]), table["id"]
        # Sorting by the last column, both ways.
        key = len(table["columns"]) - 1
        assert browser.evaluate(f"[...{at}.querySelectorAll('th[scope=col]')].map(e => e.textContent).join()") == \
            ",".join(c["title"] for c in table["columns"]), table["id"]
        groups = browser.evaluate(f"[...{at}.querySelectorAll('th[scope=colgroup]')].flatMap(e => Array(e.colSpan).fill(e.textContent))")
        assert groups == ([c.get("group", "") for c in table["columns"]] if any("group" in c for c in table["columns"]) else [])
        values = [r[key] for r in table["rows"] if r[key] is not None]
        for _ in range(2):
            browser.evaluate(f"{at}.querySelectorAll('th [role=button]')[{key}].click()")
            rising = browser.evaluate(f"{at}.querySelectorAll('th[scope=col]')[{key}].getAttribute('aria-sort')") == "ascending"
            expected = sorted(values, reverse=not rising)
            first = browser.evaluate(f"{at}.querySelector('tbody tr').children[{key}].textContent")
            assert first == browser.evaluate(f"shown({json.dumps(expected[0])}, {table['columns'][key]['digits']})")
        browser.evaluate(f"""(() => {{ const i = {at}.querySelector('input'); i.value = '{word}';
            i.dispatchEvent(new Event('input')); }})()""")
        wanted = sum(any(isinstance(v, str) and word in v for v in r) for r in table["rows"])
        assert browser.evaluate(f"{at}.querySelectorAll('tbody tr').length") == wanted, table["id"]
        browser.evaluate(f"(() => {{ const i = {at}.querySelector('input'); i.value = ''; i.dispatchEvent(new Event('input')); }})()")
    assert browser.evaluate("document.getElementById('command').textContent") == document["command"]
    assert document["machine"]["processor"] in browser.evaluate("document.getElementById('machine').textContent")
    # Failures come before everything else that was measured.
    assert browser.evaluate("""document.getElementById('failures').compareDocumentPosition(document.querySelector('figure, table')) ==
        Node.DOCUMENT_POSITION_FOLLOWING""")
    assert browser.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "the page is wider than the window"


def appearance(browser, folder, name):
    """Light, dark and paper: text stands out from what is behind it."""
    def luminance(colour):
        part = [int(v) / 255 for v in colour[colour.index("(") + 1:-1].split(",")[:3]]
        return sum(w * (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4) for w, c in zip((0.2126, 0.7152, 0.0722), part))
    backs = []
    for media, scheme in (("screen", "light"), ("screen", "dark"), ("print", "light")):
        browser.call("Emulation.setEmulatedMedia", media=media, features=[{"name": "prefers-color-scheme", "value": scheme}])
        ink, back = (luminance(browser.evaluate(f"getComputedStyle(document.body).{p}")) for p in ("color", "backgroundColor"))
        contrast = (max(ink, back) + 0.05) / (min(ink, back) + 0.05)
        assert contrast > 7, (media, scheme, contrast)  # WCAG 2.1, enhanced
        backs.append(back)
        if folder:
            size = browser.call("Page.getLayoutMetrics")["cssContentSize"]
            picture = browser.call("Page.captureScreenshot", captureBeyondViewport=True,
                                   clip={"x": 0, "y": 0, "width": size["width"], "height": min(size["height"], 3200), "scale": 1})
            with open(os.path.join(folder, f"{name}_{media}_{scheme}.png"), "wb") as file:
                file.write(base64.b64decode(picture["data"]))
    assert backs[0] > 0.9 and backs[1] < 0.1 and backs[2] > 0.9, backs
    browser.call("Emulation.setEmulatedMedia", media="", features=[])
    paper = base64.b64decode(browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
    assert paper.startswith(b"%PDF") and len(paper) > 20000
    if folder:
        with open(os.path.join(folder, name + ".pdf"), "wb") as file:
            file.write(paper)


def write_torus(path):
    """A closed mesh of a torus."""
    n, m = 48, 24
    with open(path, "w", encoding="utf-8") as file:
        for i in range(n):
            for j in range(m):
                u, v = 2 * math.pi * i / n, 2 * math.pi * j / m
                r = 1 + 0.35 * math.cos(v)
                file.write(f"v {r * math.cos(u):.9f} {r * math.sin(u):.9f} {0.35 * math.sin(v):.9f}\n")
        for i in range(n):
            for j in range(m):
                a, b = i * m + j + 1, i * m + (j + 1) % m + 1
                c, d = (i + 1) % n * m + j + 1, (i + 1) % n * m + (j + 1) % m + 1
                file.write(f"f {a} {c} {d}\nf {a} {d} {b}\n")


def main(program, pictures=None):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        write_torus(os.path.join(folder, "torus.obj"))
        browser = Browser(os.path.join(folder, "profile"))
        try:
            browser.attach()
            # A word that is in some rows, and what to measure.
            os.mkdir(os.path.join(folder, "models"))
            write_torus(os.path.join(folder, "models", "bunny.obj"))
            for name, word, arguments in (("suite", "sphere", ["--suite", "analytic", "--resolution", "16,24,40"]),
                                          ("paper", "bunny", ["--suite", "paper", "--models", "models", "--resolution", "128,24"]),
                                          ("mesh", "exact", ["torus.obj", "--resolution", "16,32"]),
                                          ("extremes", "refused", ["--suite", "extremes"])):
                page, data = (os.path.join(folder, name + end) for end in (".html", ".json"))
                subprocess.run([program, "measure", *arguments, "-q", "--rays", "256", "--repeat", "1", "--report", page,
                                "--json", data], check=True, cwd=folder)
                with open(data, encoding="utf-8") as file:
                    document = json.load(file)
                if name == "extremes":
                    verdicts = [r[0] for r in document["sections"][0]["tables"][0]["rows"]]
                    assert verdicts.count("green") == document["verdicts"]["green"] > 50, document["verdicts"]
                    assert verdicts.count("refused") == document["verdicts"]["refused"] > 10, document["verdicts"]
                check(browser, page, document, word)
                appearance(browser, pictures, name)
                print(f"{name}: {sum(len(s['plots']) for s in document['sections'])} plots, "
                      f"{sum(len(s['tables']) for s in document['sections'])} tables")
        finally:
            browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
