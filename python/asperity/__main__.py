"""The program `asperity`: a command that comes with the package, and `python -m asperity`."""

import signal
import sys

from ._asperity import command
from .api import convert as _convert


def main() -> int:
    """Runs the program, or the command of the package; the exit code."""
    arguments = sys.argv[1:]
    if arguments[:1] == ["convert"]:
        return _convert.run(arguments[1:])
    # an interruption is for the program, which says what stands
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    code = command(["asperity", *arguments])
    if arguments in (["--help"], ["-h"], ["help"]):
        print(_convert.HELP, end="")
    return code


if __name__ == "__main__":
    sys.exit(main())
