"""From a number that changes in the browser to the draw call, and until it is painted: JSON for ``make bench``.

The event is an input event of a slider, the draw call the last one of the frame that shows the new fabric, both
by the browser's own clock: the socket, the identification and the tiles lie between. Painted is when the
renderer gives a pixel back, whose name stands beside it.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from fabric_cad.measured.shipped import shipped_families
from fabric_cad.weave.patterns import written
from fabric_cad.weave.weaves import pattern_faults

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
CHANGES = 25

_MEASURE = """async changes => {
  const slider = document.getElementById('s-weft_width_mm'), found = [];
  const waited = test => new Promise(done => { const look = () => test() ? done() : setTimeout(look, 1); look(); });
  for (let k = 0; k < changes; k++) {
    await new Promise(done => setTimeout(done, 250));
    await waited(() => !fabric_design.open);  // figures and cut of the one before
    let painted = 0;
    fabric.painted = at => { painted = at; };
    const draws = fabric.draws, start = performance.now();
    slider.value = 2.0 + 0.01 * k;
    slider.dispatchEvent(new Event('input'));
    await waited(() => fabric.draws > draws && painted);
    found.push([fabric.drawn - start, painted - start, fabric_design.answered - start]);
    fabric.painted = null;
  }
  return found;
}"""


def random_weave(size: int) -> str:
    """A weave of as many wefts as warps, as likely over as under: all tiles are in use."""
    rng = np.random.default_rng(size)
    while True:
        pattern = tuple("".join(row) for row in rng.choice(["0", "1"], size=(size, size)))
        if not pattern_faults(pattern):
            return written(pattern)


def measured(sizes: list[int]) -> dict:
    """Seconds from start to a usable page, the renderer, and medians (ms) by size."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as running:
        shutil.copytree(shipped_families(), Path(folder) / "families")
        browser = running.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1366, "height": 768})
        start = time.perf_counter()
        command = [sys.executable, "-m", "fabric_cad", "design", "--no-browser", "-q"]
        server = subprocess.Popen(
            command, cwd=folder, env=os.environ, stdout=subprocess.PIPE, text=True
        )
        try:
            address = server.stdout.readline().strip()
            page.goto(address)
            _ready(page)
            found: dict = {
                "usable": time.perf_counter() - start,
                "renderer": page.evaluate("() => fabric.renderer"),
            }
            for size in sizes:
                row = "name=a&weft_density_per_mm=0.35&weft_width_mm=2.4&weft_crimp=0.004"
                page.goto("about:blank")
                page.goto(f"{address}#pattern?{row}&pattern={random_weave(size)}")
                _ready(page)
                times = zip(
                    ("drawn", "painted", "answered"), zip(*page.evaluate(_MEASURE, CHANGES))
                )
                found[str(size)] = {name: statistics.median(values) for name, values in times}
        finally:
            server.send_signal(signal.SIGINT)
            server.wait(20)
            browser.close()
    return found


def _ready(page) -> None:
    page.wait_for_function(
        "() => window.fabric && fabric.draws > 0 && window.fabric_design.cut.svg", timeout=60_000
    )


if __name__ == "__main__":
    print(json.dumps(measured([int(size) for size in sys.argv[1:]] or [8, 16])))
