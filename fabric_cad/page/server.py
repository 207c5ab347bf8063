"""The page on the loopback: trame mounts it and carries its questions.

Only its own page and token are answered.
"""

from __future__ import annotations

import asyncio
import atexit
import base64
import logging
import os
import socket
import tempfile
import webbrowser
from collections.abc import Callable
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from ..support.errors import InputError, OutputError
from .desk import Answer, Desk, Places
from .edited import EditedRow
from .guard import LOOPBACK, guard, new_token
from .jobs import KINDS, Job

_CLIENT = Path(__file__).with_name("client")
_MODULE = {
    "serve": {"__fabric_cad": str(_CLIENT)},
    "scripts": ["__fabric_cad/viewer.js", "__fabric_cad/design.js"],
    "styles": ["__fabric_cad/design.css"],
    "vue_use": ["fabric_cad_design"],
}

_AT_ONCE = ("open", "change", "flip", "resize", "weave", "draft", "undo", "redo")
"""Questions that are answered before any other: those of a moving hand. Others may take their time beside."""


@dataclass(frozen=True)
class Address:
    """Where the page is, and with what token."""

    port: int
    token: str

    @property
    def url(self) -> str:
        """What a browser opens."""
        return f"http://{LOOPBACK}:{self.port}/index.html?secret={self.token}"


def inside_here(folder: str | Path) -> Path:
    """A folder below the current one, as an absolute path. Raises :class:`OutputError` for any other."""
    place, here = Path(folder).resolve(), Path.cwd().resolve()
    if not place.is_relative_to(here):
        raise OutputError(
            f"{folder}: is not in the folder that the page is started in, {here}, and it writes no other"
        )
    return place


def serve(
    row: EditedRow,
    places: Places,
    port: int = 0,
    told: Callable[[Address], None] = lambda _: None,
) -> None:
    """Serve the page of a row until it is stopped; ``told`` is called with its address once it answers.

    Raises :class:`InputError` where the row is no fabric, :class:`OutputError` where the port is
    taken.
    """
    desk = Desk(row, places)
    address = Address(_free_port(port), new_token())
    os.environ["WSLINK_READY_MSG"] = ""  # which would be printed among what the command prints
    os.environ["WSLINK_WS_COMPRESS"] = "0"  # on the loopback, packing takes longer than sending
    # a tab that is closed while it is answered is no error
    logging.getLogger("wslink").setLevel(logging.CRITICAL)

    from trame.app import get_server
    from trame.ui.html import DivLayout

    server = get_server(f"fabric-cad {address.port}", client_type="vue3")
    server.cli.set_defaults(authKey=address.token)
    server.enable_module(_MODULE)
    server.state.trame__title = "fabric-cad design"
    with DivLayout(server) as layout:
        layout.root.add_child("<fabric-design></fabric-design>")

    jobs = _answer(server, desk)
    server.controller.on_server_bind.add(
        lambda bound: bound.app.middlewares.append(guard(address.port))
    )
    server.controller.on_server_ready.add(lambda **_: told(address))
    try:
        server.start(
            port=address.port,
            host=LOOPBACK,
            timeout=0,
            open_browser=False,
            show_connection_info=False,
            disable_logging=True,
            exec_mode="main",
        )
    finally:
        for job in jobs.values():
            job.cancel()


def _free_port(port: int) -> int:
    """The port, or with 0 one that is free. Raises :class:`OutputError` where it is taken."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port))
        except OSError as error:
            raise OutputError(
                f"port {port} of {LOOPBACK} cannot be used: {error.strerror}"
            ) from error
        return probe.getsockname()[1]


def _answer(server: Any, desk: Desk) -> dict[str, Job]:
    """Register what the page may trigger; the jobs by tab."""
    jobs: dict[str, Job] = {}

    @server.trigger("ask")
    async def ask(tab: str, question: str, *arguments: Any) -> Answer:
        if question in _AT_ONCE:
            return desk.ask(tab, question, *arguments)
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(None, desk.ask, tab, question, *arguments)

    @server.trigger("run")
    def run(tab: str) -> Answer:
        if any(job.state == "running" for job in jobs.values()):
            return {"problem": "another cell is being made; wait for it, or cancel it"}
        try:
            row = desk.row(tab)
        except (KeyError, InputError) as error:
            return {"problem": f"what stands is no fabric: {error}"}
        if not row.name:
            row = row.changed(name="fabric")
        jobs[tab] = Job(row, desk.places.out)
        jobs[tab].start()
        return jobs[tab].told()

    @server.trigger("job")
    def job(tab: str) -> Answer:
        return jobs[tab].told() if tab in jobs else {"problem": "nothing was made"}

    @server.trigger("cancel")
    async def cancel(tab: str) -> Answer:
        if tab in jobs:
            await asyncio.get_running_loop().run_in_executor(None, jobs[tab].cancel)
        return job(tab)

    @server.trigger("file")
    def file(tab: str, kind: str) -> Answer:
        if tab not in jobs or jobs[tab].state != "done" or kind not in KINDS:
            return {"problem": "this file was not made"}
        path = jobs[tab].file(kind)
        try:
            text = base64.b64encode(path.read_bytes()).decode("ascii")
        except OSError as error:
            return {"problem": f"{path.name}: {error.strerror}"}
        return {"name": path.name, "type": KINDS[kind][1], "text": text}

    return jobs


def open_browser(address: Address) -> None:
    """Open the page in a browser, its token by a file that only the user reads, not by arguments."""
    text = f'<!DOCTYPE html><meta http-equiv="refresh" content="0;url={escape(address.url)}"><title>fabric-cad</title>'
    with tempfile.NamedTemporaryFile(
        "w", suffix=".html", prefix="fabric-cad-", delete=False
    ) as file:
        file.write(text)
    atexit.register(Path(file.name).unlink, missing_ok=True)
    webbrowser.open(Path(file.name).as_uri())
