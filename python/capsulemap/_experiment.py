"""Parameters from recordings, and recordings beside the simulation."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _capsulemap, _process, _text
from ._built import Built
from ._figure import Figure, of_files
from ._recordings import Recording, file_of
from ._runs import Start
from ._saved import Folder
from ._systems import _Parametric
from ._text import Quantity

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Fit:
    """Parameters that were fitted to recorded histories."""

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


@dataclass(frozen=True)
class Comparison:
    """A recording beside the simulation of the same case."""

    errors: xarray.Dataset
    """Over ``signal``: ``error``, the root mean square of the difference over the standard deviation of the record."""
    figure: Figure
    """Both over time."""
    told: Mapping[str, Any]
    """All that the command line tells with ``--json``: periods, speeds, impacts, gaps, explanations."""
    notes: list[str]
    """What it says beside, in sentences."""


@dataclass(frozen=True)
class Identified:
    """Constants of a rig, from simple tests."""

    parameters: xarray.Dataset
    """Over ``parameter``: ``value``, ``standard_error``, ``lower`` and ``upper`` (95 %), ``unit``, ``verdict`` and ``method``."""
    values: Mapping[str, float]
    """Those that are determined by name, in SI units; ``Capsule(**values)`` takes them but for ``motor_constant``."""
    told: Mapping[str, Any]
    """All that the command line tells with ``--json``."""
    notes: list[str]
    """What it says beside, in sentences."""


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
    systems = list(system) if isinstance(system, Sequence) else [system]
    units = systems[0]._description()["parameters"]
    varied = [_bounds(name, ends, units.get(name)) for name, ends in vary.items()]
    with tempfile.TemporaryDirectory(prefix="capsulemap-") as folder:
        files = _files(recordings, systems[0], folder)
        studies = [_study(it, start, folder, f"study-{number}") for number, it in enumerate(systems)]
        given = {"study": studies, "vary": varied, "cycles": cycles, "starts": starts, "robust": robust}
        told, _ = _process.asked_for_json(["fit", *files, *_process.options(given)], folder)
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
    """A recording beside the motion that the case settles to.

    The recording is as that of ``fit``. Each mapping of ``explain`` has parameters with bounds that are fitted together, and tells how
    much of the difference they explain (of a capsule); the figure shows so many ``cycles``. Raises StudyError and MachineError.
    """
    units = system._description()["parameters"]
    choices = [",".join(_bounds(name, ends, units.get(name)) for name, ends in it.items()) for it in explain]
    folder = Folder()
    files = _files(recording, system, folder.name)
    study = _study(system, start, folder.name, "study", protocol)
    given = {"explain": choices, "cycles": cycles, "output": "comparison"}
    told, notes = _process.asked_for_json(["compare", *files, study, *_process.options(given)], folder.name)
    return Comparison(_errors(told["errors"]), of_files(folder, "comparison"), told, notes)


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


def _files(recordings: Any, system: _Parametric, folder: str) -> list[str]:
    """The files of recordings, or of one."""
    each = [recordings] if _is_one(recordings) else list(recordings)
    names = ["recording"] if len(each) == 1 else [f"recording-{number}" for number in range(len(each))]
    units = system._description()["columns"]
    return [file_of(it, units, folder, name) for it, name in zip(each, names)]


def _is_one(recordings: Any) -> bool:
    is_path_or_columns = isinstance(recordings, (str, os.PathLike, Mapping))
    return is_path_or_columns or hasattr(recordings, "columns")


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
    low, high = (_text.words(f"vary.{name}", it, unit) for it in ends)
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
