"""Puts studies together from arguments, as the text of a study file, which the library reads by its own rules."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from . import _axis, _capsulemap, _text
from ._axis import Draws
from ._errors import StudyError
from ._study import NAME
from ._systems import _Parametric
from ._text import Quantity

Outputs = str | Sequence[str] | Mapping[str, Any] | None
"""Names of the outputs to keep, or what a study has in its table ``outputs``: a list ``keep``, and ``own`` outputs by name with their
expressions, as ``{"own": {"speed_per_power": "progression_speed/power"}}``."""

START_ALONE = ("phase",)
"""Keys of a start that are no coordinates of their own."""


@dataclass
class Built:
    """A study as it is put together."""

    system: _Parametric
    axes: Mapping[str, object] = field(default_factory=dict)
    outputs: Outputs = None
    start: Mapping[str, Quantity] | None = None
    inherit: str | None = None
    directions: str | Sequence[str] | None = None
    draws: Draws | int | None = None
    protocol: Mapping[str, object] | None = None
    history: Mapping[str, object] | None = None
    basin: Mapping[str, object] | None = None
    refine: Mapping[str, Quantity] | None = None
    branch: Mapping[str, Any] | None = None
    title: str = ""

    def study(self) -> _capsulemap.Study:
        """The study; raises StudyError with all of its faults."""
        if not isinstance(self.system, _Parametric):
            kind = type(self.system).__name__
            raise TypeError(f"expected a Capsule or an Oscillator, found {kind}")
        self._check()
        units = self.system._units()
        text = self._top() + self.system._head() + self.system._table(_axis.varied(self.axes))
        text += _axis.tables(self.axes, units, self.draws is not None)
        if self.draws is not None:
            draws = Draws(self.draws) if isinstance(self.draws, int) else self.draws
            text += _text.table("[draws]", draws._pairs())
        text += _text.table("[start]", self._start(units))
        for header, pairs in (("protocol", self.protocol), ("history", self.history), ("basin", self.basin)):
            written = {key: _text.plain(f"{header}.{key}", it) for key, it in (pairs or {}).items()}
            text += _text.table(f"[{header}]", written)
        text += self._map() + self._branch(units) + self.system._tail()
        try:
            return _capsulemap.Study.built(text.lstrip("\n"), NAME)
        except StudyError as error:
            raise self._by_names(error) from None

    def _check(self) -> None:
        """Sure that the arguments are of the kinds that they are to be of."""
        _text.mapping("axes", self.axes, '{"omega": [60, 70]}')
        _text.mapping("start", self.start, '{"r": "1 mm"}')
        _text.mapping("protocol", self.protocol, '{"max_cycles": 5000}')
        _text.mapping("history", self.history, '{"cycles": 5}')
        _text.mapping("refine", self.refine, '{"progression_speed": "1 mm/s"}')
        if self.inherit is not None and not isinstance(self.inherit, str):
            raise TypeError(f"inherit: expected the name of an axis, found {self.inherit!r}")
        if isinstance(self.draws, bool) or not isinstance(self.draws, (Draws, int, type(None))):
            raise TypeError(f"draws: expected Draws or how many, found {self.draws!r}")
        known = self.system._description()
        for name in _axis.varied(self.axes):
            if f"start_{name}" in known["coordinates"]:
                raise _text.unfit(f"axes[{name!r}]", f"the start is called start_{name} on an axis")
            if self.basin is not None and name in known["parameters"]:
                raise _text.unfit(f"axes[{name!r}]", "a basin has starts alone on its axes; sweep takes parameters, too")

    def _by_names(self, error: StudyError) -> StudyError:
        """An error whose faults call axes by their names, as there is no file to count them in."""
        names = [str(name) for name in self.axes]

        def named(text: str) -> str:
            return re.sub(r"axes\[(\d+)\]", lambda it: f"axes[{names[int(it[1]) - 1]!r}]", text)

        faults = [fault._replace(key=named(fault.key)) for fault in error.faults]
        return StudyError(named(str(error)), faults)

    def _top(self) -> str:
        title = f"title = {_text.quoted(self.title)}\n" if self.title else ""
        if self.outputs is None:
            return title
        outputs = self.outputs if isinstance(self.outputs, Mapping) else _text.listed(self.outputs)
        return title + f"outputs = {_text.plain('outputs', outputs)}\n"

    def _start(self, units: Mapping[str, str | None]) -> dict[str, str]:
        pairs = start_pairs("start", self.start or {}, units)
        if self.inherit is not None:
            pairs["inherit"] = _text.quoted(self.inherit)
        if self.directions is not None:
            pairs["directions"] = _text.plain("start.directions", _text.listed(self.directions))
        return pairs

    def _map(self) -> str:
        if self.refine is None:
            return ""
        outputs = self.system._description()["outputs"]
        each = {}
        for name, most in self.refine.items():
            unit = outputs[name][0] if name in outputs else None
            each[name] = _text.quantity(f"map.refine.{name}", most, None if unit == "1" else unit)
        return _text.table("[map]", {"refine": _text.inline(each)})

    def _branch(self, units: Mapping[str, str | None]) -> str:
        if self.branch is None:
            return ""
        pairs: dict[str, str] = {}
        along = self.branch.get("along")
        for key, value in self.branch.items():
            path = f"branches.{key}"
            if value is None:
                continue
            if key in ("from", "to"):
                pairs[key] = _text.quantity(path, value, units.get(str(along)))
            elif key == "start":
                pairs[key] = _text.inline(start_pairs(path, value, units))
            elif key == "second":
                if isinstance(value, str) or len(value) != 3:
                    raise TypeError(f"second: expected a name and two ends, found {value!r}")
                name, low, high = value
                unit = units.get(name)
                ends = {"from": low, "to": high}
                written = {end: _text.quantity(path, it, unit) for end, it in ends.items()}
                pairs[key] = _text.inline({"name": _text.quoted(name), **written})
            else:
                pairs[key] = _text.plain(path, value)
        return _text.table("[[branches]]", pairs)


def start_pairs(
    path: str, start: Mapping[str, Quantity], units: Mapping[str, str | None]
) -> dict[str, str]:
    """The keys of a start, of which numbers are in SI units."""
    pairs = {}
    for key, value in start.items():
        unit = units.get(f"start_{key}", units.get(key, "rad" if key in START_ALONE else None))
        pairs[key] = _text.quantity(f"{path}.{key}", value, unit)
    return pairs
