"""How far an end is from the reference's, and which cases went another way."""

import math
from dataclasses import dataclass

# The definition, as the report prints it.
DEFINITION = (
    "Error: at the end of the last cycle, the largest of |Δy1|/V, |Δy2|/V, ω|Δr|/V and "
    "|Δx2|/L, where V is the largest of |y1|, |y2| and ω|r| there, and L the mean "
    "progression per cycle |x2|/n, or V/(1000 ω) if that is more."
)
# An end so far off is on another motion.
ELSEWHERE = 1e-3


def error(case, cycles, end, reference):
    """Return the error of an end (r, y1, x2, y2, events), as defined above."""
    omega = case[1]
    r, y1, x2, y2 = reference[:4]
    velocity = max(abs(y1), abs(y2), omega * abs(r))
    length = max(abs(x2) / cycles, velocity / (1000.0 * omega))
    dr, dy1, dx2, dy2 = (
        abs(a - b) for a, b in zip(end[:4], reference[:4], strict=True)
    )
    largest = max(dy1 / velocity, dy2 / velocity, omega * dr / velocity, dx2 / length)
    # A sum is not a number if a part is, which max would hide.
    return largest if math.isfinite(sum(end[:4])) else math.inf


@dataclass
class Comparison:
    """The largest error where the events are as many, and what the other cases do."""

    cases: int
    largest: float
    other_events: int
    largest_with_other_events: float
    elsewhere: int

    def apart(self):
        """Say which cases do not count in the largest error."""
        parts = []
        if self.other_events:
            largest = f"{self.largest_with_other_events:.0e}"
            parts.append(f"{self.other_events} with other events, to {largest}")
        if self.elsewhere:
            parts.append(f"{self.elsewhere} elsewhere")
        return "; ".join(parts) or "none"


def compare(cases, cycles, ends, references):
    """Compare all ends of a work with the reference's."""
    same, other, elsewhere = [], [], 0
    for case, end, reference in zip(cases, ends, references, strict=True):
        off = error(case, cycles, end, reference)
        if off > ELSEWHERE:
            elsewhere += 1
        else:
            (same if end[4] == reference[4] else other).append(off)
    return Comparison(
        len(cases),
        max(same, default=math.nan),
        len(other),
        max(other, default=0.0),
        elsewhere,
    )
