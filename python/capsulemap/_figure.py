"""Figures of results, as the command line draws them."""

from __future__ import annotations

import base64
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import _capsulemap, _process, _text
from ._errors import StudyError
from ._recordings import Recording, file_of
from ._saved import Folder, Place, Results, check_free
from ._text import Quantity
from ._tradeoff import TradeOff

SAVED_DPI = 600
"""Dots per inch of what is saved."""
SHOWN_DPI = 300
"""Dots per inch of what a notebook shows."""
SHOWN_WIDTH = 150
"""Of which it shows so many as an inch, larger than in print."""
NAME = "figure"
"""What the files are called until they are saved."""


class Figure:
    """A figure, which shows itself in a notebook and is saved as PNG, SVG or PDF, with its data as CSV."""

    def __init__(
        self,
        folder: Folder,
        name: str,
        draw: Callable[[str], list[str]] | None,
    ) -> None:
        self._folder = folder
        self._name = name
        self._draw = draw
        self.notes: list[str] = []
        """What the figure leaves out or stands for, in sentences."""

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Writes the figure in the format that the extension names: .png (600 dots per inch, or ``dpi``), .svg, .pdf, or .csv for its data.

        Raises StudyError where a file is there and not to be overwritten, or the figure has no such format.
        """
        check_free(path, overwrite)
        extension = os.path.splitext(os.fspath(path))[1].removeprefix(".").lower()
        if extension not in ("png", "svg", "pdf", "csv"):
            raise StudyError(f"{os.fspath(path)}: expected a name that ends in .png, .svg, .pdf or .csv")
        shutil.copyfile(self._file(extension), path)

    def _file(self, form: str) -> str:
        """The file in a format, which is drawn when it is first asked for."""
        stem = os.path.join(self._folder.name, self._name)
        path = f"{stem}.{form}"
        if not os.path.exists(path) and self._draw is not None:
            self.notes = self._draw(form)
        if not os.path.exists(path):
            raise StudyError(f"the figure is not drawn as {form.upper()}")
        return path

    def _repr_mimebundle_(self, **_: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        with open(self._file("png" if self._draw is None else "shown.png"), "rb") as file:
            image = file.read()
        # The width of a PNG file is in its first chunk.
        width = int.from_bytes(image[16:20], "big")
        shown = width * SHOWN_WIDTH // (SAVED_DPI if self._draw is None else SHOWN_DPI)
        picture = base64.b64encode(image).decode("ascii")
        return {"image/png": picture, "text/plain": repr(self)}, {"image/png": {"width": shown}}

    def __repr__(self) -> str:
        return f"<Figure {self._name!r}: in a notebook it shows itself; .save(\"{self._name}.pdf\")>"


def figure(
    results: Results,
    kind: str,
    *,
    of: str | Sequence[str] | None = None,
    x: str | None = None,
    y: str | None = None,
    at: Mapping[str, Any] | None = None,
    sweep: str | None = None,
    colour_by: str | None = None,
    title: str | None = None,
    cycles: tuple[float, float] | None = None,
    points: Recording | None = None,
    curves: bool = False,
    branches: bool = True,
    legend: bool = True,
    hide: str | Sequence[str] = (),
    text: str | Sequence[str] = (),
    width: str | float | None = None,
    height: str | float | None = None,
    marker_size: str | float | None = None,
    dpi: float | None = None,
    limits: Mapping[str, tuple[Quantity, Quantity]] | None = None,
    scale: Mapping[str, str] | None = None,
    unit: Mapping[str, str] | None = None,
    label: Mapping[str, str] | None = None,
    decimals: Mapping[str, int] | None = None,
    colour_map: Mapping[str, str] | None = None,
    centre: Mapping[str, Quantity] | None = None,
    contours: Mapping[str, Any] | None = None,
) -> Figure:
    """A figure of results: a dataset of this package, the path of a file of results, or a TradeOff.

    ``kind`` is "bifurcation", "map", "basin", "history", "phase-portrait", "spectrum", "section", "settling", "shares", "trade-off",
    "trade-off-maps" or "curves"; ``of`` names the outputs, ``x`` and ``y`` the axes, ``at`` the values at which others are held (several
    give panels), as ``{"delta": ["1 mm", "2 mm"]}``; ``cycles`` from and to bound a history. ``points`` are measured points over a
    bifurcation diagram: a CSV file or a table with columns in SI units. ``width``, ``height`` and ``marker_size`` are in mm or texts with units; ``limits``, ``scale``, ``unit``, ``label``, ``decimals``, ``colour_map``, ``centre`` and
    ``contours`` map quantities to how they are shown. Raises StudyError where the results do not have what is asked, and MachineError.
    """
    for name, each in (("at", at), ("unit", unit), ("label", label), ("limits", limits), ("scale", scale)):
        _text.mapping(name, each, '{"omega": ...}')
    if not isinstance(kind, str):
        raise TypeError(f"kind: expected a text, as \"map\", found {kind!r}")
    place = Place(results)
    if of is None and isinstance(results, TradeOff) and kind.startswith("trade-off"):
        own_gain = results.told.get("for")
        of = [results.told["of"]] if own_gain is None else [results.told["of"], own_gain]
    folder = Folder()
    given: dict[str, object] = {
        "kind": kind,
        "of": _joined(_text.listed(of)),
        "x": x,
        "y": y,
        "at": [f"{name}={_several(f'at.{name}', it)}" for name, it in (at or {}).items()],
        "sweep": sweep,
        "colour_by": colour_by,
        "title": title,
        "cycles": None if cycles is None else _joined(_text.pair("cycles", cycles, "from and to, in cycles")),
        "curves": curves,
        "no_branches": not branches,
        "no_legend": not legend,
        "hide": _joined(_text.listed(hide) or None),
        "text": _text.listed(text),
        "width": width,
        "height": height,
        "marker_size": marker_size,
    }
    quantities = {"limits": limits, "centre": centre, "contours": contours}
    for key, each in quantities.items():
        given[key] = [f"{name}={_several(f'{key}.{name}', it)}" for name, it in (each or {}).items()]
    names = {"scale": scale, "unit": unit, "label": label, "decimals": decimals, "colour_map": colour_map}
    for key, words in names.items():
        given[key] = [f"{name}={it}" for name, it in (words or {}).items()]
    if points is not None:
        given["points"] = file_of(points, _units(place.path), folder.name, "points")

    def draw(form: str) -> list[str]:
        name, form = (f"{NAME}.shown", "png") if form == "shown.png" else (NAME, form)
        own: dict[str, object] = {"name": name, "folder": folder.name, "formats": form, "dpi": dpi}
        if name != NAME and dpi is None:
            own["dpi"] = SHOWN_DPI
        if form == "csv":
            own |= {"formats": "svg", "data": True, "overwrite": True}
        words = ["figure", place.path, *_process.options({**given, **own})]
        _, said = _process.asked(words, folder.name)
        beginning = f"  figure `{name}`: "
        return [line.removeprefix(beginning) for line in said if line.startswith(beginning)]

    drawn = Figure(folder, NAME, draw)
    # Whatever is wrong is told now.
    drawn._file("svg")
    return drawn


def of_files(folder: Folder, name: str) -> Figure:
    """A figure whose files are in a folder."""
    return Figure(folder, name, None)


def _joined(each: Sequence[object] | None) -> str | None:
    return None if each is None else ",".join(str(it) for it in each)


def _several(key: str, values: Any) -> str:
    """A quantity, or several."""
    if isinstance(values, str) or hasattr(values, "magnitude") or not hasattr(values, "__iter__"):
        values = [values]
    return ",".join(_text.words(key, it) for it in values)


def _units(path: str) -> dict[str, str | None]:
    """The units of axes and outputs of the results in a file."""
    model = _capsulemap.describe(results=path)
    outputs = {name: None if unit == "1" else unit for name, (unit, _) in model["outputs"].items()}
    return {**outputs, **model["coordinates"], **model["parameters"]}
