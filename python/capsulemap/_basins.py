"""Measures of basins, as the command line tells them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import _capsulemap, _process, _text
from ._saved import Place, Results
from ._text import Quantity


def basin_measures(
    results: Results,
    *,
    settled_within: Sequence[int] | None = None,
    density: Mapping[str, tuple[Quantity, Quantity]] | None = None,
) -> dict[str, Any]:
    """What basins are like beyond the variables of their dataset: whether they are Wada, how fast starts settle, and shares of other starts.

    ``results`` is a dataset of ``basin`` or ``attractors``, or the path of a file of results. ``settled_within`` are numbers of cycles:
    ``settling["settled"]`` has the shares of starts that have settled on each attractor within each. ``density`` has a mean and a
    deviation for coordinates of the start ({"start_r": ("0 mm", "2 mm")}): ``weighted`` has the shares of starts that are drawn from these
    normal distributions, of a grid. ``wada`` says to within which radius three basins or more have one boundary.
    Quantities are numbers in SI units or texts with units. docs/basins.md tells what each is. Raises StudyError and MachineError.
    """
    _text.mapping("density", density, '{"start_r": ("0 mm", "2 mm")}')
    within = [] if settled_within is None else list(settled_within)
    for cycles in within:
        _text.whole("settled_within", cycles)
    given = {
        "settled_within": ",".join(map(str, within)) or None,
        "density": [_density(name, both) for name, both in (density or {}).items()] or None,
    }
    place = Place(results)
    told, _ = _process.asked_for_json(["inspect", place.path, *_process.options(given)])
    return {name: told[name] for name in ("wada", "settling", "weighted")}


def tipping(
    results: Results,
    *,
    step: tuple[Quantity, Quantity] | None = None,
    draws: int = 200,
    seed: int = 0,
    ball: float = 0.0,
) -> dict[str, Any]:
    """Where motions go when the parameter steps, of basins along a parameter.

    ``results`` is a dataset of one parameter and of starts, or the path of such a file. ``step`` is the value before and after, the
    nearest of the results; each value and the next by default. For each attractor before the step, ``steps`` has the probabilities to go
    to each after it: ``orbit`` of motions that have settled, at random moments of the period (``draws`` of each), displaced in a ball of
    the radius ``ball`` in the unit in which section points are compared; ``basin`` of the starts of its basin. docs/basins.md tells more.
    Raises StudyError and MachineError.
    """
    _text.whole("draws", draws, 1)
    _text.whole("seed", seed)
    ends = None if step is None else _text.pair("step", step, "two values")
    place = Place(results)
    given = {
        "from": None if ends is None else _text.words("step", ends[0]),
        "to": None if ends is None else _text.words("step", ends[1]),
        "draws": draws,
        "seed": seed,
        "ball": _text.words("ball", ball),
        "threads": _capsulemap.threads(),
    }
    told, _ = _process.asked_for_json(["tipping", place.path, *_process.options(given)])
    return told


def _density(name: str, both: object) -> str:
    mean, deviation = _text.pair(f"density[{name!r}]", both, "a mean and a deviation")
    return f"{name}={_text.words('density', mean)},{_text.words('density', deviation)}"
