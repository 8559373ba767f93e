"""Computations that are interrupted, run in the background, beside each other, or in a child process."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import statistics
import subprocess
import sys
import threading
import time
import unittest
import warnings

import capsulemap
import numpy
import xarray
from capsulemap import Axis

from program import FIG5, environment

TRIES = int(os.environ.get("TRIES", "5"))
"""How often a sweep is interrupted."""

MILLION = {"omega": Axis(20, 120, 1000), "p_d": Axis(1, 6, 1000)}

INTERRUPTED = """
import signal, sys, time, warnings
signal.signal(signal.SIGINT, signal.default_int_handler)
import capsulemap, numpy, xarray
from capsulemap import Axis
print("begins", flush=True)
with warnings.catch_warnings(record=True) as warned:
    warnings.simplefilter("always")
    dataset = capsulemap.sweep(
        capsulemap.Capsule(k2="2.42 kN/m", delta=3.5e-3),
        {"omega": Axis(20, 120, 1000), "p_d": Axis(1, 6, 1000)},
    )
print("returned", time.monotonic(), flush=True)
assert [it.category for it in warned] == [capsulemap.PartialResultWarning], warned
names = dataset.outcome.attrs["flag_meanings"].split()
assert names[0] == "missing" and dataset.outcome.attrs["flag_values"][0] == -1
done = numpy.argwhere(dataset.outcome.values >= 0)
assert 0 < len(done) < 1_000_000, len(done)
assert str(len(done)) in str(warned[0].message), (len(done), warned[0].message)
nothing = dataset.outcome.values < 0
assert numpy.isnan(dataset.progression_speed.values[nothing]).all()
for omega, p_d in done[:: max(1, len(done) // 5)]:
    case = dataset[["outcome", "period", "progression_speed", "multiplier_real"]].isel(omega=omega, p_d=p_d)
    capsule = capsulemap.Capsule(k2="2.42 kN/m", delta=3.5e-3)
    again = capsulemap.sweep(capsule, {"omega": [float(case.omega)], "p_d": [float(case.p_d)]})
    for name in case.data_vars:
        assert numpy.array_equal(case[name], again[name].values[0, 0], equal_nan=True), name
print("right", flush=True)
import os
threads = len(os.listdir("/proc/self/task")) if os.path.isdir("/proc/self/task") else 1
print("threads", threads, flush=True)
"""


class Interrupts(unittest.TestCase):
    def test_ctrl_c_returns_what_is_done(self) -> None:
        delays = []
        for attempt in range(TRIES):
            with subprocess.Popen(
                [sys.executable, "-c", INTERRUPTED],
                env={**environment(), "OPENBLAS_NUM_THREADS": "1"},
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            ) as process:
                assert process.stdout is not None and process.stderr is not None
                self.assertEqual(process.stdout.readline(), "begins\n")
                time.sleep(1.0 + 0.13 * attempt)
                asked = time.monotonic()
                process.send_signal(signal.SIGINT)
                told = process.stdout.readline().split()
                rest = process.stdout.read()
                faults = process.stderr.read()
            self.assertEqual(process.returncode, 0, faults)
            self.assertEqual(told[0], "returned", faults)
            delays.append(float(told[1]) - asked)
            self.assertIn("right", rest, faults)
            # Nothing is left running.
            self.assertIn("threads 1\n", rest)
        # A machine may be busy: how soon it is, is told; that it is not at the end of the sweep, is asked for.
        print(f"control came back after {[round(1e3 * it) for it in delays]} ms", file=sys.stderr)
        self.assertLess(statistics.median(delays), 5)

    def test_ctrl_c_ends_one_motion(self) -> None:
        timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
        timer.start()
        begun = time.monotonic()
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                capsulemap.simulate(FIG5.replace(omega=77.91), cycles=10_000_000)
        finally:
            signal.signal(signal.SIGINT, before)
            timer.join()
        self.assertLess(time.monotonic() - begun, 30)


class Progress(unittest.TestCase):
    def test_a_long_sweep_shows_how_far_it_is(self) -> None:
        said = io.StringIO()
        capsulemap.set_progress(True)
        self.addCleanup(capsulemap.set_progress, None)
        with contextlib.redirect_stderr(said):
            capsulemap.sweep(FIG5, {"omega": Axis(20, 120, 400), "p_d": Axis(1, 6, 150)})
        shown = said.getvalue().split("\r")
        self.assertRegex("".join(shown), "[0-9]+ of 60000 cases, [0-9]+ s, about [0-9]+ s left")
        # Nothing of it stays on the line.
        self.assertEqual(shown[-1], "")
        self.assertEqual(shown[-2].strip(), "")

    def test_nothing_is_shown_unasked(self) -> None:
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            capsulemap.sweep(FIG5, {"omega": Axis(20, 120, 400), "p_d": Axis(1, 6, 60)})
        self.assertEqual(said.getvalue(), "")


class Background(unittest.TestCase):
    def test_a_job_is_waited_for(self) -> None:
        axes = {"omega": Axis(60, 90, 5)}
        job = capsulemap.sweep(FIG5, axes, blocking=False)
        dataset = job.wait(60)
        self.assertEqual(job.status(), ("done", 5, 5))
        xarray.testing.assert_equal(dataset, capsulemap.sweep(FIG5, axes))
        self.assertIs(job.wait(), dataset)
        self.assertIs(job.partial(), dataset)

    def test_a_job_is_looked_at_and_cancelled(self) -> None:
        job = capsulemap.sweep(FIG5, MILLION, blocking=False)
        with self.assertRaises(TimeoutError):
            job.wait(0.5)
        status = job.status()
        self.assertEqual((status.state, status.cases), ("running", 1_000_000))
        first = job.partial()
        done = int((first.outcome >= 0).sum())
        self.assertGreaterEqual(done, status.done)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            last = job.cancel()
        self.assertEqual(job.status().state, "cancelled")
        self.assertGreaterEqual(int((last.outcome >= 0).sum()), done)
        self.assertNotIn("attractor", last)
        # What was looked at does not change.
        self.assertEqual(int((first.progression_speed.notnull()).sum()), done)
        self.assertEqual(int((job.wait().outcome >= 0).sum()), int((last.outcome >= 0).sum()))

    def test_a_job_of_cases_and_branches(self) -> None:
        branch = '[[branches]]\nname = "a"\nalong = "omega"\nfrom = "54 rad/s"\nto = "56 rad/s"\n'
        study = capsulemap.Study.from_toml(FIG5.replace(omega=55).to_toml() + branch)
        dataset = study.run(blocking=False).wait()
        self.assertIn("branch_point", dataset.sizes)
        self.assertIn("outcome", dataset)

    @unittest.skipUnless(os.path.isdir("/proc/self/task"), "threads are counted on Linux alone")
    def test_a_job_that_nobody_holds_ends(self) -> None:
        before = len(os.listdir("/proc/self/task"))
        job = capsulemap.sweep(FIG5, MILLION, blocking=False)
        time.sleep(0.3)
        self.assertGreater(len(os.listdir("/proc/self/task")), before)
        del job
        limit = time.monotonic() + 10
        while len(os.listdir("/proc/self/task")) > before and time.monotonic() < limit:
            time.sleep(0.02)
        self.assertEqual(len(os.listdir("/proc/self/task")), before)

    def test_eight_threads_at_once(self) -> None:
        results: dict[int, xarray.Dataset] = {}

        def run(number: int) -> None:
            results[number] = capsulemap.sweep(FIG5, {"omega": [60.0 + number, 70.0, 80.0]})

        threads = [threading.Thread(target=run, args=(number,)) for number in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(sorted(results), list(range(8)))
        for number, dataset in results.items():
            numpy.testing.assert_array_equal(dataset.omega, [60.0 + number, 70.0, 80.0])
            same = dataset.progression_speed.values[1:]
            numpy.testing.assert_array_equal(same, results[0].progression_speed.values[1:])

    def test_the_interpreter_runs_on_meanwhile(self) -> None:
        job = capsulemap.sweep(FIG5, MILLION, blocking=False)
        waiting = threading.Thread(target=job.wait)
        waiting.start()
        begun, count = time.monotonic(), 0
        while time.monotonic() - begun < 0.3:
            count += 1
        self.assertGreater(count, 1000)
        job.cancel()
        waiting.join()

    @unittest.skipUnless(hasattr(os, "fork"), "there is no fork here")
    def test_a_child_process_computes_after_its_parent_did(self) -> None:
        before = capsulemap.sweep(FIG5, {"omega": [70.0]})
        job = capsulemap.sweep(FIG5, MILLION, blocking=False)
        with warnings.catch_warnings():
            # That a process with threads is forked is what is tried.
            warnings.simplefilter("ignore")
            child = os.fork()
        if child == 0:
            try:
                again = capsulemap.sweep(FIG5, {"omega": [70.0]})
                same = float(again.progression_speed[0]) == float(before.progression_speed[0])
                try:
                    job.wait()
                except capsulemap.StudyError:
                    os._exit(0 if same else 3)
                os._exit(4)
            finally:
                os._exit(5)
        job.cancel()
        ended, status = wait_for(child, 60)
        self.assertTrue(ended, "the child hangs")
        self.assertEqual(os.waitstatus_to_exitcode(status), 0)


def wait_for(child: int, seconds: float) -> tuple[bool, int]:
    """Whether a child has ended within so many seconds, and how."""
    limit = time.monotonic() + seconds
    while time.monotonic() < limit:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return True, status
        time.sleep(0.05)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return False, 0


if __name__ == "__main__":
    unittest.main()
