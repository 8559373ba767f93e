"""How far an end is from the reference's, and which cases reached another motion."""

import math
from dataclasses import dataclass

# The definition, as the report prints it.
DEFINITION = (
    "Errors are at the end of the last cycle. Of the section: the largest of |Δy1|, "
    "|Δy2| and ω|Δr| over the largest of |y1|, |y2| and ω|r| there, V. Of x2: |Δx2|, "
    "summed up over all n cycles, over the mean progression of one, |x2|/n, or over "
    "V/(1000 ω) if that is more. A case is apart if its number of events is another, "
    "or if its section is over 0.01 off: then it is elsewhere, on another motion."
)
ELSEWHERE = 0.01


def errors(case, cycles, end, reference):
    """Return the errors of section and x2; an end begins with r, y1, x2, y2."""
    omega = case[1]
    r, y1, x2, y2 = reference[:4]
    velocity = max(abs(y1), abs(y2), omega * abs(r))
    length = max(abs(x2) / cycles, velocity / (1000.0 * omega))
    dr, dy1, dx2, dy2 = (
        abs(a - b) for a, b in zip(end[:4], reference[:4], strict=True)
    )
    # A sum is not a number if a part is, which max would hide.
    if not math.isfinite(sum(end[:4])):
        return math.inf, math.inf
    return max(dy1, dy2, omega * dr) / velocity, dx2 / length


@dataclass
class Comparison:
    """The largest errors where the motion is the same, and what the other cases do."""

    cases: int
    section: float
    x2: float
    other_events: int
    elsewhere: int

    def apart(self):
        """Say which cases do not count in the largest errors."""
        parts = []
        if self.other_events:
            parts.append(f"{self.other_events} with other events")
        if self.elsewhere:
            parts.append(f"{self.elsewhere} elsewhere")
        return ", ".join(parts) or "none"


def compare(cases, cycles, ends, references):
    """Compare all ends of a set of cases with the reference's."""
    same, other_events, elsewhere = [], 0, 0
    for case, end, reference in zip(cases, ends, references, strict=True):
        off = errors(case, cycles, end, reference)
        if off[0] > ELSEWHERE:
            elsewhere += 1
        elif end[4] != reference[4]:
            other_events += 1
        else:
            same.append(off)
    section = max((off[0] for off in same), default=math.nan)
    x2 = max((off[1] for off in same), default=math.nan)
    return Comparison(len(cases), section, x2, other_events, elsewhere)
