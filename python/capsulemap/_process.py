"""Asks commands of the command line, each in a process of its own, which ends with this one."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import threading
from collections.abc import Iterable, Mapping, Sequence
from typing import IO, Any

from ._errors import Fault, MachineError, StudyError
from ._progress import Progress

HELD = "CAPSULEMAP_HELD"
"""Set in the environment of a command that ends once its standard input is closed."""
BETWEEN_SIGNALS = 0.02
"""Time between two looks for signals [s]."""
PATIENCE = 0.05
"""How long a command that is told to end is waited for [s]."""
REQUEST = 2
"""The exit code for a mistake in what was asked."""


PROGRESS = re.compile(r"\d[\d ]*/\d[\d ]* ")
"""How lines begin that tell how far a command is."""


class Command:
    """A command that runs in a process of its own, in a folder, with what it prints line by line."""

    def __init__(self, words: Sequence[str], folder: str | os.PathLike[str] | None = None) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "capsulemap", *words],
            env=_environment(),
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            # Ctrl-C is for this process, which then ends the command.
            start_new_session=True,
        )
        self.printed: list[str] = []
        """Lines of standard output."""
        self.said: list[str] = []
        """Lines of standard error."""
        both = [(self._process.stdout, self.printed), (self._process.stderr, self.said)]
        self._readers = [threading.Thread(target=_read, args=it, daemon=True) for it in both]
        for reader in self._readers:
            reader.start()

    def wait(self) -> int:
        """Its exit code, once it has ended; how far it is is shown meanwhile, and an exception, as that of Ctrl-C, ends it."""
        progress = Progress()
        try:
            for reader in self._readers:
                while reader.is_alive():
                    reader.join(BETWEEN_SIGNALS)
                    progress.tell(self.said[-1] if self.said else "")
            progress.end()
            while self._process.poll() is None:
                threading.Event().wait(BETWEEN_SIGNALS)
        except BaseException:
            self.end()
            progress.end()
            raise
        self._close()
        return self._process.returncode

    def is_running(self) -> bool:
        """Whether it has not ended."""
        return self._process.poll() is None

    def end(self) -> None:
        """Ends it."""
        self._process.terminate()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._close()

    def _close(self) -> None:
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            if pipe is not None and not pipe.closed:
                pipe.close()


def asked(
    words: Sequence[str], folder: str | os.PathLike[str] | None = None
) -> tuple[str, list[str]]:
    """What a command prints, and what it says beside.

    Raises StudyError for a mistake in what was asked, with all faults, and MachineError for a fault of the machine.
    """
    command = Command(words, folder)
    code = command.wait()
    if code != 0:
        raise error(code, command.said)
    notes = [line.removeprefix("note: ") for line in command.said if not PROGRESS.match(line)]
    return "\n".join(command.printed), notes


def asked_for_json(
    words: Sequence[str], folder: str | os.PathLike[str] | None = None
) -> tuple[dict[str, Any], list[str]]:
    """The JSON object that a command prints, and what it says beside. Raises as ``asked`` does."""
    printed, said = asked([*words, "--json"], folder)
    return json.loads(printed), said


def options(given: Mapping[str, object]) -> list[str]:
    """Words for options by their names: nothing for None and False, the name alone for True, one word for each of a list."""
    words: list[str] = []
    for name, value in given.items():
        option = f"--{name.replace('_', '-')}"
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
            continue
        each: Iterable[object] = [value] if isinstance(value, str) or not isinstance(value, Iterable) else value
        words.extend(f"{option}={it}" for it in each)
    return words


def error(code: int, said: Sequence[str]) -> Exception:
    """What a command that failed has said, as an exception."""
    if usage := _of_usage(said):
        return StudyError(str(usage), [usage])
    told = [line.removeprefix("capsulemap: ") for line in said[_beginning(said) :]]
    if code != REQUEST:
        return MachineError("\n".join(told) or f"the command ended with {code}")
    faults: list[Fault] = []
    for line in told:
        found = re.match(r"  (?:line (\d+): )?(?:([\w.\[\]-]+): )?(.*)", line)
        if found and faults and faults[-1].message.endswith(("fault", "faults")):
            # The heading of a list.
            faults.pop()
        if found:
            number, key, message = found.groups()
            faults.append(Fault(int(number) if number else None, key or "", message))
        elif option := re.match(r"--([\w-]+)(?:: | )(.*)", line):
            faults.append(Fault(None, _argument(option[1]), option[2]))
        elif line:
            faults.append(Fault(None, "", line))
    return StudyError("\n".join(told), faults)


def _argument(option: str) -> str:
    """What an option is called in Python, of which `for` is a word of its own."""
    return "gain" if option == "for" else option.replace("-", "_")


def _of_usage(said: Sequence[str]) -> Fault | None:
    """What is wrong with the form of an option, in words for an argument of Python."""
    lines = [line.strip() for line in said]
    begins = next((place for place, line in enumerate(lines) if line.startswith("error: ")), None)
    if begins is None:
        return None
    message = lines[begins].removeprefix("error: ")
    more = [line.strip("[]") for line in lines[begins + 1 :] if line.startswith(("[possible", "tip:"))]
    key = ""
    if found := re.match(r"invalid value '(.*)' for '--([\w-]+)[^']*'(?:: )?(.*)", message):
        key, message = _argument(found[2]), f"{found[1]!r} is not allowed" + (f": {found[3]}" if found[3] else "")
    return Fault(None, key, "; ".join([message, *more]))


def _beginning(said: Sequence[str]) -> int:
    """Where the words on the failure begin, behind notes."""
    begins = (place for place, line in enumerate(said) if line.startswith("capsulemap: "))
    return next(begins, 0)


def _environment() -> dict[str, str]:
    """An environment in which this package is found, wherever it was imported from."""
    here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    path = os.pathsep.join(it for it in (here, os.environ.get("PYTHONPATH")) if it)
    # A notebook asks for colours, which would stand in messages.
    plain = {"NO_COLOR": "1", "CLICOLOR_FORCE": "0", "FORCE_COLOR": "0"}
    return {**os.environ, **plain, "PYTHONPATH": path, HELD: "1"}


def _read(pipe: IO[bytes], lines: list[str]) -> None:
    # What is closed while it is read has no more lines.
    try:
        for line in pipe:
            lines.append(line.decode("utf-8", "replace").rstrip("\r\n"))
    except ValueError:
        pass
