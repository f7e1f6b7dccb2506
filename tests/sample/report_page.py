#!/usr/bin/env python3
"""Opens the page of `alcove report` in headless Chromium and uses it as a reader does.

    report_page.py PAGE.html CHART.js CHROMIUM FOLDER

PAGE.html is the page's template. The script fills it with made-up figures, appends a script that
moves the slider, hovers and clicks on a point, sorts a table and copies a command, and reads the
results back. It fails on errors of the console and on requests. FOLDER receives screenshots: of a
wide window, of a phone and of the printed page.
"""

import base64
import html
import itertools
import json
import pathlib
import re
import struct
import subprocess
import sys
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
    "gpu": "A GPU", "target": "1920x1080", "size": "64x36", "device": "a device",
    "peers": [{"name": "peer", "ms": .2}],
    "scenes": [{
        "name": "scene </script><script>throw 1</script>",
        "points": [point("low", .1, .06, True), point("medium", .2, .05, True),
                   point("recommended", .19, .045, False, True), point("other", .4, .044)],
        "pictures": [{"name": "truth", "image": png(200)}, {"name": "medium", "image": png(90)}],
        "errors": [{"name": "medium", "image": png(120)}],
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
window.addEventListener("error", (event) => window.failures.push(String(event.message)));
console.error = (...what) => window.failures.push(what.join(" "));
console.warn = console.error;
</script>"""


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
        dom = run(f"--window-size={size}", "--dump-dom", probed.as_uri())
        attribute = re.search(r'data-found="([^"]*)"', dom.stdout)
        assert attribute, f"the page did not answer: {dom.stdout[:300]} {dom.stderr[-600:]}"
        return json.loads(html.unescape(attribute.group(1)))

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
    run("--window-size=1100,1800", f"--screenshot={folder}/wide.png", plain.as_uri())
    run("--window-size=500,1400", f"--screenshot={folder}/phone.png", plain.as_uri())
    run(f"--print-to-pdf={folder}/print.pdf", plain.as_uri())
    for name in ("wide.png", "phone.png", "print.pdf"):
        assert (folder / name).stat().st_size > 5000, name


if __name__ == "__main__":
    main()
