"""Who may speak to the page: this machine's browser, from the page itself.

The socket's first message must hold the token that is in the page's address (wslink's own rule).
What a browser adds is checked here: a page of another origin, or of a name that was made to point
at the loopback (DNS rebinding), is refused before anything is read.
"""

from __future__ import annotations

import secrets
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from aiohttp.web import Request, StreamResponse

LOOPBACK = "127.0.0.1"

_HEADERS = {
    # Vue compiles the page's templates in the browser, which is what unsafe-eval is for
    "Content-Security-Policy": "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; frame-ancestors 'none'; "
    "base-uri 'self'; form-action 'none'; object-src 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}


def new_token() -> str:
    """A token nobody guesses: 256 bits."""
    return secrets.token_urlsafe(32)


def guard(port: int) -> Callable:
    """An aiohttp middleware that answers 403 to every other host, origin and kind of request."""
    from aiohttp import web

    host = f"{LOOPBACK}:{port}"

    @web.middleware
    async def guarded(
        request: Request, handler: Callable[[Request], Awaitable[StreamResponse]]
    ) -> StreamResponse:
        if fault := _fault(request.headers, request.method, request.path, host):
            return web.Response(status=403, text=fault, headers=_HEADERS)
        try:
            response = await handler(request)
        except ConnectionError:  # a tab that was closed while it was answered
            return web.Response(status=400)

        if not response.prepared:
            response.headers.update(_HEADERS)
        return response

    return guarded


def _fault(headers, method: str, path: str, host: str) -> str | None:
    """Why a request is refused."""
    if headers.get("Host") != host:
        return "another host"
    origin = headers.get("Origin")
    is_socket = headers.get("Upgrade", "").lower() == "websocket"
    if origin not in (None, f"http://{host}") or (is_socket and origin is None):
        return "another origin"
    is_visit = (
        headers.get("Sec-Fetch-Mode") == "navigate" and headers.get("Sec-Fetch-Dest") == "document"
    )
    if headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin") and not is_visit:
        return "another site"  # a visit from elsewhere shows the page, which is nothing without the token
    if method not in ("GET", "HEAD", "POST") or (method == "POST" and path != "/paraview/"):
        return "not asked for here"

    return None
