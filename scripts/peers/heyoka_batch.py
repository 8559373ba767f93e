"""heyoka's batch integrator: eight cases in a vector, each at its own pace."""

import math
from functools import cache

import heyoka as hy
import numpy as np

from capsule import BREAK_AWAY, K1, C
from contestant import answer_requests
from heyoka_capsule import PARAMETERS, STATES, field_and_guards

LANES = 8  # measured: faster than 4 and 16


@cache
def integrator(tolerance):
    """Build the integrator for one tolerance; return what follows up to eight cases."""
    r = y1 = y2 = contact = direction = slides = None
    stiffness = delta = events = None

    def touch(_integrator, _sign, lane):
        events[lane] += 1
        r[lane] = delta[lane]
        contact[lane] = stiffness[lane] - contact[lane]
        return True

    def slip_or_stick(_integrator, _sign, lane):
        events[lane] += 1
        # Decided once, from this one value; y2 counts as zero.
        spring = contact[lane]
        force = (K1 + spring) * r[lane] - spring * delta[lane] + C * y1[lane]
        going = direction[lane]
        if going == 0.0:
            direction[lane] = 1.0 if force > 0.0 else -1.0
            slides[lane] = 1.0
            return True
        y2[lane] = 0.0
        if -going * force > BREAK_AWAY:
            direction[lane] = -going
        else:
            direction[lane] = slides[lane] = 0.0
        return True

    field, gap, friction = field_and_guards()
    falling = hy.event_direction.negative
    taylor = hy.taylor_adaptive_batch(
        field,
        np.zeros((STATES, LANES)),
        pars=np.zeros((PARAMETERS, LANES)),
        tol=tolerance,
        t_events=[
            hy.t_event_batch(gap, callback=touch),
            hy.t_event_batch(friction, direction=falling, callback=slip_or_stick),
        ],
        compact_mode=False,
        fast_math=True,
    )
    # Views of the integrator's memory; those of memoryview give plain floats, faster.
    r, y1, _, y2 = map(memoryview, taylor.state[:4])
    contact, _, _, _, direction, slides = map(memoryview, taylor.pars)

    def follow_group(cases, cycles):
        nonlocal stiffness, delta, events
        full = np.array(cases + cases[-1:] * (LANES - len(cases))).T
        stiffness, delta, events = full[0].tolist(), full[3].tolist(), [0] * LANES
        taylor.state[:] = 0.0
        taylor.state[4] = 1.0
        taylor.pars[:] = 0.0
        taylor.pars[1:4] = full[1:4]
        taylor.set_time(0.0)
        taylor.reset_cooldowns()
        taylor.propagate_until(cycles * 2.0 * math.pi / full[1])
        ends = taylor.state[:4].T.tolist()
        for lane, outcome in enumerate(taylor.propagate_res):
            if outcome[0] != hy.taylor_outcome.time_limit:
                ends[lane] = [math.nan] * 4
        return [(*ends[lane], events[lane]) for lane in range(len(cases))]

    return follow_group


def follow(cases, cycles, tolerance):
    """Follow the cases by eights, neighbours in frequency and amplitude together."""
    follow_group = integrator(tolerance)
    order = sorted(range(len(cases)), key=lambda i: cases[i][1:3])
    ends = [None] * len(cases)
    for start in range(0, len(order), LANES):
        group = order[start : start + LANES]
        for i, end in zip(
            group, follow_group([cases[i] for i in group], cycles), strict=True
        ):
            ends[i] = end
    return ends


answer_requests(follow)
