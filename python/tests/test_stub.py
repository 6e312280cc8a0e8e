"""The laws that are formulas are those of the compiled core in its stub and in `_laws.py`; run as a program, it writes them."""

import inspect
import pathlib
import re

import asperity
from asperity import _asperity

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "asperity"
OTHERS = (asperity.CutOff, asperity.Tabulated, asperity.Varying)
LAWS = [law for law in asperity.Law.__subclasses__() if law not in OTHERS]


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
    names = sorted(law.__name__ for law in LAWS)
    module = (
        '"""The laws that are formulas, as `tests/test_stub.py` writes them."""\n\n'
        f"from ._asperity import {', '.join(names)}\n\n__all__ = [{', '.join(map(repr, names))}]\n"
    )
    stub = (FOLDER / "_asperity.pyi").read_text(encoding="utf-8")
    exported = "".join(f'    "{name}",\n' for name in sorted(_asperity.__all__))
    stub = re.sub(r"(?s)(?<=__all__ = \[\n).*?(?=\]\n)", exported, stub)
    classes = "\n".join(line for law in LAWS for line in class_of(law))
    stub = re.sub(r"(?s)(?<=# laws that are formulas\n).*?(?=# other laws\n)", classes + "\n", stub)
    return {FOLDER / "_laws.py": module.replace("'", '"'), FOLDER / "_asperity.pyi": stub}


def test_laws_are_those_of_the_core():
    for path, text in files().items():
        assert path.read_text(encoding="utf-8") == text, f"run python {__file__}"
    assert {law.__name__ for law in (*LAWS, *OTHERS)} <= set(asperity.__all__)


if __name__ == "__main__":
    for path, text in files().items():
        path.write_text(text, encoding="utf-8")
