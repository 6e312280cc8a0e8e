"""The stub has the names of the compiled core; run as a program, this writes them."""

import pathlib
import re

from asperity import _asperity

STUB = pathlib.Path(__file__).resolve().parents[1] / "asperity" / "_asperity.pyi"


def stub():
    """The stub with all names of the core."""
    exported = "".join(f'    "{name}",\n' for name in sorted(_asperity.__all__))
    return re.sub(r"(?s)(?<=__all__ = \[\n).*?(?=\]\n)", exported, STUB.read_text(encoding="utf-8"))


def test_the_stub_has_all_names():
    assert STUB.read_text(encoding="utf-8") == stub(), f"run python {__file__}"


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
