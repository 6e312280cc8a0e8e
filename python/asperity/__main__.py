"""The program `asperity`: a command that comes with the package, and `python -m asperity`."""

import signal
import sys

from ._asperity import command


def main() -> int:
    """Runs the program; its exit code."""
    # an interruption is for the program, which says what stands
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["asperity", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
