"""Bifurcations, coexisting motions and trade-offs of the vibro-impact capsule and of oscillators of your own.

Numbers are in SI units; texts have units of their own ("2.42 kN/m"). Results are xarray datasets with the variables, dimensions,
coordinates and attributes of the program's HDF5 files, where ``attrs["units"]`` is the unit of each variable.
"""

from ._axis import Axis, Draws, Normal, Path
from ._basins import basin_measures, tipping
from ._capsulemap import __version__, set_threads
from ._errors import Fault, MachineError, PartialResultWarning, StudyError, StudyWarning
from ._experiment import Comparison, Fit, Identified, compare, fit, identify
from ._explore import Page, explore
from ._figure import Figure, figure
from ._job import Job, Status
from ._orbit import Orbit
from ._progress import set_progress
from ._results import names, open, tree
from ._runs import attractors, basin, branch, orbit, simulate, sweep
from ._saved import save
from ._sensitivity import sensitivity
from ._study import Study
from ._systems import Capsule, Oscillator
from ._tradeoff import TradeOff, tradeoff

__all__ = [
    "Axis",
    "Capsule",
    "Comparison",
    "Draws",
    "Fault",
    "Figure",
    "Fit",
    "Identified",
    "Job",
    "MachineError",
    "Normal",
    "Orbit",
    "Oscillator",
    "Page",
    "PartialResultWarning",
    "Path",
    "Status",
    "Study",
    "StudyError",
    "StudyWarning",
    "TradeOff",
    "__version__",
    "attractors",
    "basin",
    "basin_measures",
    "branch",
    "compare",
    "explore",
    "figure",
    "fit",
    "identify",
    "names",
    "open",
    "orbit",
    "save",
    "sensitivity",
    "set_progress",
    "set_threads",
    "simulate",
    "sweep",
    "tipping",
    "tradeoff",
    "tree",
]
