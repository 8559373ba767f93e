"""What is raised and warned of."""

from __future__ import annotations

import os
import sys
import warnings
from typing import NamedTuple


class Fault(NamedTuple):
    """One thing wrong in what was asked."""

    line: int | None
    """Line of the text, counted from 1; none where something is missing or there is no text of one's own."""
    key: str
    """The key, as a path ("axes[2].from"); empty where it is of none."""
    message: str
    """What is wrong and what is allowed."""

    def __str__(self) -> str:
        """The fault as the command line prints it."""
        line = "" if self.line is None else f"line {self.line}: "
        key = f"{self.key}: " if self.key else ""
        return f"{line}{key}{self.message}"


class StudyError(ValueError):
    """A mistake in what was asked, with all of its faults at once; nothing was computed."""

    faults: list[Fault]

    def __init__(self, message: str, faults: list[Fault] | None = None) -> None:
        super().__init__(message)
        self.faults = [Fault(None, "", message)] if faults is None else faults

    def __reduce__(self) -> tuple[type[StudyError], tuple[str, list[Fault]]]:
        return (type(self), (str(self), self.faults))


class MachineError(RuntimeError):
    """A fault of the machine: its disk, its memory, its threads."""


class StudyWarning(UserWarning):
    """A default that was assumed, a setting without effect, or what may be wrong with a recording."""


class PartialResultWarning(UserWarning):
    """A computation was interrupted, and what it had done by then is returned."""


def _study_error(message: str, faults: list[tuple[int | None, str, str]]) -> StudyError:
    return StudyError(message, [Fault(*fault) for fault in faults])


def warn(told: str, category: type[Warning]) -> None:
    """Warns where the package was called."""
    here = os.path.dirname(os.path.abspath(__file__)) + os.sep
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.abspath(frame.f_code.co_filename).startswith(here):
        level, frame = level + 1, frame.f_back
    warnings.warn(told, category, stacklevel=level)
