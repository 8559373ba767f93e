"""Axes of studies, and draws in their place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from . import _text
from ._text import Quantity


@dataclass(frozen=True)
class Axis:
    """Values of a parameter or of a coordinate of the start, from one end to the other, both included.

    ``start`` and ``stop`` are numbers in SI units or texts with units; ``spacing`` is "linear" or "logarithmic". Without
    ``points`` it is the range of a draw.
    """

    start: Quantity
    stop: Quantity
    points: int | None = None
    spacing: str = "linear"

    def _pairs(self, key: str, unit: str | None) -> dict[str, str]:
        pairs = {
            "from": _text.quantity(key, self.start, unit),
            "to": _text.quantity(key, self.stop, unit),
        }
        if self.points is not None:
            pairs["points"] = _text.plain(key, self.points)
        return {**pairs, "spacing": _text.quoted(self.spacing)}


class Path:
    """Several quantities that vary together along one dimension, which has the name that the mapping of axes gives it.

    ``Path(omega=[60, 70, 80], p_d=["2 N", "2.5 N", "4 N"])`` lists their values, as many of each. With ``points`` each quantity is
    a pair, its first and its last value: ``Path(points=101, omega=(60, 80), p_d=(2, 4))``; ``spacing`` is "linear" or "logarithmic".
    """

    __slots__ = ("points", "quantities", "spacing")

    def __init__(self, *, points: int | None = None, spacing: str = "linear", **quantities: object) -> None:
        self.points = points
        self.spacing = spacing
        self.quantities = quantities

    def __repr__(self) -> str:
        given = {"points": self.points, "spacing": self.spacing} if self.points is not None else {}
        return f"Path({', '.join(f'{key}={it!r}' for key, it in {**given, **self.quantities}.items())})"

    def _pairs(self, key: str, units: Mapping[str, str | None]) -> dict[str, str]:
        written = {name: self._written(key, name, of, units.get(name)) for name, of in self.quantities.items()}
        lengths = {name: len(values) for name, values in written.items()}
        if len(set(lengths.values())) > 1:
            told = ", ".join(f"{name} has {length}" for name, length in lengths.items())
            raise _text.unfit(key, f"a path has as many values of each quantity; {told}")
        places = [_text.inline(dict(zip(written, place, strict=True))) for place in zip(*written.values(), strict=True)]
        if self.points is None:
            return {"values": "[" + ", ".join(places) + "]"}
        if len(places) != 2:
            raise _text.unfit(key, "a path with points has a pair of each quantity, its first and its last value")
        ends = {"from": places[0], "to": places[1], "points": _text.plain(key, self.points)}
        return {**ends, "spacing": _text.quoted(self.spacing)}

    def _written(self, key: str, name: str, values: object, unit: str | None) -> list[str]:
        return [_text.quantity(f"{key}.{name}", it, unit) for it in _values(values)]


def varied(axes: Mapping[str, object]) -> tuple[str, ...]:
    """The names of what the axes of a study vary."""
    names: list[str] = []
    for name, axis in axes.items():
        names.extend(axis.quantities if isinstance(axis, Path) else [name])
    return tuple(names)


@dataclass(frozen=True)
class Normal:
    """The range of a draw that has a normal distribution, cut at ``start`` and ``stop``.

    Without them it is cut six deviations from the mean, or where the quantity has its bounds. Quantities are numbers in SI units or texts
    with units.
    """

    mean: Quantity
    deviation: Quantity
    start: Quantity | None = None
    stop: Quantity | None = None

    def _pairs(self, key: str, unit: str | None) -> dict[str, str]:
        pairs = {"mean": self.mean, "deviation": self.deviation, "from": self.start, "to": self.stop}
        return {name: _text.quantity(key, it, unit) for name, it in pairs.items() if it is not None}


@dataclass(frozen=True)
class Draws:
    """Cases that are drawn from the ranges of the axes, in place of a grid.

    ``kind`` is "uniform" (independent draws), "low-discrepancy" (more evenly spread) or "saltelli" (for ``sensitivity``, with
    ``base_samples`` in place of ``count``: a power of two, each of which makes two cases and one for each axis); another ``seed`` gives
    other draws.
    """

    count: int | None = None
    seed: int = 0
    kind: str = "uniform"
    base_samples: int | None = None

    def _pairs(self) -> dict[str, str]:
        pairs = {"kind": self.kind, "count": self.count, "base_samples": self.base_samples, "seed": self.seed}
        return {key: _text.plain(f"draws.{key}", value) for key, value in pairs.items() if value is not None}


def tables(axes: Mapping[str, object], units: Mapping[str, str | None], drawn: bool) -> str:
    """The tables of the axes of a study, slowest first."""
    written = ""
    for name, axis in axes.items():
        unit = units.get(name)
        if drawn and isinstance(axis, tuple) and len(axis) == 2:
            axis = Axis(*axis)
        if isinstance(axis, Axis):
            if axis.points is None and not drawn:
                raise _text.unfit(f"axes[{name!r}]", "an Axis without points is a range for draws; how many points has it?")
            pairs = axis._pairs(f"axes.{name}", unit)
        elif isinstance(axis, Path):
            pairs = axis._pairs(f"axes.{name}", units)
        elif isinstance(axis, Normal):
            if not drawn:
                raise _text.unfit(f"axes[{name!r}]", "a Normal is the range of a draw; it needs draws=")
            pairs = axis._pairs(f"axes.{name}", unit)
        else:
            pairs = {"values": _text.quantities(f"axes.{name}", _values(axis), unit)}
        written += _text.table("[[axes]]", {"name": _text.quoted(name), **pairs})
    return written


def _values(axis: Any) -> list[object]:
    unit = _text.labelled_unit(axis)
    if unit is not None:
        return [f"{_text.number(it)} {unit}" for it in axis.values.ravel().tolist()]
    if hasattr(axis, "tolist") and not hasattr(axis, "magnitude"):
        values = axis.tolist()
        return values if isinstance(values, list) else [values]
    if isinstance(axis, str) or not hasattr(axis, "__iter__"):
        return [axis]
    return list(axis)
