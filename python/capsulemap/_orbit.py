"""What one motion settles to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy
    import xarray


@dataclass(frozen=True, repr=False)
class Orbit:
    """What a motion settles to.

    ``outcome``: "periodic", "chaotic", "quasi-periodic", "undecided" or "failed"; ``period`` in cycles, 0 where it does not repeat;
    ``certificate``: how the period is proven ("newton", "grazing", "neutral", "neighbourhood") or "none"; ``multipliers`` of the period;
    ``outputs`` by name in SI units, and ``units`` of them; ``section``: the coordinates of the section points by name, one number for each cycle (as
    many as the period, of a motion that does not repeat as many as ``protocol={"points": ...}``); ``failure``: why it could not be followed.
    """

    outcome: str
    """"periodic", "chaotic", "quasi-periodic", "undecided" or "failed"."""
    period: int
    """Period in cycles; 0 where it does not repeat."""
    certificate: str
    """What is proven of the period: "newton", "grazing", "neutral", "none", ..."""
    multipliers: tuple[complex, ...]
    """Floquet multipliers of the period, the largest magnitude first; empty where there are none."""
    outputs: Mapping[str, float]
    """The outputs by name, in SI units; NaN where there is nothing to tell."""
    units: Mapping[str, str]
    """The unit of each output; "1" where it has none."""
    section: Mapping[str, numpy.ndarray]
    """The coordinates of the section points by name, one number for each cycle measured, in SI units."""
    failure: str | None
    """Why the motion could not be followed, if so."""
    _history: Callable[[int, int, str], xarray.Dataset] = field(repr=False, compare=False)

    def history(
        self, *, cycles: int = 5, samples_per_cycle: int = 400, start: str = "attractor"
    ) -> xarray.Dataset:
        """The motion over time, along ``history_time`` in cycles, from the ``attractor`` on or from the ``start``.

        Raises StudyError where no histories are kept of the system, as without a drive.
        """
        return self._history(cycles, samples_per_cycle, start)

    def __repr__(self) -> str:
        """The outcome, and the outputs one by one."""
        period = f", period {self.period}" if self.period else ""
        told = [f"<Orbit: {self.outcome}{period}, certificate {self.certificate}>"]
        told += [f"  failure: {self.failure}"] if self.failure else []
        for name, value in self.outputs.items():
            unit = "" if self.units[name] == "1" else f" {self.units[name]}"
            told.append(f"  {name} = {value:.6g}{unit}")
        return "\n".join(told)


def orbit_of(
    arrays: dict[str, tuple[Any, dict[str, Any]]],
    outputs: Mapping[str, tuple[str, str]],
    history: Callable[[int, int, str], xarray.Dataset],
) -> Orbit:
    """The orbit in the results of a study of one case."""
    import numpy

    period = int(arrays["period"][0])
    real, imaginary = arrays["multiplier_real"][0], arrays["multiplier_imag"][0]
    both = zip(real.tolist(), imaginary.tolist())
    known = [name for name in outputs if name in arrays]
    section = {
        name.removeprefix("section_"): values[~numpy.isnan(values)]
        for name, (values, _) in arrays.items()
        if name.startswith("section_") and getattr(values, "ndim", 0) == 1
    }
    outcome = _flag(arrays, "outcome")
    return Orbit(
        outcome=outcome,
        period=period,
        certificate=_flag(arrays, "certificate"),
        multipliers=tuple(complex(*parts) for parts in both if not numpy.isnan(parts).any()),
        outputs={name: float(arrays[name][0]) for name in known},
        units={name: outputs[name][0] for name in known},
        section=section,
        failure=_flag(arrays, "failure_reason") if outcome == "failed" else None,
        _history=history,
    )


def _flag(arrays: dict[str, tuple[Any, dict[str, Any]]], name: str) -> str:
    """The name of the category of a variable that has one number."""
    import numpy

    values, own = arrays[name]
    codes = numpy.atleast_1d(own["flag_values"]).tolist()
    return str(own["flag_meanings"].split(" ")[codes.index(int(values))])
