"""What gains most for how little, in results that are there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _capsulemap, _process, _text
from ._saved import Place, Results
from ._text import Quantity

if TYPE_CHECKING:
    import xarray

NAMES = ("fastest_within_budget", "most_gain_within_budget", "least_for_speed", "least_cost_for_gain")
"""The optima that there may not be."""
NOTHING: dict[str, Any] = {}
"""A motion that there is not."""
UNDER_TOLERANCES = {
    "draws": "number of draws within the tolerances",
    "kept": "share of the draws that keep the period",
    "meet_conditions": "number of draws that meet the conditions",
    "within_budget": "number of draws within the budget",
    "meet_conditions_within_budget": "number of draws that meet the conditions within the budget",
    "speed_of_slowest_5_percent": "speed that 95 of 100 draws reach (SI)",
    "gain_of_least_5_percent": "gain that 95 of 100 draws reach (SI)",
    "price_of_dearest_5_percent": "cost that 95 of 100 draws do not exceed (SI)",
}
"""What tolerances leave of a motion."""
PARTS = ("parameters", "start", "margins", "robustness", "standard_errors")
"""What a motion has several numbers of, besides slopes."""


@dataclass(frozen=True, repr=False)
class TradeOff:
    """The trade-off of a gain, as the progression speed, against a cost, as the power.

    ``front``: a dataset over ``point``, the motions of which none has more gain for less cost, with parameters, start, gain, cost and what
    is known of each, in SI units; ``sensitivity`` and ``sensitivity_of_COST`` over ``parameter`` are relative slopes (1 % of a parameter
    changes the output by so many %), ``stationarity`` what a step in the parameters might still bring (0 at an optimum), ``held_by`` the
    bounds that hold it. ``optima``: the same over ``optimum`` by name; NaN where there is none. ``top``: the same of the motions with the
    most gain. ``left_out``: why cases take no part, with their number. ``told``: all that the command line tells, ``margins`` of each
    motion among it. ``notes``: what it says beside. ``figure(this, "trade-off")`` draws it with what its searches have found.
    """

    front: xarray.Dataset
    """The motions of which none has more gain for less cost, over ``point``: parameters, start, gain, cost and what is known of each, in
    SI units. ``sensitivity`` and ``sensitivity_of_COST`` are relative slopes (a change of 1 % of a parameter, in % of the output) over
    ``parameter``; NaN of a motion without derivatives."""
    optima: xarray.Dataset
    """The same of the optima by name, over ``optimum``: "fastest", "knee", "lowest_cost_of_transport", "fastest_within_budget",
    "least_for_speed", "fastest_under_tolerances", those that there are; other gains have "most_gain" and the like."""
    top: xarray.Dataset
    """The same of the motions with the most gain, as many as were asked for."""
    left_out: Mapping[str, int]
    """Why cases take no part, with their number."""
    told: Mapping[str, Any]
    """All that the command line tells with ``--json``."""
    notes: list[str]
    """What it says beside, in sentences."""
    place: Place
    """The file of the results, beside which searches are kept; of a dataset it is there as long as this object."""

    def __repr__(self) -> str:
        gain, cost = self.told.get("for", "progression_speed"), self.told["of"]
        told = [f"<TradeOff of {gain} against {cost}: {self.front.sizes['point']} motions on the front>"]
        # Without a single motion there are no columns.
        for name in self.optima.optimum.values.tolist() if gain in self.optima else ():
            motion = self.optima.sel(optimum=name)
            told.append(f"  {name}: {gain} = {motion[gain].item():.6g}, {cost} = {motion[cost].item():.6g}")
        return "\n".join(told)


def tradeoff(
    results: Results,
    *,
    of: str | None = None,
    gain: str | None = None,
    direction: str = "either",
    where: str | None = None,
    at_rest: Quantity | None = None,
    budget: Quantity | None = None,
    speed: Quantity | None = None,
    refine: bool = False,
    starts: int | None = None,
    tolerances: Mapping[str, Quantity] | None = None,
    draws: int | None = None,
    margins: bool = False,
    seed: int = 1,
    top: int = 0,
) -> TradeOff:
    """The fastest motions for the least energy, or the most of one output for the least of another.

    ``results`` is a dataset of a sweep, or the path of a file of results. ``of`` is the output that should be small (of the capsule the
    power), ``gain`` the one that should be large (the progression speed). ``where`` bounds parameters and outputs ("peak_contact_force <
    30 N and k2 < 5 kN/m"), ``budget`` [unit of the cost] the cost, ``speed`` [unit of the gain] asks for the cheapest motion that is
    as fast; ``direction`` is "either", "forward" or "backward". With ``refine`` motions are followed between the cases, over all
    parameters that vary. ``tolerances`` ({"k2": 0.05}, of the value) draw parameters about each motion; ``margins`` tell how far each
    parameter may go. Quantities are numbers in SI units or texts with units.

    What a refinement finds is kept beside the file, as by the command line, so that the same question is answered at once; of a dataset
    that holds as long as the TradeOff, which ``results`` may be, too. Ctrl-C ends it. Raises StudyError and MachineError.
    """
    _text.mapping("tolerances", tolerances, '{"k2": 0.05}')
    for name, number in (("starts", starts), ("draws", draws), ("seed", seed), ("top", top)):
        if number is not None:
            _text.whole(name, number)
    _text.truth("refine", refine)
    _text.truth("margins", margins)
    place = Place(results)
    given = {
        "of": of,
        "for": gain,
        "direction": direction,
        "where": where,
        "at_rest": _words(at_rest, "at_rest"),
        "budget": _words(budget, "budget"),
        "speed": _words(speed, "speed"),
        "refine": refine,
        "starts": starts,
        "tolerances": _tolerances(tolerances),
        "draws": draws,
        "margins": margins,
        "seed": seed,
        "top": top or None,
        "threads": _capsulemap.threads(),
    }
    told, notes = _process.asked_for_json(["tradeoff", place.path, *_process.options(given)])
    model = _capsulemap.describe(results=place.path)
    # The others are limits, which have names of their own.
    optima = [name for name, it in told.items() if it is None and name in NAMES or isinstance(it, Mapping) and "parameters" in it]
    notes += [f"{name}: there is no such motion" for name in optima if told[name] is None]
    return TradeOff(
        front=_table(told["front"], "point", range(len(told["front"])), model),
        optima=_table([told[name] for name in optima], "optimum", optima, model),
        top=_table(told.get("top", []), "point", range(len(told.get("top", []))), model),
        left_out=told["left_out"],
        told=told,
        notes=notes,
        place=place,
    )


def _words(value: Quantity | None, key: str) -> str | None:
    return None if value is None else _text.words(key, value)


def _tolerances(each: Mapping[str, Quantity] | None) -> str | None:
    if each is None:
        return None
    return ", ".join(f"{name} = {_text.words(f'tolerances.{name}', it)}" for name, it in each.items())


def _table(
    rows: Sequence[Mapping[str, Any]], along: str, names: Sequence[Any], model: Mapping[str, Any]
) -> xarray.Dataset:
    """Motions as the columns of a dataset."""
    import numpy
    import xarray

    dataset = xarray.Dataset(coords={along: list(names)})
    first = next(filter(None, rows), None)
    if first is None:
        return dataset
    rows = [row or NOTHING for row in rows]
    for group in ("parameters", "start"):
        for name in first[group]:
            unit = {**model["coordinates"], **model["parameters"]}.get(name)
            values = [row.get(group, NOTHING).get(name, numpy.nan) for row in rows]
            dataset[name] = (along, numpy.array(values, float), {"units": unit or "1"})
    for name in first:
        if name not in PARTS and not name.startswith("sensitivity"):
            values = [row.get(name) for row in rows]
            dataset[name] = (along, *_column(name, values, model["outputs"]))
    _add_parts(dataset, rows, along, [name for name in first if name.startswith("sensitivity")])
    return dataset


def _column(
    name: str, values: Sequence[Any], outputs: Mapping[str, tuple[str, str]]
) -> tuple[Any, dict[str, str]]:
    """What each motion has under a name, with its labels: words, lists of words or numbers."""
    import numpy

    if any(isinstance(it, list) for it in values):
        return [", ".join(map(str, it or ())) for it in values], {}
    if any(isinstance(it, str) for it in values):
        return [str(it or "") for it in values], {}
    unit, meaning = outputs.get(name, ("1", name.replace("_", " ")))
    numbers = [numpy.nan if it is None else it for it in values]
    return numpy.array(numbers), {"units": unit, "long_name": meaning}


def _add_parts(
    dataset: xarray.Dataset, rows: Sequence[Mapping[str, Any]], along: str, slopes: Sequence[str]
) -> None:
    """Adds what a motion has several numbers of: errors, what tolerances do, slopes."""
    import numpy

    def column(part: str, name: str) -> Any:
        values = [(row.get(part) or {}).get(name) for row in rows]
        return numpy.array([numpy.nan if it is None else it for it in values], float)

    for part, ending in (("standard_errors", "_standard_error"), ("robustness", "_under_tolerances")):
        for name in dict.fromkeys(name for row in rows for name in row.get(part) or ()):
            label = {"long_name": UNDER_TOLERANCES.get(name, name.replace("_", " "))}
            dataset[name + ending] = (along, column(part, name), label)
    parameters = list(dict.fromkeys(name for part in slopes for row in rows for name in row.get(part) or ()))
    for part in slopes:
        values = numpy.stack([column(part, name) for name in parameters], axis=-1) if parameters else None
        if values is not None:
            label = {"units": "1", "long_name": "relative slope in the parameter"}
            dataset[part] = ((along, "parameter"), values, label)
    if parameters:
        dataset.coords["parameter"] = parameters
