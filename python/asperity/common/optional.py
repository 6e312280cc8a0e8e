"""Packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any


def package(name: str, needed: str) -> Any:
    """A module of a package that may not be there, asked for when it is needed."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(needed) from error


def reason(raised: Exception) -> str:
    """The reason of an exception on one line."""
    return next(iter(str(raised).splitlines()), "") or type(raised).__name__
