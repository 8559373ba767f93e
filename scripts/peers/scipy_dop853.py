"""SciPy's solve_ivp with DOP853: one call for each stretch between two events."""

import math

from scipy.integrate import solve_ivp

from capsule import BREAK_AWAY, K1, M1, M2, SLIDING, V_S, C
from contestant import answer_requests

# Of the size of the motion: r in mm, velocities in 0.1 m/s.
SIZES = (1e-3, 1e-1, 1e-3, 1e-1)
# It looks for events at the ends of its steps only: longer ones passed over slips.
STEPS_PER_CYCLE = 50


def falling(guard):
    """Mark a guard that ends the stretch where it falls through zero."""
    guard.terminal, guard.direction = True, -1.0
    return guard


def stretch(case, closed, slip):
    """Return the field and the guards of one mode."""
    k2, omega, p_d, delta = case
    contact = k2 if closed else 0.0
    side = 1.0 if closed else -1.0

    def force(y):
        return (K1 + contact) * y[0] - contact * delta + C * (y[1] - y[3])

    def field(t, y):
        r, y1, _, y2 = y.tolist()
        f = (K1 + contact) * r - contact * delta + C * (y1 - y2)
        y1_rate = (p_d * math.cos(omega * t) - f) / M1
        if slip == 0.0:
            return (y1, y1_rate, 0.0, 0.0)
        friction = slip * SLIDING * (1.0 + math.exp(-slip * y2 / V_S))
        return (y1 - y2, y1_rate, y2, (f - friction) / M2)

    guards = [falling(lambda _, y: side * (y[0] - delta))]
    if slip == 0.0:
        guards.append(falling(lambda _, y: BREAK_AWAY - force(y)))
        guards.append(falling(lambda _, y: BREAK_AWAY + force(y)))
    else:
        guards.append(falling(lambda _, y: slip * y[3]))
    return field, guards, force


def follow_one(case, cycles, tolerance):
    """Follow one case from rest through all its stretches."""
    _, omega, _, delta = case
    absolute = [tolerance * size for size in SIZES]
    t, end = 0.0, cycles * 2.0 * math.pi / omega
    y, closed, slip, events = [0.0] * 4, False, 0.0, 0
    while True:
        field, guards, force = stretch(case, closed, slip)
        solution = solve_ivp(
            field,
            (t, end),
            y,
            "DOP853",
            events=guards,
            rtol=tolerance,
            atol=absolute,
            max_step=2.0 * math.pi / omega / STEPS_PER_CYCLE,
        )
        t, y = solution.t[-1], solution.y[:, -1].tolist()
        if solution.status != 1:
            return (*y, events) if solution.status == 0 else (math.nan,) * 4 + (events,)
        events += 1
        which = next(i for i, times in enumerate(solution.t_events) if len(times))
        if which == 0:
            closed, y[0] = not closed, delta
        elif slip == 0.0:
            slip = 1.0 if which == 1 else -1.0
        else:
            y[3] = 0.0
            slip = -slip if -slip * force(y) > BREAK_AWAY else 0.0


def follow(cases, cycles, tolerance):
    """Follow the cases one after the other."""
    return [follow_one(case, cycles, tolerance) for case in cases]


answer_requests(follow)
