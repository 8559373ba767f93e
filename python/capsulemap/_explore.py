"""The page to look at results in a browser."""

from __future__ import annotations

import threading
import time

from . import _process
from ._progress import in_notebook
from ._saved import Place, Results

PATIENCE = 60.0
"""How long the page may take to begin [s]."""


class Page:
    """A page that shows results in a browser, until it is closed or this process ends."""

    def __init__(self, place: Place, words: list[str]) -> None:
        self._place = place
        self._command = _process.Command(words)
        self.address = self._begun()
        """Where it is, for one browser on this machine."""
        _OPEN.add(self)

    def _begun(self) -> str:
        begun = time.monotonic()
        while not self._command.printed:
            if not self._command.is_running():
                code = self._command.wait()
                if not self._command.printed:
                    raise _process.error(code, self._command.said)
            if time.monotonic() - begun > PATIENCE:
                self._command.end()
                raise TimeoutError(f"the page has not begun within {PATIENCE} s")
            threading.Event().wait(_process.BETWEEN_SIGNALS)
        return self._command.printed[0]

    def close(self) -> None:
        """Ends the page."""
        _OPEN.discard(self)
        if self._command.is_running():
            self._command.end()

    def wait(self) -> None:
        """Waits until the page is closed, or Ctrl-C closes it."""
        try:
            self._command.wait()
        except KeyboardInterrupt:
            self.close()

    def __enter__(self) -> Page:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        if not self._command.is_running():
            return "The page is closed."
        link = f'<a href="{self.address}" target="_blank" rel="noopener">{self.address}</a>'
        return f"The results, in a page of their own: {link} (opens once, in one browser)"

    def __repr__(self) -> str:
        return f"<Page {self.address}>" if self._command.is_running() else "<Page, closed>"


_OPEN: set[Page] = set()
"""Pages that are open, whether anybody holds them or not."""


def explore(results: Results, *, port: int = 0, browser: bool | None = None) -> Page:
    """Opens a page on which a click on a map or a basin computes the motion there at once.

    ``results`` is a dataset of this package, or the path of a file of results. The browser of the desktop is opened, unless in a notebook,
    which shows the address as a link, or with ``browser=False``. Raises StudyError where there is nothing to show, and MachineError.
    """
    place = Place(results)
    opens = not in_notebook() if browser is None else browser
    words = ["explore", place.path, *_process.options({"port": port, "no_browser": not opens})]
    return Page(place, words)
