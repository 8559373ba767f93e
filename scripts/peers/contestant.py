"""Answers requests from standard input, in the form that benches/peers.rs describes."""

import json
import sys
import time


def read(lines):
    """Return cycles, tolerance, seconds and cases of the next request, if any."""
    head = next(lines, None)
    if head is None:
        return None
    cycles, tolerance, seconds, count = head.split()
    cases = [tuple(map(float, next(lines).split())) for _ in range(int(count))]
    return int(cycles), float(tolerance), float(seconds), cases


def answer_requests(follow):
    """Answer all; `follow` returns (r, y1, x2, y2, events) of each case at its end."""
    lines = iter(sys.stdin)
    while request := read(lines):
        cycles, tolerance, seconds, cases = request
        # What is compiled at the first use is compiled before the clock starts.
        follow(cases[:1], 1, tolerance)
        start, passes, spent = time.process_time(), 0, 0.0
        while passes == 0 or spent < seconds:
            ends = follow(cases, cycles, tolerance)
            passes += 1
            spent = time.process_time() - start
        print(
            json.dumps({"seconds": spent, "passes": passes, "ends": ends}), flush=True
        )
