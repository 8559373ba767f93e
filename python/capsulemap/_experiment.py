"""Parameters from recordings, and recordings beside the simulation."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _capsulemap, _process, _text
from ._built import Built
from ._errors import StudyWarning, warn
from ._figure import Figure, of_files
from ._recordings import Recording, file_of
from ._runs import Start
from ._saved import Folder
from ._systems import _Parametric
from ._text import Quantity

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class Fit:
    """Parameters that were fitted to recorded histories.

    ``parameters``: a dataset over ``parameter`` with ``value``, ``standard_error``, ``lower`` and ``upper`` (the interval of 95 %, from the
    profile likelihood) in the SI unit that ``unit`` names, and ``verdict``: "determined", "limited above", "limited below" or
    "not determined". ``values``: the values by name. ``system``: the system with these values. ``misfit``: the standard deviation of the residuals
    over the noise of the recordings, 1 where nothing but noise is left. ``warnings``: what is to be doubted, which is warned of, too.
    ``told``: all that the command line tells, as covariances and drifts.
    """

    parameters: xarray.Dataset
    """Over ``parameter``: ``value``, ``standard_error``, ``lower`` and ``upper`` (the interval of 95 %, from the profile likelihood), ``unit``
    and ``verdict`` ("determined", or what the data leave open)."""
    values: Mapping[str, float]
    """The values by name, in SI units."""
    system: _Parametric
    """The system with the fitted values; of several that of the first recording."""
    misfit: float
    """Standard deviation of the residuals over the noise of the recordings: 1 where nothing but noise is left."""
    warnings: list[str]
    """What is to be doubted, in sentences."""
    told: Mapping[str, Any]
    """All that the command line tells with ``--json``, as covariances and drifts."""

    def __repr__(self) -> str:
        told = [f"<Fit: misfit {self.misfit:.4g}>"]
        for name, value in self.values.items():
            row = self.parameters.sel(parameter=name)
            unit = "" if row.unit.item() == "1" else f" {row.unit.item()}"
            error, verdict = row.standard_error.item(), row.verdict.item()
            told.append(f"  {name} = {value:.6g}{unit}, standard error {error:.2g}, {verdict}")
        return "\n".join(told + [f"  warning: {it}" for it in self.warnings])


@dataclass(frozen=True, repr=False)
class Comparison:
    """A recording beside the simulation of the same case.

    ``errors``: a dataset over ``signal`` with ``error``, the root mean square of the difference over the standard deviation of the record, and of a
    capsule ``shape_error``, without the difference of the speeds. ``figure``: both over time. ``warnings``: what may be wrong with the
    recording, which is warned of, too. ``told``: all that the command line tells: periods, speeds, impacts, gaps, ``explanations``.
    """

    errors: xarray.Dataset
    """Over ``signal``: ``error``, the root mean square of the difference over the standard deviation of the record."""
    figure: Figure
    """Both over time."""
    warnings: list[str]
    """What may be wrong with the recording, in sentences."""
    told: Mapping[str, Any]
    """All that the command line tells with ``--json``: periods, speeds, impacts, gaps, explanations."""

    def __repr__(self) -> str:
        told = ["<Comparison>"]
        told += [f"  error of {name}: {100 * self.errors.error.sel(signal=name).item():.3g} %" for name in self.errors.signal.values.tolist()]
        return "\n".join(told + [f"  warning: {it}" for it in self.warnings])


@dataclass(frozen=True, repr=False)
class Identified:
    """Constants of a rig, from simple tests.

    ``parameters``: a dataset over ``parameter`` with ``value``, ``standard_error``, ``lower`` and ``upper`` (95 %) in the SI unit that ``unit`` names,
    ``verdict`` and ``method``. ``values``: those that are determined, by name. ``told``: all that the command line tells. ``notes``:
    what it says beside.
    """

    parameters: xarray.Dataset
    """Over ``parameter``: ``value``, ``standard_error``, ``lower`` and ``upper`` (95 %), ``unit``, ``verdict`` and ``method``."""
    values: Mapping[str, float]
    """Those that are determined by name, in SI units; ``Capsule(**values)`` takes them but for ``motor_constant``."""
    told: Mapping[str, Any]
    """All that the command line tells with ``--json``."""
    notes: list[str]
    """What it says beside, in sentences."""

    def __repr__(self) -> str:
        told = ["<Identified>"]
        for it in self.told["identified"]:
            unit = "" if it["unit"] == "1" else f" {it['unit']}"
            value = "no value" if it["value"] is None else f"{it['value']:.6g}{unit}"
            told.append(f"  {it['name']} = {value}, {it['verdict']}, {it['method']}")
        return "\n".join(told)


def fit(
    recordings: Recording | Sequence[Recording],
    system: _Parametric | Sequence[_Parametric],
    vary: Mapping[str, tuple[Quantity, Quantity]],
    *,
    start: Start | None = None,
    cycles: int | None = None,
    starts: int = 8,
    robust: bool = False,
) -> Fit:
    """Fits parameters to recorded histories of the motion.

    A recording is a CSV file, or a table: a column ``t`` [s], and of a capsule any of ``x2``, ``r``, ``x1`` [m], ``y1``, ``y2`` [m/s], ``a1`` [m/s2],
    with ``drive`` [N] or ``current`` [A], which give the phase; of an oscillator of your own its states. Columns are in SI units, or as
    their names say ("x2 [mm]"). ``system`` says how the rig was set, for each recording or for all; ``vary`` maps parameters to their
    bounds. ``cycles`` of each recording are used, 6 unless given; ``starts`` searches begin within the bounds. With ``robust`` outliers
    count little. Ctrl-C ends it. Raises StudyError where recordings or bounds do not fit, and MachineError.
    """
    systems = _systems(system)
    _text.mapping("vary", vary, '{"k2": ("1 kN/m", "5 kN/m")}')
    if not vary:
        raise _text.unfit("vary", "expected one parameter at least with its bounds")
    if cycles is not None:
        _text.whole("cycles", cycles, 1)
    _text.whole("starts", starts, 1)
    _text.truth("robust", robust)
    units = systems[0]._description()["parameters"]
    varied = [_bounds(name, ends, units.get(name)) for name, ends in vary.items()]
    with tempfile.TemporaryDirectory(prefix="capsulemap-") as folder:
        files = _files(recordings, systems[0], folder)
        studies = [_study(it, start, folder, f"study-{number}") for number, it in enumerate(systems)]
        given = {"study": studies, "vary": varied, "cycles": cycles, "starts": starts, "robust": robust}
        told, _ = _process.asked_for_json(["fit", *files, *_process.options(given)], folder)
    for warning in told["warnings"]:
        warn(warning, StudyWarning)
    parameters = _parameters(told["fitted"])
    values = {it["name"]: it["value"] for it in told["fitted"]}
    return Fit(
        parameters=parameters,
        values=values,
        system=systems[0].replace(**values),
        misfit=told["misfit"],
        warnings=told["warnings"],
        told=told,
    )


def compare(
    recording: Recording,
    system: _Parametric,
    *,
    start: Start | None = None,
    explain: Sequence[Mapping[str, tuple[Quantity, Quantity]]] = (),
    cycles: int = 5,
    protocol: Mapping[str, object] | None = None,
) -> Comparison:
    """Compares a recording with the simulated motion that the case settles to.

    The recording is as that of ``fit``. Each mapping of ``explain`` has parameters with bounds that are fitted together, and tells how
    much of the difference they explain (of a capsule); the figure shows so many ``cycles``. Raises StudyError and MachineError.
    """
    _check_system(system)
    _text.whole("cycles", cycles, 1)
    units = system._description()["parameters"]
    choices = [",".join(_bounds(name, ends, units.get(name)) for name, ends in it.items()) for it in explain]
    folder = Folder()
    files = _files(recording, system, folder.name)
    study = _study(system, start, folder.name, "study", protocol)
    given = {"explain": choices, "cycles": cycles, "output": "comparison"}
    told, _ = _process.asked_for_json(["compare", *files, study, *_process.options(given)], folder.name)
    for warning in told["warnings"]:
        warn(warning, StudyWarning)
    return Comparison(_errors(told["errors"]), of_files(folder, "comparison"), told["warnings"], told)


def identify(
    *,
    free_vibration: Recording | None = None,
    static_force: Recording | None = None,
    pull: Recording | None = None,
    coasting: Recording | None = None,
    motor: Recording | None = None,
    m1: Quantity | None = None,
    m2: Quantity | None = None,
    g: Quantity | None = None,
) -> Identified:
    """Constants of a rig from recordings of simple tests, each a CSV file or a table with columns in SI units.

    ``free_vibration``: ``t`` [s], ``r`` [m] of the mass on a capsule that is held gives k1 and c, and needs ``m1`` [kg]; ``static_force``: ``force`` [N],
    ``deflection`` [m] of the stop gives k2; ``pull``: ``pulled_mass`` [kg] that just moves the rig gives mu_s, and needs both masses;
    ``coasting``: ``v`` [m/s], ``d`` [m] until rest gives mu_d and v_s; ``motor``: ``current`` [A], ``force`` [N] gives the motor constant. Raises
    StudyError and MachineError.
    """
    recordings = {
        "free-vibration": free_vibration,
        "static-force": static_force,
        "pull": pull,
        "coasting": coasting,
        "motor": motor,
    }
    if all(it is None for it in recordings.values()):
        raise _text.unfit("", f"no recording is given; expected one of {', '.join(recordings).replace('-', '_')}")
    columns = _capsulemap.tests()
    with tempfile.TemporaryDirectory(prefix="capsulemap-") as folder:
        given: dict[str, object] = {
            test: file_of(recording, columns[test], folder, test)
            for test, recording in recordings.items()
            if recording is not None
        }
        masses = {"m1": (m1, "kg"), "m2": (m2, "kg"), "g": (g, "m/s2")}
        given |= {key: _text.words(key, it, unit) for key, (it, unit) in masses.items() if it is not None}
        told, notes = _process.asked_for_json(["identify", *_process.options(given)], folder)
    found = told["identified"]
    parameters = _parameters(found)
    parameters["method"] = ("parameter", [it["method"] for it in found])
    values = {it["name"]: it["value"] for it in found if it["verdict"] == "determined"}
    return Identified(parameters, values, told, notes)


def _systems(system: Any) -> list[_Parametric]:
    """The systems of recordings, or the one of all."""
    systems = list(system) if isinstance(system, (list, tuple)) else [system]
    for it in systems:
        _check_system(it)
    return systems


def _check_system(system: object) -> None:
    if not isinstance(system, _Parametric):
        raise TypeError(f"expected a Capsule or an Oscillator, found {type(system).__name__}")


def _files(recordings: Any, system: _Parametric, folder: str) -> list[str]:
    """The files of recordings, or of one."""
    each = [recordings] if _is_one(recordings) else list(recordings)
    names = ["recording"] if len(each) == 1 else [f"recording-{number}" for number in range(len(each))]
    units = system._description()["columns"]
    return [file_of(it, units, folder, name) for it, name in zip(each, names)]


def _is_one(recordings: Any) -> bool:
    is_path_or_columns = isinstance(recordings, (str, os.PathLike, Mapping))
    return is_path_or_columns or hasattr(recordings, "columns") or hasattr(recordings, "to_frame")


def _study(
    system: _Parametric,
    start: Start | None,
    folder: str,
    name: str,
    protocol: Mapping[str, object] | None = None,
) -> str:
    """The file of the study of one case."""
    study = Built(system, start=start, protocol=protocol).study()
    path = os.path.join(folder, f"{name}.toml")
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(study.text)
    return os.path.basename(path)


def _bounds(name: str, ends: tuple[Quantity, Quantity], unit: str | None) -> str:
    """A parameter with its bounds as an option has it."""
    both = _text.pair(f"vary[{name!r}]", ends, "two bounds")
    low, high = (_text.words(f"vary.{name}", it, unit) for it in both)
    return f"{name}={low}..{high}"


def _parameters(found: Sequence[Mapping[str, Any]]) -> xarray.Dataset:
    import numpy
    import xarray

    def numbers(values: list[Any]) -> Any:
        return numpy.array([numpy.nan if it is None else it for it in values], float)

    ends = [it["interval_95"] or (None, None) for it in found]
    columns = {
        "value": numbers([it["value"] for it in found]),
        "standard_error": numbers([it["standard_error"] for it in found]),
        "lower": numbers([it[0] for it in ends]),
        "upper": numbers([it[1] for it in ends]),
        "verdict": [it["verdict"] for it in found],
    }
    units = [it["unit"] for it in found]
    coords = {"parameter": [it["name"] for it in found], "unit": ("parameter", units)}
    return xarray.Dataset({name: ("parameter", of) for name, of in columns.items()}, coords=coords)


def _errors(errors: Sequence[Mapping[str, Any]]) -> xarray.Dataset:
    import numpy
    import xarray

    dataset = xarray.Dataset(coords={"signal": [it["signal"] for it in errors]})
    for name in ("error", "shape_error"):
        if any(name in it for it in errors):
            values = [numpy.nan if it.get(name) is None else it[name] for it in errors]
            dataset[name] = ("signal", numpy.array(values, float), {"units": "1"})
    return dataset
