"""The page in a real browser: what a person does with it, end to end, in one browser for all tests.

Screenshots are left in ``build/screenshots``, for the documentation.
"""

import asyncio
import os
import re
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from wifs import WIF

from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_family
from fabric_cad.model.identification import identify

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
ROOT = Path(__file__).parents[2]
SHOTS = ROOT / "build" / "screenshots"
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")

# a software renderer where there is no graphics processor, as on a machine that only tests
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """The folder the page is started in, and its address."""
    folder = tmp_path_factory.mktemp("design")
    shutil.copytree(shipped_families(), folder / "families")
    command = [sys.executable, "-m", "fabric_cad", "design", "plain", "--no-browser"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(
        command,
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    yield folder, process.stdout.readline().strip()
    process.send_signal(signal.SIGINT)
    assert process.wait(20) in (0, 1, 130)


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as running:
        chromium = running.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield chromium
        chromium.close()


@pytest.fixture
def tab(served, browser):
    """A page that is ready, at the smallest screen that shows all of it."""
    yield from opened(browser, served[1])


def opened(browser, address):
    context = browser.new_context(viewport={"width": 1366, "height": 768}, accept_downloads=True)
    page = context.new_page()
    page.set_default_timeout(60_000)
    faults, requests = [], []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: requests.append(request.url))
    page.goto(address)
    ready(page)
    yield page
    assert faults == []
    assert {re.match(r"\w+:(//[^/]*)?", url)[0] for url in requests} <= {
        address[: address.index("/index")],
        "data:",
        "blob:",
    }
    context.close()


def ready(page):
    page.wait_for_function(
        "() => window.fabric && window.fabric.draws > 0 && window.fabric_design.cut.svg"
    )


def settled(page):
    """Wait until every question is answered and drawn."""
    page.wait_for_function("() => !window.fabric_design.busy && !window.fabric_design.waiting")
    page.wait_for_timeout(400)
    page.wait_for_function("() => !window.fabric_design.busy && !window.fabric_design.waiting")


def shot(page, name):
    SHOTS.mkdir(parents=True, exist_ok=True)
    page.screenshot(path=SHOTS / f"{name}.png")


def test_a_crossing_is_flipped_by_pointer_and_by_key_and_what_is_no_weave_is_told(tab):
    tab.fill("#wefts", "4")
    tab.press("#wefts", "Enter")
    settled(tab)
    assert tab.locator(".grid button").count() == 8
    tab.fill("#warps", "4")
    tab.press("#warps", "Enter")
    settled(tab)
    crossing = tab.locator("#x-1-2")
    before, draws = crossing.get_attribute("aria-label"), tab.evaluate("() => fabric.draws")
    crossing.click()
    settled(tab)
    after = crossing.get_attribute("aria-label")
    assert {before, after} == {"weft 2 over warp 3", "weft 2 under warp 3"}
    assert tab.evaluate("() => fabric.draws") > draws

    crossing.focus()
    tab.keyboard.press("Space")
    settled(tab)
    assert crossing.get_attribute("aria-label") == before
    tab.keyboard.press("ArrowRight")
    assert tab.evaluate("() => document.activeElement.id") == "x-1-3"

    for warp in (1, 3):  # weft 1 over all
        name = tab.locator(f"#x-0-{warp}")
        if "under" in name.get_attribute("aria-label"):
            name.click()
            settled(tab)
    for warp in (0, 2):
        name = tab.locator(f"#x-0-{warp}")
        if "under" in name.get_attribute("aria-label"):
            name.click()
            settled(tab)
    assert "never interlaces" in tab.locator(".weave .refusal").first.inner_text()
    tab.click("#undo")
    settled(tab)
    assert tab.locator(".weave .refusal").count() == 0


def test_a_drag_over_crossings_is_one_step(tab):
    tab.fill("#wefts", "4")
    tab.press("#wefts", "Enter")
    settled(tab)
    boxes = [tab.locator(f"#x-{weft}-0").bounding_box() for weft in (0, 1)]
    centres = [(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2) for box in boxes]
    before = tab.evaluate("() => fabric_design.row.grid.join()")
    tab.mouse.move(*centres[0])
    tab.mouse.down()
    tab.mouse.move(*centres[1], steps=6)
    tab.mouse.up()
    settled(tab)
    assert tab.evaluate("() => fabric_design.row.grid.join()") == "00,11,10,01" != before
    tab.click("#undo")
    settled(tab)
    assert tab.evaluate("() => fabric_design.row.grid.join()") == before


def test_a_slider_goes_into_a_refusal_and_back(tab):
    tab.fill("#s-weft_width_mm", "5.4")
    settled(tab)
    refusal = tab.locator("#r-weft_width_mm")
    assert "not below the weft spacing 4.545 mm" in refusal.inner_text()
    assert tab.locator(".drawing.refused").count() == 1
    assert tab.locator("#f-weft_width_mm").get_attribute("aria-invalid") == "true"
    shot(tab, "refused")

    draws = tab.evaluate("() => fabric.draws")
    tab.fill("#s-weft_width_mm", "2.4")
    settled(tab)
    assert refusal.count() == 0 and tab.locator(".drawing.refused").count() == 0
    assert tab.evaluate("() => fabric.draws") > draws


def test_crimp_and_thickness_change_roles(tab):
    tab.fill("#f-weft_thickness_mm", "0.35")
    tab.press("#f-weft_thickness_mm", "Enter")
    tab.fill("#f-weft_crimp", "")
    tab.press("#f-weft_crimp", "Enter")
    settled(tab)
    roles = tab.evaluate(
        "() => Object.fromEntries(fabric_design.row.quantities.map(q => [q.column, q.role]))"
    )
    assert roles["weft_thickness_mm"] == "identifies" and roles["weft_crimp"] == "follows"
    assert tab.locator("#f-weft_crimp").get_attribute("placeholder").startswith("0.00")


def test_the_section_plane_is_moved_and_cuts_both_drawings(tab):
    first = tab.locator(".drawing .caption").inner_text()
    assert tab.locator("#cut svg path").count() >= 3
    tab.fill("#share", "0.7")
    settled(tab)
    second = tab.locator(".drawing .caption").inner_text()
    assert first.startswith("y = 2.273 mm") and second.startswith("y = 6.364 mm")

    whole = pixels(tab)
    tab.check("#cutting")
    settled(tab)
    assert pixels(tab) < 0.9 * whole  # what lies beyond the plane is gone
    tab.uncheck("#cutting")
    tab.locator("details summary").click()
    tab.locator("details input").first.uncheck()
    settled(tab)
    assert pixels(tab) < 0.9 * whole
    shot(tab, "cut")


def pixels(page):
    """How many pixels of the view the yarns take."""
    return page.evaluate(
        """async () => {
            const image = new Image();
            image.src = fabric.picture();
            await image.decode();
            const canvas = Object.assign(document.createElement('canvas'), {width: image.width, height: image.height});
            const context = canvas.getContext('2d');
            context.drawImage(image, 0, 0);
            const data = context.getImageData(0, 0, image.width, image.height).data;
            let count = 0;
            for (let k = 0; k < data.length; k += 4) count += data[k] + data[k + 1] + data[k + 2] < 720;
            return count;
        }"""
    )


def test_a_draft_is_dropped(tab):
    tab.set_input_files(
        "#wif", {"name": "mine.wif", "mimeType": "text/plain", "buffer": WIF.encode()}
    )
    settled(tab)
    assert tab.evaluate("() => fabric_design.row.family") == "pattern"
    tab.set_input_files(
        "#wif", {"name": "bad.wif", "mimeType": "text/plain", "buffer": b"nonsense"}
    )
    settled(tab)
    assert tab.locator("#problem").inner_text().startswith("bad.wif")


def test_a_row_is_saved_and_the_table_is_otherwise_as_it_was(served, tab):
    path = served[0] / "families" / "plain.csv"
    before = path.read_bytes()
    tab.fill("#f-weft_width_mm", "3.05")
    tab.press("#f-weft_width_mm", "Enter")
    settled(tab)
    tab.click("#save")
    settled(tab)
    assert "there already" in tab.locator("#problem").inner_text() and path.read_bytes() == before

    tab.fill("#name", "mine")
    tab.click("#save")
    settled(tab)
    assert "mine added to" in tab.locator("#notice").inner_text()
    after = path.read_bytes()
    assert after.startswith(before) and after[len(before) :].decode().startswith(
        "mine,0.22,,3.05,,0.004"
    )
    assert identify(read_family(path))["mine"].weft.width == 3.05


def test_the_link_holds_the_row_and_two_pages_do_not_mix(served, browser, tab):
    tab.fill("#f-weft_width_mm", "2.9")
    tab.press("#f-weft_width_mm", "Enter")
    settled(tab)
    link = tab.url
    assert "weft_width_mm=2.9" in link.split("#")[1]

    for other in opened(browser, link):
        assert other.input_value("#f-weft_width_mm") == "2.9"
        other.fill("#f-weft_width_mm", "2.5")
        other.press("#f-weft_width_mm", "Enter")
        settled(other)
        assert tab.evaluate("() => fabric_design.quantity.weft_width_mm.text") == "2.9"
        tab.click("#undo")
        settled(tab)
        assert (
            other.input_value("#f-weft_width_mm") == "2.5"
            and tab.input_value("#f-weft_width_mm") == "3.2"
        )

    tab.goto(link)
    tab.reload()
    ready(tab)
    assert tab.input_value("#f-weft_width_mm") == "2.9"


def test_a_file_that_leads_to_the_page_opens_it(served, browser, tmp_path):
    leading = tmp_path / "lead.html"
    leading.write_text(f'<!DOCTYPE html><meta http-equiv="refresh" content="0;url={served[1]}">')
    page = browser.new_page()
    page.goto(leading.as_uri())
    page.wait_for_url("http://127.0.0.1:*/**")
    ready(page)
    page.close()


def test_the_cell_is_made_and_its_step_downloaded_and_read_back(served, tab, tmp_path):
    from fabric_cad.cad import read_step

    shot(tab, "design")
    tab.click("#make")
    tab.wait_for_selector("#get-step", timeout=150_000)
    assert "write STEP" in tab.locator("#job").inner_text()
    with tab.expect_download() as waiting:
        tab.click("#get-step")
    assert waiting.value.suggested_filename == "plain.step"
    waiting.value.save_as(tmp_path / "plain.step")
    assert set(read_step(tmp_path / "plain.step")) == {"weft_1", "weft_2", "warp_1", "warp_2"}
    with tab.expect_download() as waiting:
        tab.click("#get-datasheet")
    assert Path(waiting.value.path()).read_bytes().startswith(b"%PDF")
    with tab.expect_download() as waiting:
        tab.click("#page")
    assert waiting.value.suggested_filename == "plain.html"
    assert sorted(path.name for path in served[0].iterdir()) == ["build", "families"]


def test_every_control_has_a_name_and_a_small_screen_shows_all_of_it(tab):
    unnamed = tab.evaluate(
        """() => [...document.querySelectorAll('button, input, select, canvas, a')].filter(element =>
            !(element.getAttribute('aria-label') || element.innerText || '').trim() && !element.labels?.length
        ).map(element => element.outerHTML)"""
    )
    assert unnamed == []
    size = tab.evaluate(
        "() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
    )
    assert size[0] <= 1366 and size[1] <= 768
    assert tab.locator(".grid [tabindex='0']").count() == 1  # one stop of the tab key

    before = tab.evaluate("() => fabric.camera.turn")
    tab.focus("#view")
    tab.keyboard.press("ArrowLeft")
    assert tab.evaluate("() => fabric.camera.turn") != before


# ---- who is refused ------------------------------------------------------------------------------


def test_other_hosts_origins_and_tokens_are_refused(served):
    address = served[1]
    base, token = re.fullmatch(r"(http://[^/]+)/index\.html\?secret=(.+)", address).groups()
    assert len(token) >= 43 and base.startswith("http://127.0.0.1:")
    with ThreadPoolExecutor(1) as thread:  # playwright's own loop runs in this one
        found = thread.submit(asyncio.run, _refusals(base, token)).result()
    assert found == {
        "page": 200,
        "rebound host": 403,
        "localhost": 403,
        "foreign origin": 403,
        "socket of a foreign origin": 403,
        "socket without an origin": 403,
        "cross-site script": 403,
        "post elsewhere": 403,
        "right token": True,
        "wrong token": False,
        "no token": False,
        "default token": False,
    }


async def _refusals(base, token):
    import aiohttp

    port = base.rsplit(":", 1)[1]
    found = {}
    async with aiohttp.ClientSession() as session:

        async def status(name, path="/index.html", method="get", **headers):
            async with session.request(method, base + path, headers=headers) as response:
                found[name] = response.status
                if response.status == 200:
                    assert "frame-ancestors 'none'" in response.headers["Content-Security-Policy"]

        await status("page")
        await status("rebound host", Host=f"attacker.example:{port}")
        await status("localhost", Host=f"localhost:{port}")
        await status("foreign origin", Origin="http://127.0.0.1:1")
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade"}
        await status("socket of a foreign origin", "/ws", Origin="http://127.0.0.1:1", **upgrade)
        await status("socket without an origin", "/ws", **upgrade)
        await status(
            "cross-site script", "/__fabric_cad/design.js", **{"Sec-Fetch-Site": "cross-site"}
        )
        await status("post elsewhere", method="post")
        for name, secret in (
            ("right", token),
            ("wrong", "x" * 43),
            ("no", None),
            ("default", "wslink-secret"),
        ):
            found[f"{name} token"] = await _is_answered(session, base, secret)
    return found


async def _is_answered(session, base, secret):
    """Whether a socket gets an answer to a question of the page."""
    import msgpack
    from wslink.chunking import UnChunker, generate_chunks

    async def ask(socket, number, method, *arguments):
        message = {
            "wslink": "1.0",
            "id": number,
            "method": method,
            "args": list(arguments),
            "kwargs": {},
        }
        for chunk in generate_chunks(msgpack.packb(message), 4_000_000):
            await socket.send_bytes(chunk)

    answers, unchunker = {}, UnChunker()
    unchunker.set_max_message_size(10**9)
    async with session.ws_connect(
        f"{base.replace('http', 'ws')}/ws", headers={"Origin": base}
    ) as socket:
        if secret is not None:
            await ask(socket, "system:c0:1", "wslink.hello", {"secret": secret})
        await ask(socket, "rpc:c0:2", "trame.trigger", "ask", ["tab", "open", ""], {})
        try:
            while "rpc:c0:2" not in answers:
                message = await asyncio.wait_for(socket.receive(), 4)
                if message.type.name != "BINARY":
                    break
                whole = unchunker.process_chunk(message.data)
                if whole is not None and isinstance(whole, dict) and "id" in whole:
                    answers[whole["id"]] = whole
        except TimeoutError:
            pass
    return "row" in (answers.get("rpc:c0:2", {}).get("result") or {})
