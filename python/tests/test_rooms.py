"""The rooms of the package use what lies below them alone, as the picture of the architecture page has it."""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "asperity"
ROOM = PACKAGE / "curves"


def imported(path):
    """The modules of the package that a file imports."""
    text = path.read_text(encoding="utf-8")
    named = re.findall(r"^from (\.[.\w]*) import (.*?)(?:\n(?! )|\Z)", text, re.MULTILINE | re.DOTALL)
    for place, names in named:
        yield from [place] if place.strip(".") else [place + name for name in re.findall(r"\w+", names)]


def test_only_the_front_door_uses_the_room_of_force_curves():
    users = [path.name for path in PACKAGE.glob("*.py") if any(name.startswith(".curves") for name in imported(path))]
    assert users == ["__init__.py"]


def test_force_curves_have_the_floors_of_the_page():
    page = (ROOT / "src" / "guide" / "architecture.md").read_text(encoding="utf-8")
    picture = page.split("Those of `python/asperity/curves`, which a test of Python checks.\n\n```text\n")[1].split("```")[0]
    floors = {name: floor for floor, line in enumerate(picture.splitlines()) for name in line.split("  ")[0].split()}
    files = {path.stem: path for path in ROOM.glob("*.py") if path.stem != "__init__"}
    assert set(floors) == set(files)
    for name, path in files.items():
        used = [used[1:] for used in imported(path) if re.fullmatch(r"\.\w+", used)]
        assert all(floors[one] <= floors[name] for one in used if one != name), (name, used)
