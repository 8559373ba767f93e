"""What is asked of a system: one motion, a sweep, a basin, a branch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

from . import _results, _study, _text
from ._axis import Draws
from ._built import Built, Outputs
from ._job import Job
from ._orbit import Orbit, orbit_of
from ._study import Keep, Kept
from ._systems import _Parametric
from ._text import Quantity

if TYPE_CHECKING:
    import xarray

Start = Mapping[str, Quantity]
"""Coordinates of a start and phases by name: numbers in SI units or texts with units; what is missing is zero."""


def simulate(
    system: _Parametric,
    *,
    start: Start | None = None,
    cycles: int = 20,
    protocol: Mapping[str, object] | None = None,
) -> xarray.Dataset:
    """One motion from its start over so many cycles of the drive, or returns to the section.

    Over ``cycle``: ``time`` [s], the coordinates at each section, and what the system sums up and counts from the start. Over
    ``event``: ``event_time`` [s], ``event_kind`` (with ``flag_meanings``) and the state before the event. An attribute ``failure`` says
    why the motion ends early, if it does. Raises StudyError.
    """
    study = Built(system, start=start, protocol=protocol).study()
    _study.tell(study)
    _text.whole("cycles", cycles)
    return _results.dataset(study.simulate(int(cycles)))


def orbit(
    system: _Parametric, *, start: Start | None = None, protocol: Mapping[str, object] | None = None
) -> Orbit:
    """Follows the motion until it settles, and returns its orbit: outcome, period, multipliers, outputs.

    ``start`` has coordinates (of a capsule "r" [m], "y1", "y2" [m/s]) and "phase" [rad]; what is missing is zero. Raises StudyError.
    """
    built = Built(system, start=start, protocol=protocol)

    def history(cycles: int, samples_per_cycle: int, begin: str) -> xarray.Dataset:
        span = {"from": begin, "cycles": cycles, "samples_per_cycle": samples_per_cycle}
        study = Built(system, start=start, protocol=protocol, history=span).study()
        whole = _results.dataset(_computed(study))
        kept = [name for name in whole.data_vars if "history_time" in whole[name].dims]
        return whole[kept]

    study = built.study()
    _study.tell(study)
    arrays = _results.arrays(_computed(study))
    return orbit_of(arrays, system._description()["outputs"], history)


def _computed(study: Any) -> dict[str, Any]:
    """The results of one case; Ctrl-C ends it."""
    job = study.begin(True, False)
    try:
        job.wait()
    except KeyboardInterrupt:
        job.cancel()
        raise
    result: dict[str, Any] = job.result()
    return result


@overload
def sweep(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    inherit: str | None = None,
    directions: str | Sequence[str] | None = None,
    draws: Draws | int | None = None,
    refine: Mapping[str, Quantity] | None = None,
    protocol: Mapping[str, object] | None = None,
    history: Mapping[str, object] | None = None,
    title: str = "",
    keep: Keep = None,
    overwrite: bool = False,
    blocking: Literal[True] = True,
) -> xarray.Dataset: ...


@overload
def sweep(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    inherit: str | None = None,
    directions: str | Sequence[str] | None = None,
    draws: Draws | int | None = None,
    refine: Mapping[str, Quantity] | None = None,
    protocol: Mapping[str, object] | None = None,
    history: Mapping[str, object] | None = None,
    title: str = "",
    keep: Keep = None,
    overwrite: bool = False,
    blocking: Literal[False],
) -> Job: ...


def sweep(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    inherit: str | None = None,
    directions: str | Sequence[str] | None = None,
    draws: Draws | int | None = None,
    refine: Mapping[str, Quantity] | None = None,
    protocol: Mapping[str, object] | None = None,
    history: Mapping[str, object] | None = None,
    title: str = "",
    keep: Keep = None,
    overwrite: bool = False,
    blocking: bool = True,
) -> xarray.Dataset | Job:
    """Computes the settled motion of every case of a grid, or of random draws.

    ``axes`` maps parameters ("omega") and coordinates of the start ("start_r", "start_phase") to their values, slowest first: an
    array or list of numbers in SI units or texts with units, or an Axis; the name of a dimension of its own to a Path, along which
    several vary together. ``outputs`` are names of ``system.names["outputs"]``, all of
    them unless given; ``{"own": {"speed_per_power": "progression_speed/power"}}`` defines one by an expression. With ``draws`` each axis is an Axis or a pair, the range.
    With ``inherit`` each case starts where its neighbour along that axis has settled, in each of the ``directions`` ("upward",
    "downward"). ``refine`` maps outputs to the most by which neighbours may differ: cases are computed only where they do.
    ``protocol`` and ``history`` have the keys of these tables of a study file. ``keep`` and ``overwrite`` are as those of ``Study.run``.

    Returns the dataset that the program's file would hold, or with ``blocking=False`` a Job. Ctrl-C returns what is done, with a
    PartialResultWarning. Raises StudyError with all faults before anything is computed, and MachineError.
    """
    built = Built(
        system,
        axes,
        outputs=outputs,
        start=start,
        inherit=inherit,
        directions=directions,
        draws=draws,
        refine=refine,
        protocol=protocol,
        history=history,
        title=title,
    )
    kept = Kept(keep, overwrite)
    return _study.run(built.study(), cases=True, branches=False, kept=kept, blocking=blocking)


@overload
def basin(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    draws: Draws | int | None = None,
    refine: bool = False,
    early_decision: bool = True,
    manifolds: bool = False,
    protocol: Mapping[str, object] | None = None,
    title: str = "",
    keep: Keep = None,
    overwrite: bool = False,
    blocking: Literal[True] = True,
) -> xarray.Dataset: ...


@overload
def basin(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    draws: Draws | int | None = None,
    refine: bool = False,
    early_decision: bool = True,
    manifolds: bool = False,
    protocol: Mapping[str, object] | None = None,
    title: str = "",
    keep: Keep = None,
    overwrite: bool = False,
    blocking: Literal[False],
) -> Job: ...


def basin(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    draws: Draws | int | None = None,
    refine: bool = False,
    early_decision: bool = True,
    manifolds: bool = False,
    protocol: Mapping[str, object] | None = None,
    title: str = "",
    keep: Keep = None,
    overwrite: bool = False,
    blocking: bool = True,
) -> xarray.Dataset | Job:
    """Which start leads to which motion: a sweep over starts alone.

    ``axes`` are as those of a sweep, of "start_r", "start_y1" and the like. ``attractor`` numbers the motion of each start, and
    variables over ``attractor_index`` tell of each motion: its period, multipliers, outputs and share of the starts. With ``refine``
    only starts beside the boundaries are computed. With ``manifolds`` the boundary is followed as curves, the variables over
    ``stable_point``, and the unstable manifolds of its saddles, those over ``unstable_point``. Returns and raises as ``sweep`` does.
    """
    keys: dict[str, object] = {} if early_decision else {"early_decision": False}
    if refine:
        keys["refine"] = True
    if manifolds:
        keys["manifolds"] = True
    built = Built(
        system,
        axes,
        outputs=outputs,
        start=start,
        draws=draws,
        basin=keys,
        protocol=protocol,
        title=title,
    )
    kept = Kept(keep, overwrite)
    return _study.run(built.study(), cases=True, branches=False, kept=kept, blocking=blocking)


def attractors(
    system: _Parametric,
    axes: Mapping[str, object],
    *,
    outputs: Outputs = None,
    start: Start | None = None,
    draws: Draws | int | None = None,
    protocol: Mapping[str, object] | None = None,
) -> xarray.Dataset:
    """The motions that starts lead to: as ``basin``, but only the table of motions over ``attractor_index``, not the result of each start.

    The starts are those of ``axes``, as of a basin, or drawn from their ranges. Each motion has its outcome, period, multipliers,
    section points, outputs (SI) and share of the starts. Raises StudyError and MachineError.
    """
    whole = basin(system, axes, outputs=outputs, start=start, draws=draws, protocol=protocol)
    of_starts = {"draw", *axes} & set(map(str, whole.sizes))
    return whole.drop_dims(list(of_starts))


def branch(
    system: _Parametric,
    along: str,
    ends: tuple[Quantity, Quantity],
    *,
    start: Start | None = None,
    period: int | None = None,
    doublings: int = 0,
    second: tuple[str, Quantity, Quantity] | None = None,
    longest_step: float = 0.02,
    most_points: int = 2000,
    outputs: Outputs = None,
    protocol: Mapping[str, object] | None = None,
    title: str = "",
) -> xarray.Dataset:
    """A periodic orbit that is continued in a parameter between two ends, stable or not, with its special points.

    The first orbit is the one to which the motion from ``start`` settles with the parameters of the system; with a ``period`` [cycles]
    the one to which Newton's method leads from there, which may be unstable. ``doublings`` is how often to switch to the branch of twice
    the period; ``second`` is a name and two ends, and continues special points as curves in two parameters. Variables over
    ``branch_point`` tell of each orbit, those over ``special_point`` of folds, period doublings, grazings and the like. Raises
    StudyError and MachineError.
    """
    low, high = _text.pair("ends", ends, "two ends of the parameter")
    keys: dict[str, object] = {
        "name": title or "branch",
        "along": along,
        "from": low,
        "to": high,
        "start": start,
        "orbit": None if period is None else "newton",
        "period": period,
        "doublings": doublings,
        "second": second,
        "longest_step": longest_step,
        "most_points": most_points,
    }
    built = Built(system, outputs=outputs, branch=keys, protocol=protocol, title=title)
    result = _study.run(built.study(), cases=False, branches=True, blocking=True)
    assert not isinstance(result, Job)
    return result
