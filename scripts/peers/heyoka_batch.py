"""heyoka's batch integrator: eight cases in a vector, each at its own pace."""

import math
from functools import cache

import numpy as np

from contestant import answer_requests
from heyoka_lanes import LANES, Lanes

lanes_for = cache(Lanes)


def follow_group(lanes, cases, cycles):
    """Follow up to eight cases."""
    full = cases + cases[-1:] * (LANES - len(cases))
    for lane, case in enumerate(full):
        lanes.begin(lane, case)
    lanes.taylor.set_time(0.0)
    periods = 2.0 * math.pi / np.array([case[1] for case in full])
    lanes.taylor.propagate_until(cycles * periods)
    ends = lanes.taylor.state[:4].T.tolist()
    for lane, failed in enumerate(lanes.failed()):
        if failed:
            ends[lane] = [math.nan] * 4
    return [(*ends[lane], lanes.events[lane]) for lane in range(len(cases))]


def follow(cases, cycles, tolerance):
    """Follow the cases by eights, neighbours in frequency and amplitude together."""
    lanes = lanes_for(tolerance)
    order = sorted(range(len(cases)), key=lambda i: cases[i][1:3])
    ends = [None] * len(cases)
    for start in range(0, len(order), LANES):
        group = order[start : start + LANES]
        found = follow_group(lanes, [cases[i] for i in group], cycles)
        for i, end in zip(group, found, strict=True):
            ends[i] = end
    return ends


answer_requests(follow)
