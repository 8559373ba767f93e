"""Eight capsules in the lanes of heyoka's batch integrator, each at its own pace."""

import heyoka as hy
import numpy as np

from capsule import BREAK_AWAY, K1, C
from heyoka_capsule import PARAMETERS, STATES, field_and_guards

LANES = 8  # measured: faster than 4 and 16


class Lanes:
    """The integrator, with what its events need of each lane."""

    def __init__(self, tolerance, damping=C):
        """Build the integrator for one tolerance."""
        r = y1 = y2 = contact = direction = slides = None
        self.stiffness = stiffness = [0.0] * LANES
        self.delta = delta = [0.0] * LANES
        self.events = events = [0] * LANES

        def touch(_integrator, _sign, lane):
            events[lane] += 1
            r[lane] = delta[lane]
            contact[lane] = stiffness[lane] - contact[lane]
            return True

        def slip_or_stick(_integrator, _sign, lane):
            events[lane] += 1
            # Decided once, from this one value; y2 counts as zero.
            spring = contact[lane]
            elastic = (K1 + spring) * r[lane] - spring * delta[lane]
            force = elastic + damping * y1[lane]
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

        field, gap, friction = field_and_guards(damping)
        falling = hy.event_direction.negative
        self.taylor = taylor = hy.taylor_adaptive_batch(
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

    def begin(self, lane, case):
        """Put a case at rest into a lane."""
        self.stiffness[lane], omega, p_d, self.delta[lane] = case
        self.events[lane] = 0
        self.taylor.state[:, lane] = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
        self.taylor.pars[:, lane] = (0.0, omega, p_d, self.delta[lane], 0.0, 0.0)
        self.taylor.reset_cooldowns(lane)

    def failed(self):
        """Tell of each lane whether it stopped before the time it was to reach."""
        limit = hy.taylor_outcome.time_limit
        return [outcome[0] != limit for outcome in self.taylor.propagate_res]
