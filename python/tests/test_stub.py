"""The stubs have the laws that are formulas, and the names of the compiled core; run as a program, it writes them."""

import inspect
import pathlib
import re

import asperity
from asperity import _asperity
from asperity.laws import laws as _laws

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "asperity"
LAWS = _laws._Formula.__subclasses__()


def class_of(law):
    kinds, typed, given = {}, {}, []
    for name, parameter in inspect.signature(law).parameters.items():
        kinds[name] = "bool" if parameter.default is False else "float"
        given.append(kinds[name] + " | str" * _asperity.has_dimension(name))
        typed[name] = f"{name}: {given[-1]}" + " = False" * (kinds[name] == "bool")
    yield from ("@final", f"class {law.__name__}(Law):")
    yield f"    __match_args__: ClassVar[tuple[{', '.join(['str'] * len(kinds))}]]"
    yield f"    def __new__(cls, {', '.join(typed.values())}) -> {law.__name__}: ..."
    for name, kind in kinds.items():
        yield from ("    @property", f"    def {name}(self) -> {kind}: ...")
    yield from (f"    def __getnewargs__(self) -> tuple[{', '.join(given)}]: ...", "")


def files():
    """What the stub and the module have to be, by their paths."""
    core, laws = FOLDER / "_asperity.pyi", FOLDER / "laws" / "laws.pyi"
    exported = "".join(f'    "{name}",\n' for name in sorted(_asperity.__all__))
    stub = re.sub(r"(?s)(?<=__all__ = \[\n).*?(?=\]\n)", exported, core.read_text(encoding="utf-8"))
    classes = "\n".join(line for law in LAWS for line in class_of(law)) + "\n"
    formulas = r"(?s)(?<=# laws that are formulas\n).*?(?=# other laws\n)"
    return {core: stub, laws: re.sub(formulas, classes, laws.read_text(encoding="utf-8"))}


def test_the_stubs_have_all_laws_and_names():
    for path, text in files().items():
        assert path.read_text(encoding="utf-8") == text, f"run python {__file__}"
    assert {law.__name__ for law in LAWS} <= set(asperity.__all__)


if __name__ == "__main__":
    for path, text in files().items():
        path.write_text(text, encoding="utf-8")
