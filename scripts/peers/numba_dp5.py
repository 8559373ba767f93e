"""The capsule by Dormand and Prince's method; Newton's method meets the events.

The step is chosen so that the local error stays below the tolerance times the size of
the motion. A step on which a guard falls through zero, at its end or in a dip between,
is taken again so long that it ends on the guard.
"""

from math import nan, pi

from numba import njit

from capsule import BREAK_AWAY, K1, C
from contestant import answer_requests
from numba_step import force, rates, step

# Velocities below this [m/s] are met to the tolerance times this.
SMALL = 1e-3


@njit(inline="always", error_model="numpy")
def guard(which, case, closed, slip, y, rate):
    """Return a guard (0 contact, 1 friction), positive till its event, and its rate."""
    k2, _, _, delta = case
    if which == 0:
        side = 1.0 if closed else -1.0
        return side * (y[0] - delta), side * rate[0]
    if slip != 0.0:
        return slip * y[3], slip * rate[3]
    f = force(k2, delta, closed, y)
    f_rate = (K1 + (k2 if closed else 0.0)) * rate[0] + C * rate[1]
    return BREAK_AWAY - abs(f), -f_rate if f > 0.0 else f_rate


@njit(error_model="numpy")
def dips(g0, s0, g1, s1, h):
    """Return when the cubic through a guard's ends is lowest, if below zero; else h.

    A guard that has just been obeyed is zero at the start, up to rounding, and does
    not dip.
    """
    if g0 <= 0.0 or s0 >= 0.0 or s1 <= 0.0:
        return h
    # The cubic's slope is a + b x + c x^2 over x from 0 to 1, with one rising root.
    a, rise = s0 * h, g1 - g0
    c = 3.0 * (a + s1 * h - 2.0 * rise)
    b = 2.0 * (3.0 * rise - 2.0 * a - s1 * h)
    x = -2.0 * a / (b + max(b * b - 4.0 * a * c, 0.0) ** 0.5)
    low = g0 + x * (a + x * (b / 2.0 + x * c / 3.0))
    return x * h if low < 0.0 else h


@njit(error_model="numpy")
def land(which, case, closed, slip, t, h, y, k1, end, rate):
    """End a step on the guard that falls within h; return its length and end."""
    low, high, at = 0.0, h, h
    for _ in range(60):
        value, slope = guard(which, case, closed, slip, end, rate)
        if value > 0.0:
            low = at
        else:
            high = at
        onward = at - value / slope
        if not low < onward < high:
            onward = 0.5 * (low + high)
        if abs(onward - at) < 1e-14:
            break
        at = onward
        end, rate, _ = step(case, closed, slip, t, at, y, k1)
    return at, end


@njit(error_model="numpy")
def switched(which, case, closed, slip, y):
    """Obey the event of a guard; return contact, slip and state after it."""
    k2, _, _, delta = case
    r, y1, x2, y2 = y
    if which == 0:
        return not closed, slip, (delta, y1, x2, y2)
    if slip != 0.0:
        y2 = 0.0
    # Decided once, from this one value.
    f = force(k2, delta, closed, (r, y1, x2, y2))
    if slip == 0.0:
        slip = 1.0 if f > 0.0 else -1.0
    else:
        slip = -slip if -slip * f > BREAK_AWAY else 0.0
    return closed, slip, (r, y1, x2, y2)


@njit(error_model="numpy")
def follow_one(case, cycles, tolerance):
    """Follow one case from rest; return its end and the number of events."""
    omega = case[1]
    t, until = 0.0, cycles * 2.0 * pi / omega
    longest = 0.5 / omega
    y, closed, slip, events = (0.0, 0.0, 0.0, 0.0), False, 0.0, 0
    k1 = rates(case, closed, slip, t, y)
    pace = 1e-3 * longest
    steps = 0
    while t < until:
        steps += 1
        if steps > 1_000_000 * cycles:
            return (nan, nan, nan, nan), events
        h = min(pace, until - t)
        end, rate, error = step(case, closed, slip, t, h, y, k1)
        size = max(omega * abs(end[0]), abs(end[1]), abs(end[3]), SMALL)
        quotient = error / (tolerance * size) + 1e-10
        factor = min(5.0, max(0.2, 0.9 * quotient**-0.2))
        if quotient > 1.0:
            pace = h * factor
            continue
        which = -1
        for candidate in range(2):
            g0, s0 = guard(candidate, case, closed, slip, y, k1)
            g1, s1 = guard(candidate, case, closed, slip, end, rate)
            dip = h if g1 < 0.0 else dips(g0, s0, g1, s1, h)
            if dip < h:
                h = dip
                end, rate, _ = step(case, closed, slip, t, h, y, k1)
                g1, s1 = guard(candidate, case, closed, slip, end, rate)
            if g1 < 0.0:
                h, end = land(candidate, case, closed, slip, t, h, y, k1, end, rate)
                rate = rates(case, closed, slip, t + h, end)
                which = candidate
        t = t + h if h < until - t else until
        pace = pace if which >= 0 else min(h * factor, longest)
        y, k1 = end, rate
        if which >= 0:
            events += 1
            closed, slip, y = switched(which, case, closed, slip, y)
            k1 = rates(case, closed, slip, t, y)
    return y, events


def follow(cases, cycles, tolerance):
    """Follow the cases one after the other."""
    ends = (follow_one(case, cycles, tolerance) for case in cases)
    return [(*y, events) for y, events in ends]


answer_requests(follow)
