"""Writes tests/data/sobol.json: points of Sobol's sequence by SciPy, and Sobol indices by SALib.

python3 -m venv VENV && VENV/bin/pip install SALib && VENV/bin/python scripts/references/sobol.py
"""

import importlib.metadata
import json
import math
import pathlib

import numpy
import scipy
from SALib.analyze import sobol as analysis
from SALib.sample import sobol as sampling
from scipy.stats import qmc

PLACES = [0, 1, 2, 3, 5, 100, 1023, 65535, 1000000]
"""Places in the sequence, which SciPy goes through in the order of Gray's code."""
DIMENSIONS = 64


def ishigami(x):
    """Ishigami's function with a = 7 and b = 0.1."""
    return numpy.sin(x[:, 0]) + 7 * numpy.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * numpy.sin(x[:, 0])


def product(x):
    """Sobol's g function, far from zero."""
    weights = numpy.array([0.0, 1.0, 4.5, 9.0, 99.0])
    return 1000 + numpy.prod((numpy.abs(4 * x - 2) + weights) / (1 + weights), axis=1)


def point(place):
    sequence = qmc.Sobol(DIMENSIONS, scramble=False)
    if place:
        sequence.fast_forward(place)
    return sequence.random(1)[0].tolist()


def indices(function, bounds, rows, confidence):
    names = [f"x{number + 1}" for number in range(len(bounds))]
    problem = {"num_vars": len(bounds), "names": names, "bounds": bounds}
    values = function(sampling.sample(problem, rows, calc_second_order=False, seed=7))
    found = analysis.analyze(
        problem, values, calc_second_order=False, num_resamples=20000, conf_level=confidence, seed=3
    )
    told = {name: found[name].tolist() for name in ("S1", "S1_conf", "ST", "ST_conf")}
    return {"quantities": len(bounds), "confidence": confidence, "values": values.tolist(), **told}


def main():
    told = {
        "by": f"SALib {importlib.metadata.version('SALib')}, SciPy {scipy.__version__}",
        "points": [{"place": place, "point": point(place)} for place in PLACES],
        "indices": [
            indices(ishigami, [[-math.pi, math.pi]] * 3, 64, 0.95),
            indices(product, [[0.0, 1.0]] * 5, 32, 0.9),
        ],
    }
    path = pathlib.Path(__file__).parents[2] / "tests/data/sobol.json"
    path.write_text(json.dumps(told, indent=None, separators=(",", ":")).replace("},{", "},\n{") + "\n")


if __name__ == "__main__":
    main()
