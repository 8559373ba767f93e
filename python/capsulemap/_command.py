"""The command line, as the entry point ``capsulemap``."""

from __future__ import annotations

import os
import signal
import sys
import threading

from . import _capsulemap
from ._process import HELD


def main() -> None:
    """Runs the command line on the arguments of this process, and ends with its exit code."""
    # Ctrl-C is for the program: the interpreter would only note it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if HELD in os.environ:
        threading.Thread(target=_end_with_input, daemon=True).start()
    code = _capsulemap.command_line(["capsulemap", *sys.argv[1:]])
    sys.stdout.flush()
    # Nothing of the interpreter is left to do.
    os._exit(code)


def _end_with_input() -> None:
    """Ends this process once its standard input is closed, as where the one that asked is gone."""
    sys.stdin.buffer.read()
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    main()
