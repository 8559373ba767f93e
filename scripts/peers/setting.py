"""Says where and when it was measured, and with which versions."""

import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path


def first_line(*command):
    """Return the first line that a command prints."""
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError:
        return "unknown"
    return done.stdout.partition("\n")[0] or "unknown"


def processor():
    """Return the processor's name and its number of cores in view."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        names = [
            line.partition(": ")[2] for line in lines if line.startswith("model name")
        ]
        return f"{names[0]}, one core of {len(names)}"
    except (OSError, IndexError):
        return platform.processor() or platform.machine()


def setting(*more):
    """Return the paragraph that heads the report; `more` are packages of its own."""
    names = ("heyoka", "numpy", "scipy", "numba", *more)
    packages = ", ".join(f"{name} {version(name)}" for name in names)
    commit = first_line("git", "describe", "--always", "--dirty")
    return (
        f"Measured on {datetime.now(UTC):%Y-%m-%d} on {processor()}, one thread each, "
        "by turns. The machine may be shared: compare "
        f"figures of one run only. capsulemap {commit}, "
        f"{first_line('rustc', '--version')}; {first_line('gcc', '--version')}; "
        f"Python {platform.python_version()}, {packages}."
    )
