"""The program `asperity`: a command that comes with the package, and `python -m asperity`."""

import signal
import sys

if __package__:
    from ._asperity import command
else:  # by its path, as a study starts its cases: neither the package nor numpy is imported
    from _asperity import command  # type: ignore[import-not-found, no-redef, unused-ignore]


def main() -> int:
    """Runs the program; its exit code."""
    # an interruption is for the program, which says what stands
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command([sys.executable, __file__], ["asperity", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
