"""The commands of the programs that are compared."""

import sys
from pathlib import Path

HERE = Path(__file__).parent


def python(file, *arguments):
    """Return the command that runs a peer in Python."""
    return [sys.executable, str(HERE / file), *arguments]


def bench(name, *arguments):
    """Return the command that runs a bench of capsulemap."""
    return ["cargo", "bench", "--quiet", "--bench", name, "--", *arguments]
