"""Checks the links within a built site: every local address exists, every fragment is an id of its page.

``python tests/links.py FOLDER`` prints what is broken; status 1 where something is.
"""

from __future__ import annotations

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The ids and the addresses of a page of HTML."""

    def __init__(self, path: Path):
        super().__init__()
        self.ids: set[str] = set()
        self.addresses: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id" or (name == "name" and tag == "a"):
                self.ids.add(value)
            elif name in ("href", "src") and value is not None:
                self.addresses.append(value)


def broken_links(site: Path) -> list[str]:
    """What does not exist of all that pages of a folder point to within it."""
    pages = {path.resolve(): Page(path) for path in sorted(site.rglob("*.html"))}
    broken = []
    for path, page in pages.items():
        for address in page.addresses:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                continue

            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                broken.append(f"{path.name}: {address}: no such file")
            elif (
                parts.fragment
                and target in pages
                and unquote(parts.fragment) not in pages[target].ids
            ):
                broken.append(f"{path.name}: {address}: no such place")
    return broken


if __name__ == "__main__":
    found = broken_links(Path(sys.argv[1]))
    for line in found:
        print(line)
    sys.exit(bool(found))
