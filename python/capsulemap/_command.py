"""The command line, as the entry point ``capsulemap``."""

from __future__ import annotations

import os
import signal
import sys

from . import _capsulemap


def main() -> None:
    """Runs the command line on the arguments of this process, and ends with its exit code."""
    # Ctrl-C is for the program: the interpreter would only note it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    code = _capsulemap.command_line(["capsulemap", *sys.argv[1:]])
    sys.stdout.flush()
    # Nothing of the interpreter is left to do.
    os._exit(code)


if __name__ == "__main__":
    main()
