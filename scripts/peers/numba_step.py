"""The capsule's field and one step of Dormand and Prince's method, for numba."""

from math import cos, exp

from numba import njit

from capsule import K1, M1, M2, SLIDING, V_S, C


@njit(inline="always", error_model="numpy")
def force(k2, delta, closed, y):
    """Return the force of the mass on the capsule."""
    contact = k2 if closed else 0.0
    return (K1 + contact) * y[0] - contact * delta + C * (y[1] - y[3])


@njit(inline="always", error_model="numpy")
def rates(case, closed, slip, t, y):
    """Return the rates of r, y1, x2 and y2."""
    k2, omega, p_d, delta = case
    f = force(k2, delta, closed, y)
    push = 0.0
    if slip != 0.0:
        friction = slip * SLIDING * (1.0 + exp(slip * y[3] * (-1.0 / V_S)))
        push = (f - friction) * (1.0 / M2)
    return y[1] - y[3], (p_d * cos(omega * t) - f) * (1.0 / M1), y[3], push


@njit(inline="always", error_model="numpy")
def total(ka, a, kb, b, kc, c, kd, d, ke, e, kf, f):
    """Return the sum of six rates, each times its weight."""
    return (
        a * ka[0] + b * kb[0] + c * kc[0] + d * kd[0] + e * ke[0] + f * kf[0],
        a * ka[1] + b * kb[1] + c * kc[1] + d * kd[1] + e * ke[1] + f * kf[1],
        a * ka[2] + b * kb[2] + c * kc[2] + d * kd[2] + e * ke[2] + f * kf[2],
        a * ka[3] + b * kb[3] + c * kc[3] + d * kd[3] + e * ke[3] + f * kf[3],
    )


@njit(inline="always", error_model="numpy")
def moved(y, h, rate):
    """Return y after the time h at one rate."""
    return (
        y[0] + h * rate[0],
        y[1] + h * rate[1],
        y[2] + h * rate[2],
        y[3] + h * rate[3],
    )


# Weights of zero vanish when compiled: that is what fastmath is for here.
@njit(fastmath=True, error_model="numpy")
def step(case, closed, slip, t, h, y, k1):
    """Take one step; return the end, the rates there and the size of the error."""
    z = k1
    s = total(k1, 1 / 5, z, 0.0, z, 0.0, z, 0.0, z, 0.0, z, 0.0)
    k2 = rates(case, closed, slip, t + h / 5, moved(y, h, s))
    s = total(k1, 3 / 40, k2, 9 / 40, z, 0.0, z, 0.0, z, 0.0, z, 0.0)
    k3 = rates(case, closed, slip, t + h * 3 / 10, moved(y, h, s))
    s = total(k1, 44 / 45, k2, -56 / 15, k3, 32 / 9, z, 0.0, z, 0.0, z, 0.0)
    k4 = rates(case, closed, slip, t + h * 4 / 5, moved(y, h, s))
    a, b, c, d = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
    s = total(k1, a, k2, b, k3, c, k4, d, z, 0.0, z, 0.0)
    k5 = rates(case, closed, slip, t + h * 8 / 9, moved(y, h, s))
    a, b, c, d, e = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
    s = total(k1, a, k2, b, k3, c, k4, d, k5, e, z, 0.0)
    k6 = rates(case, closed, slip, t + h, moved(y, h, s))
    a, c, d, e, f = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
    s = total(k1, a, z, 0.0, k3, c, k4, d, k5, e, k6, f)
    end = moved(y, h, s)
    k7 = rates(case, closed, slip, t + h, end)
    a, c, d, e, f = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525
    s = total(k1, a, k3, c, k4, d, k5, e, k6, f, k7, -1 / 40)
    error = abs(h) * max(case[1] * abs(s[0]), abs(s[1]), abs(s[3]))
    return end, k7, error
