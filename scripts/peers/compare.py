"""Runs capsulemap and its peers side by side on the same cases and prints speeds and errors."""

import json
import statistics
import subprocess
import sys
from dataclasses import dataclass, field

from cases import case_sets, sample
from errors import DEFINITION, Comparison, compare
from programs import HERE, bench, python
from setting import setting

REPETITIONS = 3
COLUMNS = (
    "contestant",
    "cycles per CPU second",
    "min .. max",
    "ratio",
    "error of section",
    "error of x2",
    "cases apart",
)


@dataclass
class Contestant:
    """A program that answers requests, and its results on each set of cases."""

    name: str
    command: list[str]
    # The tolerance that it is asked for; the step [s] where that is fixed.
    tolerance: float
    # Does only a few of the cases, once.
    slow: bool = False
    speeds: dict[str, list[float]] = field(default_factory=dict)
    ends: dict[str, list] = field(default_factory=dict)
    process: subprocess.Popen | None = None

    def start(self):
        """Start the program, which then waits for requests."""
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            self.command, stdin=pipe, stdout=pipe, text=True
        )

    def stop(self):
        """End the program by ending its input."""
        self.process.communicate()

    def chosen(self, cases):
        """Return the indices of the cases that it does."""
        return sample(cases) if self.slow else range(len(cases))

    def compute(self, set_name, cases, cycles, seconds):
        """Have it compute the cases of a set for some seconds; keep speed and ends."""
        cases = [cases[i] for i in self.chosen(cases)]
        least = 0.0 if self.slow else seconds
        lines = [f"{cycles} {self.tolerance!r} {least} {len(cases)}"]
        lines += [" ".join(map(repr, case)) for case in cases]
        self.process.stdin.write("\n".join(lines) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"peers: {self.name} ended without an answer on {set_name}")
        answer = json.loads(line)
        speed = answer["passes"] * len(cases) * cycles / answer["seconds"]
        self.speeds.setdefault(set_name, []).append(speed)
        self.ends[set_name] = answer["ends"]


CAPSULEMAP = bench("peers", "--requests")
SCALAR = [*CAPSULEMAP, "--scalar"]
RK4 = [str(HERE.parent.parent / "target/peers/rk4")]
BEST_PEER = Contestant("heyoka, batches of 8, 1e-12", python("heyoka_batch.py"), 1e-12)
CONTESTANTS = [
    Contestant("capsulemap, 1e-12", CAPSULEMAP, 1e-12),
    Contestant("capsulemap, one by one, 1e-12", SCALAR, 1e-12),
    BEST_PEER,
    Contestant("heyoka, scalar, 1e-12", python("heyoka_scalar.py"), 1e-12),
    Contestant("numba, Dormand-Prince 5(4), 1e-8", python("numba_dp5.py"), 1e-8),
    Contestant("C, Runge-Kutta 4, steps of 1e-4 s", RK4, 1e-4),
    Contestant("SciPy, DOP853, 1e-10", python("scipy_dop853.py"), 1e-10, slow=True),
]
# Two independent references, so that nobody judges itself.
HEYOKA = Contestant(
    "heyoka, scalar, compensated, 2e-16",
    python("heyoka_scalar.py", "--reference"),
    2.3e-16,
)
CAPSULEMAP_TIGHT = Contestant("capsulemap, 1e-15", SCALAR, 1e-15)


def judged(contestant, set_name, cases, cycles) -> Comparison:
    """Compare a contestant with the reference that is not its own."""
    judge = CAPSULEMAP_TIGHT if contestant.name.startswith("heyoka") else HEYOKA
    chosen = contestant.chosen(cases)
    references = [judge.ends[set_name][i] for i in chosen]
    return compare(
        [cases[i] for i in chosen], cycles, contestant.ends[set_name], references
    )


def report(cycles, set_name, cases):
    """Print the table of one set of cases."""
    agreement = judged(HEYOKA, set_name, cases, cycles)
    print(f"\n### {set_name}: {len(cases)} cases, {cycles} cycles each\n")
    print(
        f"The references agree to {agreement.section:.1e} in the section and to "
        f"{agreement.x2:.1e} in x2; cases apart: {agreement.apart()}.\n"
    )
    print("| " + " | ".join(COLUMNS) + " |")
    print("|---|" + "---:|" * 5 + "---|")
    best = statistics.median(BEST_PEER.speeds[set_name])
    for contestant in CONTESTANTS:
        speeds = contestant.speeds[set_name]
        speed = statistics.median(speeds)
        off = judged(contestant, set_name, cases, cycles)
        share = f", only {off.cases} of the cases" if contestant.slow else ""
        cells = [
            contestant.name + share,
            f"{speed:.0f}",
            f"{min(speeds):.0f} .. {max(speeds):.0f}",
            f"{speed / best:.3g}",
            f"{off.section:.1e}",
            f"{off.x2:.1e}",
            off.apart(),
        ]
        print("| " + " | ".join(cells) + " |")


def main():
    """Follow the references, then all contestants by turns, and print the tables."""
    short = "--short" in sys.argv
    cycles, cases = case_sets(short)
    everyone = [HEYOKA, CAPSULEMAP_TIGHT, *CONTESTANTS]
    for contestant in everyone:
        contestant.start()
    rounds = [[HEYOKA, CAPSULEMAP_TIGHT]] + [CONTESTANTS] * REPETITIONS
    for turn, contestants in enumerate(rounds):
        for set_name, its_cases in cases.items():
            stage = f"repetition {turn} of {REPETITIONS}" if turn else "references"
            print(f"{stage}: {set_name}", file=sys.stderr)
            for contestant in contestants:
                contestant.compute(set_name, its_cases, cycles, 0.2 if short else 1.0)
    for contestant in everyone:
        contestant.stop()
    print(setting())
    print(f"\n{DEFINITION}")
    print("heyoka is judged by capsulemap's reference, all others by heyoka's.")
    print("Speeds are medians of three.")
    print("Ratios are to heyoka in batches, the best of the peers.")
    print(
        "capsulemap stops at the end of every cycle; its peers go straight to the last."
    )
    for set_name, its_cases in cases.items():
        report(cycles, set_name, its_cases)


main()
