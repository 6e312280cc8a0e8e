"""Checks a built site: what its pages link to is there, and nothing is loaded from elsewhere.

Pages under `rust/` come from rustdoc, which checks its links itself; links into them are checked here.
"""

import re
import sys
from functools import cache
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = re.compile(
    r"<(?:script|img|iframe|link)\b[^>]*?\b(?:src|href)=\"([^\"]*)\""
    r"|(?:url|@import)\(?\s*[\"']?(https?:[^\"')]*)"
)
LINK = re.compile(r"<a\b[^>]*?\bhref=\"([^\"]*)\"")


@cache
def anchors(page: Path) -> set[str]:
    """The names within a page to which a link may lead."""
    return set(re.findall(r"\b(?:id|name)=\"([^\"]*)\"", page.read_text()))


def faults(site: Path, page: Path) -> list[str]:
    """What is wrong with the links of a page."""
    text = page.read_text()
    loaded = [found for pair in LOADED.findall(text) for found in pair if found]
    wrong = [f"loads {address}" for address in loaded if re.match(r"(https?:)?//", address)]
    if page.suffix == ".html" and not {site / "rust", site / "_static"} & set(page.parents):
        for address in loaded + LINK.findall(text):
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                continue
            path, anchor = unquote(parts.path), unquote(parts.fragment)
            target = (page.parent / path).resolve() if path else page
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file() or anchor and target.suffix == ".html" and anchor not in anchors(target):
                wrong.append(f"leads to {address}, which is not there")
    return [f"{page.relative_to(site)} {what}" for what in wrong]


site = Path(sys.argv[1]).resolve()
pages = [page for kind in ("html", "css") for page in site.rglob(f"*.{kind}")]
found = sorted({fault for page in pages for fault in faults(site, page)})
print(f"{len(pages)} pages and styles", *found, sep="\n")
sys.exit(bool(found))
