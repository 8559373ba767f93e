"""pynamicalsys: the basin of Duffing's oscillator by its own function for basins.

It samples each motion once a cycle after a transient, and clusters the means of the
samples. Answers as benches/duffing_basin.rs of the engine does.
"""

import json
import sys
import time

import numpy as np
from numba import njit
from pynamicalsys.continuous_time.basins import basin_of_attraction
from pynamicalsys.continuous_time.step_methods import rk45_step_wrapped

PERIOD = 2.0 * np.pi
# Slow motions lose exp(-0.04 * 2 pi * 100) = 1e-11 of their transient.
TRANSIENT = 100 * PERIOD
# A whole number of periods for each of the attractors, whose periods are 1 to 3.
SAMPLES = 6
# Means so far apart are of two attractors: its default of 0.05 takes three of them for
# one, and less than this takes one for several, as samples are interpolated linearly.
APART = 0.01


@njit
def duffing(time, state, parameters):
    """x'' + c x' + x^3 = p cos t."""
    rates = np.empty(2)
    rates[0] = state[1]
    force = parameters[1] * np.cos(time)
    rates[1] = force - parameters[0] * state[1] - state[0] ** 3
    return rates


def labels(side, tolerance):
    """Return the cluster of each start of a grid."""
    along = (np.arange(side) + 0.5) / side
    x, v = np.meshgrid(-1.0 + 2.0 * along, -0.5 + 1.5 * along)
    # Its class guesses the first step from one start, and fails for several.
    return basin_of_attraction(
        np.stack([x.ravel(), v.ravel()], axis=1),
        np.array([0.08, 0.2]),
        SAMPLES,
        duffing,
        np.float64(TRANSIENT),
        np.float64(0.01),
        np.float64(tolerance),
        np.float64(tolerance),
        rk45_step_wrapped,
        "SM",
        sampling_time=np.float64(PERIOD),
        eps=np.float64(APART),
    )


def main():
    """Print the processor's seconds and the labels."""
    side, tolerance = int(sys.argv[1]), float(sys.argv[2])
    # What is compiled at the first use is compiled before the clock starts.
    labels(2, tolerance)
    start = time.process_time()
    found = labels(side, tolerance)
    seconds = time.process_time() - start
    print(json.dumps({"seconds": seconds, "labels": found.tolist()}))


main()
