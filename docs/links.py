"""Every link of the built site resolves, and no page asks for anything from elsewhere.

`python docs/links.py docs/_build/html` looks at local links with their fragments, at pictures, scripts and styles, and
at names that should have become links. Addresses elsewhere are counted, not asked for; `--external` lists them.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("img", "srcset"), ("source", "src"), ("iframe", "src")}
IMPORTED = re.compile(r"""url\(\s*["']?((?:https?:)?//[^)"']+)|@import\s+["']?((?:https?:)?//[^)"';]+)""")


@dataclass
class Page(HTMLParser):
    """Targets of a page, and what it links to and loads."""

    path: Path
    targets: set[str] = field(default_factory=set)
    links: list[tuple[str, bool]] = field(default_factory=list)     # address, and whether it is loaded with the page
    unresolved: list[str] = field(default_factory=list)
    anchors: int = 0

    def __post_init__(self) -> None:
        super().__init__()
        self.feed(self.path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attributes}
        self.anchors += tag == "a"
        self.targets |= {given[name] for name in ("id", "name") if name in given}
        if "xref" in given.get("class", "").split() and not self.anchors:
            self.unresolved.append(given["class"])
        for name in ("href", "src", "srcset"):
            for part in given.get(name, "").split(",") if name == "srcset" else [given.get(name, "")]:
                if part.strip() and given.get("rel") not in ("canonical", "search"):
                    self.links.append((part.split()[0], (tag, name) in LOADED))

    def handle_endtag(self, tag: str) -> None:
        self.anchors -= tag == "a"


@cache
def page(path: Path) -> Page:
    return Page(path)


def faults(path: Path, elsewhere: set[str]) -> list[str]:
    """What is wrong with a page; addresses elsewhere that it links to are collected."""
    found = [f"no target for a {kind} name" for kind in page(path).unresolved]
    for address, loaded in page(path).links:
        parts = urlsplit(address)
        if parts.scheme == "data":
            continue
        if parts.scheme or parts.netloc:
            elsewhere.add(address)
            found += [f"loads {address}"] * loaded
        elif wrong := missing(path, unquote(parts.path), unquote(parts.fragment)):
            found.append(f"{address}: {wrong}")
    return found


def missing(path: Path, name: str, fragment: str) -> str:
    target = (path.parent / name).resolve() if name else path
    if target.is_dir():
        target /= "index.html"
    if not target.exists():
        return "no such file"
    if fragment and target.suffix == ".html" and fragment not in page(target).targets:
        return "no such place on that page"
    return ""


def main(site: Path, *, list_external: bool) -> int:
    elsewhere: set[str] = set()
    pages = sorted(site.resolve().rglob("*.html"))
    wrong = [f"{path.relative_to(site.resolve())}: {fault}" for path in pages for fault in faults(path, elsewhere)]
    wrong += [f"{path.name}: loads {address}" for path in site.rglob("*.css")
              for address in IMPORTED.findall(path.read_text(encoding="utf-8"))]
    print(*wrong, *(sorted(elsewhere) if list_external else ()), sep="\n")
    links = sum(len(page(path).links) for path in pages)
    print(f"{len(pages)} pages, {links} links, {len(wrong)} wrong; {len(elsewhere)} addresses elsewhere, not asked for")
    return 1 if wrong or not links else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), list_external="--external" in sys.argv))
