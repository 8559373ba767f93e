"""A map of periods by heyoka's batches, with a test for recurrences.

Every lane is filled again when its case has settled, or has had all its cycles.
"""

import math
from functools import cache

import numpy as np

from cases import MAP_DAMPING
from contestant import answer_requests
from heyoka_lanes import LANES, Lanes

# Longest period that is sought, and how close the section must come to one of these
# cycles before, relative to its size, so many cycles running.
LONGEST = 16
CLOSE = 1e-9
RUNNING = 3

lanes_for = cache(Lanes)


class Settling:
    """The last sections of each lane, and which of them recur."""

    def __init__(self):
        """Begin with none."""
        self.points = np.full((LONGEST + 1, 4, LANES), np.nan)
        self.period = np.zeros(LANES, dtype=int)
        self.met = np.zeros(LANES, dtype=int)
        self.cycles = np.zeros(LANES, dtype=int)

    def begin(self, lane):
        """Forget what was in a lane."""
        self.points[:, :, lane] = np.nan
        self.period[lane] = self.met[lane] = self.cycles[lane] = 0

    def meet(self, state, omega):
        """Take note of the sections of all lanes; return which recur."""
        self.points = np.roll(self.points, 1, axis=0)
        self.points[0] = state
        self.points[0, 0] *= omega
        self.cycles += 1
        here, before = self.points[0, (0, 1, 3)], self.points[1:, (0, 1, 3)]
        size = np.abs(here).max(axis=0)
        near = np.abs(before - here).max(axis=1) <= CLOSE * size
        period = np.where(near.any(axis=0), near.argmax(axis=0) + 1, 0)
        again = (period > 0) & ((self.met == 0) | (period == self.period))
        self.met = np.where(again, self.met + 1, 0)
        self.period = period
        return self.met >= RUNNING

    def orbit(self, lane, omega):
        """Return the period of a lane and the average speed over it."""
        period = int(self.period[lane])
        progress = self.points[0, 2, lane] - self.points[period, 2, lane]
        return period, progress * omega / (2.0 * math.pi * period)


def follow(cases, cycles, tolerance):
    """Return period and speed of each case, zero and no number where none is found."""
    lanes, settling = lanes_for(tolerance, MAP_DAMPING), Settling()
    taylor = lanes.taylor
    waiting = sorted(range(len(cases)), key=lambda i: cases[i][1:3], reverse=True)
    ends = [(0, math.nan)] * len(cases)
    inside = [None] * LANES
    omega = np.ones(LANES)

    def fill(lane):
        inside[lane] = waiting.pop() if waiting else None
        # A lane that stays empty rests.
        case = (0.0, 100.0, 0.0, 1.0) if inside[lane] is None else cases[inside[lane]]
        lanes.begin(lane, case)
        omega[lane] = case[1]
        settling.begin(lane)

    for lane in range(LANES):
        fill(lane)
    while any(case is not None for case in inside):
        taylor.set_time(0.0)
        taylor.propagate_until(2.0 * math.pi / omega)
        recur = settling.meet(taylor.state[:4], omega)
        for lane, failed in enumerate(lanes.failed()):
            case = inside[lane]
            if case is None:
                continue
            if recur[lane]:
                ends[case] = settling.orbit(lane, omega[lane])
            if failed or recur[lane] or settling.cycles[lane] >= cycles:
                fill(lane)
    return ends


answer_requests(follow)
