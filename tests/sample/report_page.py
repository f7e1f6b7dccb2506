#!/usr/bin/env python3
"""Opens the page of `alcove report` in headless Chromium and uses it as a reader does.

    report_page.py PAGE.html CHART.js CHROMIUM FOLDER

PAGE.html is the page's template. The script fills it with made-up figures, appends a script that
moves the slider, hovers and clicks on a point, sorts a table and copies a command, and reads the
results back. It fails on errors of the console and on requests. FOLDER receives screenshots: of a
wide window, of a phone and of the printed page.
"""

import base64
import fcntl
import itertools
import json
import os
import pathlib
import select
import struct
import subprocess
import sys
import time
import zlib


def png(grey):
    """A picture of 64x36 pixels of one grey."""
    def chunk(kind, body):
        return (struct.pack(">I", len(body)) + kind + body +
                struct.pack(">I", zlib.crc32(kind + body)))
    rows = b"".join(b"\0" + bytes([grey]) * 64 for _ in range(36))
    return ("data:image/png;base64," + base64.b64encode(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 64, 36, 8, 0, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")).decode())


def point(name, ms, rmse, preset=False, recommended=False):
    return {"name": name, "ms": ms, "rmse": rmse, "rmse_each": [rmse, .9 * rmse, 1.2 * rmse],
            "ms_each": [ms, .9 * ms], "preset": preset, "recommended": recommended,
            "command": f"alcove render --set steps={len(name)} # </script> & <b>"}


DATA = {
    "clock": "time of a GPU", "size": "64x36", "device": "a device",
    "peers": [{"name": "peer", "ms": .2}],
    "scenes": [{
        "name": "scene </script><script>throw 1</script>",
        "points": [point("low", .1, .06, True), point("medium", .2, .05, True),
                   point("recommended", .19, .045, False, True), point("other", .4, .044)],
        "pictures": [{"name": "truth", "image": png(200)}, {"name": "medium", "image": png(90)}],
        "errors": [{"name": "medium", "image": png(120)}],
        "causes": [{"name": "noise: 10.0 %", "image": png(150)}],
        "summary": "A sentence.", "requirements": ["a second depth layer: 20 % less error"],
        "plan": "pass gtao\n  reads depth",
    }],
}

PROBE = """
<script>
window.addEventListener("load", () => setTimeout(() => {
  const found = {};
  const fire = (element, kind, x, y) => element.dispatchEvent(
    new MouseEvent(kind, { clientX: x, clientY: y, bubbles: true, view: window }));
  const range = document.querySelector("input[type=range]");
  range.value = 20;
  range.dispatchEvent(new Event("input"));
  found.slider = document.querySelector(".slider .over").style.clipPath;
  const canvas = document.querySelector("canvas");
  const at = canvas.chart.getDatasetMeta(0).data[1];
  canvas.scrollIntoView();
  const box = canvas.getBoundingClientRect();
  fire(canvas, "mousemove", box.left + at.x, box.top + at.y);
  fire(canvas, "click", box.left + at.x, box.top + at.y);
  found.errors = window.failures;
  found.ticks = canvas.chart.scales.x.ticks.length;
  found.texts = window.texts;
  found.width = document.documentElement.scrollWidth;
  setTimeout(() => {
    found.hover = canvas.chart.tooltip.body.map((part) => part.lines.join()).join();
    found.command = document.querySelector("p code").textContent;
    document.execCommand = (what) => { found.copied = what + getSelection().toString(); return true; };
    Object.defineProperty(navigator, "clipboard", { value: {
      writeText: async (text) => { found.copied = text; } } });
    document.querySelector(".copy").click();
    const head = document.querySelectorAll("th button")[1];
    head.click();
    found.ascending = document.querySelector("td").textContent;
    head.click();
    found.descending = document.querySelector("td").textContent;
    found.requests = performance.getEntriesByType("resource")
      .map((entry) => entry.name).filter((name) => !name.startsWith("data:"));
    setTimeout(() => {
      document.documentElement.dataset.found = JSON.stringify(found);
    }, 50);
  }, 300);
}, 300));
</script>
"""
CATCH = """<script>
window.failures = [];
window.texts = [];
const draw = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (text, ...at) {
  window.texts.push(text);
  return draw.call(this, text, ...at);
};
window.addEventListener("error", (event) => window.failures.push(String(event.message)));
console.error = (...what) => window.failures.push(what.join(" "));
console.warn = console.error;
</script>"""


class Browser:
    """A headless browser that shows a page, and its protocol over two pipes (its descriptors 3 and 4)."""

    def __init__(self, chromium, profile, size, address):
        there_reads, self.writes = os.pipe()
        self.reads, there_writes = os.pipe()
        inner = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (there_reads, there_writes)]
        self.process = subprocess.Popen(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
             f"--user-data-dir={profile}", f"--window-size={size}", address],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False,
            preexec_fn=lambda: [os.dup2(end, number) for number, end in enumerate(inner, 3)])
        for end in (there_reads, there_writes, *inner):
            os.close(end)
        self.count = 0
        self.pending = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def call(self, method, session=None, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.writes, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.pending:
                if not select.select([self.reads], [], [], 60)[0]:
                    sys.exit(f"the browser does not answer {method}")
                self.pending += os.read(self.reads, 1 << 16)
            first, self.pending = self.pending.split(b"\0", 1)
            reply = json.loads(first)
            if reply.get("id") == self.count:
                return reply["result"]

    def wait_for(self, expression):
        """Returns the JSON that an expression is on the page, as soon as it is not empty."""
        for _ in range(600):
            targets = self.call("Target.getTargets")["targetInfos"]
            page = next((t for t in targets if t["type"] == "page" and "probed" in t["url"]), None)
            if page:
                session = self.call("Target.attachToTarget", targetId=page["targetId"],
                                    flatten=True)["sessionId"]
                found = self.call("Runtime.evaluate", session, expression=expression)
                if found["result"].get("value"):
                    return json.loads(found["result"]["value"])
            time.sleep(0.1)
        sys.exit("the page did not answer within a minute")


def main():
    template, chart, chromium, folder = sys.argv[1:]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    page = pathlib.Path(template).read_text()
    page = page.replace("/*CHART*/", pathlib.Path(chart).read_text().replace("</", "<\\/"), 1)
    page = page.replace("/*DATA*/", json.dumps(DATA).replace("</", "<\\/"), 1)
    plain = folder / "plain.html"
    plain.write_text(page)
    probed = folder / "probed.html"
    probed.write_text(page.replace("<head>", "<head>" + CATCH, 1)
                      .replace("</body>\n</html>", PROBE + "</body>\n</html>"))

    runs = itertools.count()

    def run(*arguments):  # with a profile of its own: another run may still hold the last one
        return subprocess.run(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
             f"--user-data-dir={folder}/profile{next(runs)}", "--virtual-time-budget=60000", *arguments],
            capture_output=True, text=True, timeout=240, check=False)

    def answer(size):
        with Browser(chromium, f"{folder}/profile{next(runs)}", size, probed.as_uri()) as browser:
            return browser.wait_for("document.documentElement.dataset.found || ''")

    found = answer("1100,900")
    assert found["errors"] == [], found["errors"]
    assert found["requests"] == [], found["requests"]
    assert "80%" in found["slider"], found["slider"]
    assert "medium" in found["hover"] and "0.0500" in found["hover"], found["hover"]
    assert found["command"] == DATA["scenes"][0]["points"][1]["command"], found["command"]
    assert found["copied"] == found["command"], found["copied"]
    assert (found["ascending"], found["descending"]) == ("other", "low"), found
    narrow = answer("500,844")
    assert narrow["width"] <= 500, f"the page is {narrow['width']} pixels wide on a phone"
    assert found["ticks"] >= 3 and narrow["ticks"] >= 3, "an axis without numbers"
    assert "medium" in found["texts"], "a preset without its name"
    run("--window-size=1100,1800", f"--screenshot={folder}/wide.png", plain.as_uri())
    run("--window-size=500,1400", f"--screenshot={folder}/phone.png", plain.as_uri())
    run(f"--print-to-pdf={folder}/print.pdf", plain.as_uri())
    for name in ("wide.png", "phone.png", "print.pdf"):
        assert (folder / name).stat().st_size > 5000, name


if __name__ == "__main__":
    main()
