"""Pages of the site that are kept elsewhere in the repository, and links to the documentation of the Rust crates.

A page has the links that are right in the repository; here they become links of the site. Pages of `src/guide` are
written for rustdoc: their links name items of Rust, and their code has hidden lines.
"""

import posixpath
import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util import logging

# folders and pages of the repository, and where they are on the site, the most particular first
PLACES = {
    "src/guide/": "guide/",
    "python/examples/": "notebooks/",
    "examples/pictures/": "pictures/",
    "benches/peers/README.md": "more/peers.md",
    "CHANGELOG.md": "more/changelog.md",
    "docs/": "",
}
TITLES = {
    "architecture": "Architecture",
    "boundary": "Boundaries and loads",
    "branches": "Branches and jumps",
    "choosing": "Accuracy",
    "cluster": "Clusters",
    "comparison": "Projection, penalty, Uzawa",
    "constants": "Constants",
    "driver": "The solver",
    "laws": "Adhesion laws",
    "own_constraint": "A constraint of your own",
    "own_law": "A law of your own",
    "own_operator": "An operator of your own",
    "paper_checked": "The paper, checked",
    "performance": "Cost",
    "tour": "Tour",
}
logger = logging.getLogger(__name__)


def in_repository(page: str) -> str:
    """The place in the repository of a page of the site."""
    for place, shown in PLACES.items():
        if shown and page.startswith(shown) and page != "guide/index.md":
            return place + page.removeprefix(shown)
    return "docs/" + page


def on_site(origin: str, target: str) -> str:
    """A link from a page of the repository, as one from the root of the site."""
    path, anchor, heading = target.partition("#")
    if not path or re.match(r"[a-z]+:", path):
        return target
    path = posixpath.normpath(posixpath.join(posixpath.dirname(origin), path))
    for place, shown in PLACES.items():
        if path.startswith(place):
            return "/" + shown + path.removeprefix(place) + anchor + heading
    return target


class Items:
    """The pages of rustdoc by the paths of their items, as rustdoc itself has linked them on the pages of the guide."""

    def __init__(self, rust: Path):
        link = re.compile(r'<a href="((?:\.\./)*)([^":]*)" title="[a-z ]+ (asperity::[\w:]+)"')
        self.pages = {}
        for page in [rust / "asperity/index.html", *rust.glob("asperity/guide/*/index.html")]:
            for up, path, item in link.findall(page.read_text()):
                self.pages[item] = posixpath.normpath(posixpath.join(str(page.parent.relative_to(rust)), up, path))

    def link(self, page: str, text: str, item: str) -> str:
        """A link from a page to an item, or to a page of the guide."""
        item, anchor, heading = item.partition("#")
        if item.startswith("crate::guide::"):
            return f"[{text}](/guide/{item.removeprefix('crate::guide::')}.md{anchor}{heading})"
        name = item.replace("crate", "asperity", 1)
        if name not in self.pages:
            logger.warning("rustdoc has no link to %s", item, location=page)
        up = "../" * page.count("/")
        return f'<a class="reference internal" href="{up}rust/{self.pages.get(name)}">{text}</a>'


def from_rustdoc(name: str, text: str) -> str:
    """A page of rustdoc in Markdown: with a title, headings below it, and code as readers see it."""
    blocks = text.split("```")
    for i, block in enumerate(blocks):
        if i % 2 == 0:
            blocks[i] = re.sub(r"^#", "##", block, flags=re.MULTILINE)
            continue
        language, code = block.split("\n", 1)
        if language in ("", "no_run"):
            language = "rust"
            code = re.sub(r"^#( .*)?\n", "", code, flags=re.MULTILINE)
        elif language == "math":
            language = "{code-block} text\n:class: equation"
        blocks[i] = f"{language}\n{code}"
    return f"# {TITLES[name]}\n\n" + "```".join(blocks)


def read(app: Sphinx, page: str, source: list[str]) -> None:
    """Makes a page of the site of one of the repository."""
    path = app.env.doc2path(page, base=False)
    origin, text = in_repository(str(path)), source[0]
    if origin.startswith("src/guide/"):
        text = from_rustdoc(page.removeprefix("guide/"), text)
        references = dict(re.findall(r"^(\[[^\]]+\]): (crate\S+)\n", text, re.MULTILINE))
        text = re.sub(r"^\[[^\]]+\]: crate\S+\n", "", text, flags=re.MULTILINE)
        for name, item in references.items():
            text = re.sub(re.escape(name) + r"(?!\()", f"{name}({item})", text)
    text = re.sub(r"\[([^\]]+)\]\((crate[^)]*)\)", lambda found: app.items.link(page, *found.groups()), text)
    up = "../" * page.count("/")
    text = re.sub(r"\[([^\]]+)\]\(rustdoc:(\w+)\)", rf'<a href="{up}rust/\2/index.html">\1</a>', text)
    text = re.sub(r"\]\(([^)\s]+)\)", lambda found: f"]({on_site(origin, found[1])})", text)
    source[0] = re.sub(r'<img src="([^"]+)"', lambda found: f'<img src="{on_site(origin, found[1])}"', text)


def docstring(app: Sphinx, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Keeps absolute values, as |q|, from being substitutions."""
    lines[:] = [re.sub(r"\|([^|\s]+)\|", r"\\|\1\\|", line) for line in lines]


def setup(app: Sphinx) -> dict[str, bool]:
    """Registers the extension."""
    app.add_config_value("rust", "", "env")
    app.connect("config-inited", lambda app, config: setattr(app, "items", Items(Path(config.rust))))
    app.connect("source-read", read)
    app.connect("autodoc-process-docstring", docstring)
    return {"parallel_read_safe": True}
