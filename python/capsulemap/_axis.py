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
