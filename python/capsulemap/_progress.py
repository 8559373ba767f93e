"""Shows how far a computation is, in a terminal or a notebook."""

from __future__ import annotations

import sys
import time
from typing import Any

from . import _text

FIRST_SHOWN = 1.0
"""Time before anything is shown [s]."""
INTERVAL = 0.5
"""Time between two looks [s]."""

_is_shown: bool | None = None


def set_progress(shown: bool | None) -> None:
    """Sets whether long computations show their progress: by default (None) in notebooks, and where standard error is a terminal."""
    if shown is not None:
        _text.truth("shown", shown)
    global _is_shown
    _is_shown = shown


class Progress:
    """The progress of one computation."""

    def __init__(self) -> None:
        self._begun = time.monotonic()
        self._handle: Any = None
        self._told = 0.0
        self._width = 0
        self._in_notebook = in_notebook()
        by_itself = self._in_notebook or sys.stderr is not None and sys.stderr.isatty()
        self.is_shown = by_itself if _is_shown is None else _is_shown
        """Whether it is shown."""
        self.interval = INTERVAL if self.is_shown else None
        """Time between two looks [s]; None where nothing is shown."""

    def show(self, done: int, cases: int) -> None:
        """Shows how many cases are done."""
        taken = time.monotonic() - self._begun
        if not self.is_shown or taken < FIRST_SHOWN:
            return
        told = f"{done} of {cases} cases, {_time(taken)}"
        if 0 < done < cases:
            told += f", about {_time(taken * (cases - done) / done)} left"
        self._put(told)

    def tell(self, line: str) -> None:
        """Shows what a command says of itself."""
        now = time.monotonic()
        if self.is_shown and line and now - max(self._told, self._begun + FIRST_SHOWN) >= INTERVAL:
            self._told = now
            self._put(line)

    def end(self) -> None:
        """Takes away what was shown."""
        if self._handle is not None:
            self._handle.update({"text/plain": ""}, raw=True)
        elif self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()

    def _put(self, told: str) -> None:
        if not self._in_notebook:
            sys.stderr.write("\r" + told.ljust(self._width))
            sys.stderr.flush()
            self._width = len(told)
        elif self._handle is None:
            from IPython.display import display  # type: ignore[import-not-found, unused-ignore]

            shown: Any = display
            self._handle = shown({"text/plain": told}, raw=True, display_id=True)
        else:
            self._handle.update({"text/plain": told}, raw=True)


def in_notebook() -> bool:
    """Whether a notebook shows what a cell returns."""
    try:
        from IPython.core.getipython import get_ipython  # type: ignore[import-not-found, unused-ignore]
    except ImportError:
        return False
    return type(get_ipython()).__name__ == "ZMQInteractiveShell"


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"
