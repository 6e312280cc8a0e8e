"""The command `asperity convert`: a map of any file that `asperity.read` takes, in a format of the program."""

from __future__ import annotations

import argparse
import sys
from typing import NoReturn

from .. import _asperity
from ..maps.files import read

#: The line of the help of the program.
HELP = """
Command of the Python package:
  convert      Write a map of the file of an instrument as .npz, .npy or .gsf
"""


class _Parser(argparse.ArgumentParser):
    """A parser with errors of one line."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{message}: see {self.prog} --help")


def run(arguments: list[str]) -> int:
    """Converts a file; the exit code."""
    parser = _Parser(
        prog="asperity convert",
        description="Reads a map as asperity.read does, from the file of an instrument too, which pip install "
        "'asperity[instruments]' is for, and writes it for the other commands.",
    )
    parser.add_argument("input", metavar="FILE", help="the map")
    parser.add_argument("out", metavar="OUT", help=".npz, .gsf (for Gwyddion, in f32) or .npy (the heights alone)")
    parser.add_argument("--channel", metavar="NAME", help="channel, by number or title, if several have heights")
    parser.add_argument("--force", action="store_true", help="replace a file that is there")
    try:
        given = parser.parse_args(arguments)
        found = read(given.input, given.channel)
        _asperity.write(found, given.out, given.force)
    except (ValueError, OSError, MemoryError) as error:
        told = str(error).replace("asperity.read(path, channel=NUMBER)", "--channel NUMBER")
        print(f"error: {told}", file=sys.stderr)
        return 1
    print(f"written  {found!r}")
    return 0
