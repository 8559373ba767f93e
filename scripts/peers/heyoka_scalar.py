"""heyoka's scalar integrator with terminal events whose callbacks change the mode.

With `--reference` every sum is compensated and no floating-point shortcut taken.
"""

import math
import sys
from functools import cache

import heyoka as hy

from capsule import BREAK_AWAY, K1, C
from contestant import answer_requests
from heyoka_capsule import PARAMETERS, STATES, field_and_guards

REFERENCE = "--reference" in sys.argv


@cache
def integrator(tolerance):
    """Build the integrator for one tolerance; return what follows one case."""
    # Views of the integrator's memory; those of memoryview give plain floats, faster.
    state = parameters = None
    stiffness = delta = 0.0
    events = 0

    def touch(_integrator, _sign):
        nonlocal events
        events += 1
        state[0] = delta
        parameters[0] = stiffness - parameters[0]
        return True

    def slip_or_stick(_integrator, _sign):
        nonlocal events
        events += 1
        contact, direction = parameters[0], parameters[4]
        # Decided once, from this one value; y2 counts as zero.
        force = (K1 + contact) * state[0] - contact * delta + C * state[1]
        if direction == 0.0:
            parameters[4] = 1.0 if force > 0.0 else -1.0
            parameters[5] = 1.0
            return True
        state[3] = 0.0
        if -direction * force > BREAK_AWAY:
            parameters[4] = -direction
        else:
            parameters[4] = parameters[5] = 0.0
        return True

    field, gap, friction = field_and_guards()
    falling = hy.event_direction.negative
    taylor = hy.taylor_adaptive(
        field,
        [0.0] * STATES,
        pars=[0.0] * PARAMETERS,
        tol=tolerance,
        t_events=[
            hy.t_event(gap, callback=touch),
            hy.t_event(friction, direction=falling, callback=slip_or_stick),
        ],
        compact_mode=False,
        high_accuracy=REFERENCE,
        fast_math=not REFERENCE,
    )
    state, parameters = memoryview(taylor.state), memoryview(taylor.pars)

    def follow_one(case, cycles):
        nonlocal stiffness, delta, events
        stiffness, omega, p_d, delta = case
        events = 0
        taylor.state[:] = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
        taylor.pars[:] = (0.0, omega, p_d, delta, 0.0, 0.0)
        taylor.time = 0.0
        taylor.reset_cooldowns()
        outcome = taylor.propagate_until(cycles * 2.0 * math.pi / omega)[0]
        if outcome != hy.taylor_outcome.time_limit:
            return (math.nan, math.nan, math.nan, math.nan, events)
        return (*state.tolist()[:4], events)

    return follow_one


def follow(cases, cycles, tolerance):
    """Follow the cases one after the other."""
    follow_one = integrator(tolerance)
    return [follow_one(case, cycles) for case in cases]


answer_requests(follow)
