"""Bifurcations, coexisting motions and trade-offs of the vibro-impact capsule and of oscillators of your own.

Numbers are in SI units; texts have units of their own ("2.42 kN/m"). Results are xarray datasets with the variables, dimensions,
coordinates and attributes of the program's HDF5 files, where ``attrs["units"]`` is the unit of each variable.
"""

from ._axis import Axis, Draws
from ._capsulemap import __version__, set_threads
from ._errors import Fault, MachineError, PartialResultWarning, StudyError
from ._job import Job, Status
from ._orbit import Orbit
from ._results import open
from ._runs import basin, branch, orbit, simulate, sweep
from ._study import Study
from ._systems import Capsule, Oscillator

__all__ = [
    "Axis",
    "Capsule",
    "Draws",
    "Fault",
    "Job",
    "MachineError",
    "Orbit",
    "Oscillator",
    "PartialResultWarning",
    "Status",
    "Study",
    "StudyError",
    "__version__",
    "basin",
    "branch",
    "open",
    "orbit",
    "set_threads",
    "simulate",
    "sweep",
]
