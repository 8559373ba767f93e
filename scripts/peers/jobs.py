"""Compares whole jobs with those of peers: a basin, and a map of periods."""

import json
import math
import subprocess
import sys
from collections import Counter

from cases import GRID
from programs import bench, python
from setting import setting

TOLERANCE = 1e-8
MAP_TOLERANCE = 1e-12
# Cycles after which a case of the map is left without a period.
MOST_CYCLES = 500


def ask(command, request=None):
    """Run a program and return the object that it prints."""
    done = subprocess.run(
        command, input=request, stdout=subprocess.PIPE, text=True, check=False
    )
    if done.returncode != 0:
        sys.exit(f"peers: {' '.join(command)} failed")
    return json.loads(done.stdout.splitlines()[-1])


def matched(ours, theirs):
    """Return how many starts two partitions agree in, their sets paired greedily."""
    together = Counter(zip(ours, theirs, strict=True))
    taken_ours, taken_theirs, agreeing = set(), set(), 0
    for (a, b), count in together.most_common():
        if a not in taken_ours and b not in taken_theirs:
            taken_ours.add(a)
            taken_theirs.add(b)
            agreeing += count
    return agreeing


def row(*cells):
    """Print a row of a table."""
    print("| " + " | ".join(cells) + " |")


def basin(side):
    """Print the table of the basin."""
    numbers = [str(side), repr(TOLERANCE)]
    ours = ask(bench("duffing_basin", *numbers))
    theirs = ask(python("duffing_pynamicalsys.py", *numbers))
    starts = side * side
    print(f"\n### Duffing's basin: {starts} starts, tolerance {TOLERANCE:g}\n")
    row("contestant", "starts per CPU second", "ratio", "attractors", "starts without")
    row("---", "---:", "---:", "---:", "---:")
    speeds = [starts / it["seconds"] for it in (ours, theirs)]
    for name, it, speed in zip(
        ("capsulemap", "pynamicalsys"), (ours, theirs), speeds, strict=True
    ):
        labels = it["labels"]
        attractors = str(len(set(labels) - {-1}))
        without = str(labels.count(-1))
        row(name, f"{speed:.0f}", f"{speed / speeds[1]:.3g}", attractors, without)
    agreeing = matched(ours["labels"], theirs["labels"])
    print(f"\n{agreeing} of {starts} starts lead to the same attractor in both.")


def period_map(cases):
    """Print the table of the map of periods."""
    lines = [f"{MOST_CYCLES} {MAP_TOLERANCE!r} 0.0 {len(cases)}"]
    lines += [" ".join(map(repr, case)) for case in cases]
    request = "\n".join(lines) + "\n"
    ours = ask(bench("peers", "--requests", "--settle"), request)
    theirs = ask(python("heyoka_map.py"), request)
    print(
        f"\n### Map of periods: {len(cases)} cases of the grid from rest, at most "
        f"{MOST_CYCLES} cycles, tolerance {MAP_TOLERANCE:g}\n"
    )
    row("contestant", "cases per CPU second", "ratio", "periodic")
    row("---", "---:", "---:", "---:")
    speeds = [len(cases) / it["seconds"] for it in (ours, theirs)]
    names = ("capsulemap", "heyoka, batches of 8")
    for name, it, speed in zip(names, (ours, theirs), speeds, strict=True):
        periodic = str(sum(period > 0 for period, _ in it["ends"]))
        row(name, f"{speed:.0f}", f"{speed / speeds[1]:.3g}", periodic)
    both = [
        (a, b)
        for a, b in zip(ours["ends"], theirs["ends"], strict=True)
        if a[0] > 0 and b[0] > 0
    ]
    equal = [(a[1], b[1]) for a, b in both if a[0] == b[0]]
    twice = sum(b[0] == 2 * a[0] for a, b in both)
    fastest = max((abs(a) for a, _ in equal), default=math.nan)
    off = max((abs(a - b) for a, b in equal), default=math.nan)
    print(
        f"\nBoth find a period of {len(both)} cases: the same of {len(equal)}, whose "
        f"speeds agree to {off / fastest:.1e} of the fastest; heyoka's is twice the "
        f"other of {twice}, whose sections come close from two sides by turns."
    )


def main():
    """Run both jobs and print their tables."""
    short = "--short" in sys.argv
    print(setting("pynamicalsys"))
    print(
        "\nCPU seconds of one run each, without what is compiled before. capsulemap "
        "certifies each orbit by Newton's method; pynamicalsys clusters the means of "
        "samples after 100 cycles; heyoka's lanes are refilled, and a case is done when "
        "its section comes back to 1e-9 three cycles running."
    )
    basin(20 if short else 100)
    period_map(GRID[::13] if short else GRID)


main()
