"""Sobol indices of the outputs in results that are there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from . import _capsulemap, _process, _text
from ._saved import Place, Results

if TYPE_CHECKING:
    import xarray

INDICES = {
    "S1": "Sobol index of first order: share of the variance that the quantity makes by itself",
    "ST": "Sobol index of total order: share of the variance that the quantity takes part in",
}
"""What each quantity has of each output."""
NUMBERS = {
    "mean": "mean over both matrices of the design (SI)",
    "variance": "variance over both matrices of the design (SI)",
    "S1_sum": "sum of the indices of first order",
    "S1_sum_conf": "half the width of the interval of the sum",
    "ST_sum": "sum of the indices of total order",
    "ST_sum_conf": "half the width of the interval of the sum",
    "base_samples": "base samples all of whose cases have a value",
    "base_samples_left_out": "the other base samples",
    "aperiodic_cases": "cases that do not repeat, whose values are means with standard errors",
}
"""What each output has."""


def sensitivity(
    results: Results,
    of: str | Sequence[str] | None = None,
    *,
    resamples: int = 1000,
    confidence: float = 0.95,
    seed: int = 1,
) -> xarray.Dataset:
    """Sobol indices of outputs by the quantities that are drawn, as SALib's ``sobol.analyze`` finds them.

    ``results`` is a dataset of a sweep, or the path of a file of results, of ``draws=Draws(base_samples=512, kind="saltelli")``; ``of``
    names outputs, all by default. A dataset over ``output`` and ``quantity``: ``S1`` and ``ST``, and with ``_conf`` half the width of the
    interval, from so many ``resamples`` of the base samples. NaN of an output that does not vary. Raises StudyError and MachineError.
    """
    import numpy
    import xarray

    for name, number in (("resamples", resamples), ("seed", seed)):
        _text.whole(name, number)
    names = [of] if isinstance(of, str) else of
    given = {
        "of": ",".join(names) if names is not None else None,
        "resamples": resamples,
        "confidence": confidence,
        "seed": seed,
        "threads": _capsulemap.threads(),
    }
    place = Place(results)
    told, _ = _process.asked_for_json(["sensitivity", place.path, *_process.options(given)])
    quantities = told["quantities"]
    # In the order that was asked for, or that of the model.
    outputs = list(names) if names is not None else [it for it in _outputs(place) if it in told["outputs"]]
    found = [told["outputs"][name] for name in outputs]
    dataset = xarray.Dataset(coords={"output": outputs, "quantity": quantities})
    for name, meaning in INDICES.items():
        for key, label in ((name, meaning), (f"{name}_conf", f"half the width of the interval of {name}")):
            values = [[it["quantities"][quantity][key] for quantity in quantities] for it in found]
            dataset[key] = (("output", "quantity"), numpy.array(values, float), {"units": "1", "long_name": label})
    for name, label in NUMBERS.items():
        numbers = [numpy.nan if it[name] is None else it[name] for it in found]
        dataset[name] = ("output", numpy.array(numbers), {"long_name": label})
    dataset.attrs.update({name: told[name] for name in ("confidence", "resamples", "seed")})
    return dataset


def _outputs(place: Place) -> list[str]:
    return list(_capsulemap.describe(results=place.path)["outputs"])
