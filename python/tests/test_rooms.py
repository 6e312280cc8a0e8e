"""The rooms of the package use what stands above them in the picture of the architecture page, and no circle is in a room."""

import ast
import graphlib
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "asperity"
#: What users import, and the program: they are on no floor.
DOORS = ("__init__", "__main__")


def floors():
    """The floor of each room by its name, from the picture."""
    page = (ROOT / "src" / "guide" / "architecture.md").read_text(encoding="utf-8")
    picture = page.split("The folders of `python/asperity`,")[1].split("```text\n")[1].split("```")[0]
    return {name: floor for floor, line in enumerate(picture.splitlines()) for name in line.split("  ")[0].split()}


def name_of(path):
    """The name of a module below the package, a tuple of words."""
    return path.relative_to(PACKAGE).with_suffix("").parts


FILES = {name_of(path): path for path in PACKAGE.rglob("*.py")}


def imports(name, path):
    """The modules of the package that a file imports anywhere, for type checkers too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = (*name[: len(name) - node.level], *filter(None, (node.module or "").split(".")))
            for alias in node.names:
                module = (*base, alias.name)
                known = module in FILES or (*module, "__init__") in FILES or module == ("_asperity",)
                yield module if known else base


def test_rooms_use_the_floors_above_them_alone():
    floor, rooms = floors(), {name[0] for name in FILES} - set(DOORS)
    assert set(floor) == rooms | {"_asperity"}
    for name, path in FILES.items():
        if name[0] not in DOORS:
            for used in imports(name, path):
                assert used[0] == name[0] or floor[used[0]] < floor[name[0]], f"{'/'.join(name)} may not import {'.'.join(used)}"


def test_no_files_import_each_other_in_a_circle():
    uses = {name: set(imports(name, path)) & set(FILES) for name, path in FILES.items()}
    order = list(graphlib.TopologicalSorter(uses).static_order())
    assert len(order) == len(FILES) > 50


def test_rooms_are_small():
    for folder in {path.parent for path in FILES.values()}:
        files = [path.name for path in folder.glob("*.py") if path.stem != "__init__"]
        assert len(files) <= 12, folder
