"""The capsule's field and guards as heyoka's expressions, one system for all modes.

The mode lies in parameters, so that an event changes numbers and the integration goes
on within one call: faster here than one integrator for rest and one for sliding. The
drive's cosine and sine are two more states, cheaper than a cosine of time and no less
accurate over 100 cycles.
"""

import heyoka as hy

from capsule import BREAK_AWAY, K1, M1, M2, SLIDING, V_S, C

hy.llvm_state.set_diskcache_enabled(False)

# r, y1, x2, y2, cosine, sine.
STATES = 6
# Stiffness of contact, omega, p_d, delta, direction of the slide, whether it slides.
PARAMETERS = 6
# At slip onset y2 leaves zero with a double root, where the search for roots gives no
# number: the guard that ends a slide lies so far [m/s] beyond zero.
BEYOND = 1e-15


def field_and_guards(damping=C):
    """Return the equations, the guard of contact and the guard of friction."""
    r, y1, x2, y2, cosine, sine = hy.make_vars("r", "y1", "x2", "y2", "cosine", "sine")
    contact, omega, p_d, delta, direction, slides = (
        hy.par[i] for i in range(PARAMETERS)
    )
    force = (contact + K1) * r + damping * (y1 - y2) - contact * delta
    friction = direction * (SLIDING * (1.0 + hy.exp(direction * y2 * (-1.0 / V_S))))
    field = [
        (r, y1 - y2),
        (y1, (p_d * cosine - force) * (1.0 / M1)),
        (x2, y2),
        (y2, (force - friction) * (slides * (1.0 / M2))),
        (cosine, -omega * sine),
        (sine, omega * cosine),
    ]
    # At rest the direction is zero and the second guard is f_b^2 - F^2; in a slide, y2.
    rest = (1.0 - slides) * (BREAK_AWAY**2 - force * force)
    return field, r - delta, direction * y2 + BEYOND + rest
