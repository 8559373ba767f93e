"""Datasets as files of results, and runs that are kept on disk."""

from __future__ import annotations

import contextlib
import os
import random
import signal
import tempfile
import threading
import time
import unittest
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import capsulemap
import xarray
from capsulemap import Axis, Draws, StudyError

from program import FIG5, SYSTEMS, TWO_MOTIONS, command_line


STOPS = int(os.environ.get("STOPS", "2"))
"""How often each study is stopped before it is resumed to its end."""


class InAFolder(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


class Saved(InAFolder):
    def assert_saved(self, dataset: xarray.Dataset, *commands: str) -> None:
        """Sure that a dataset becomes the file that the command line writes for its study, and is read back."""
        saved, own = self.folder / "saved.h5", self.folder / "own.h5"
        capsulemap.save(dataset, saved, overwrite=True)
        xarray.testing.assert_identical(capsulemap.open(saved), dataset)
        study = self.folder / "study.toml"
        study.write_text(str(dataset["study"].item()), encoding="utf-8")
        for command in commands or ("sweep",):
            done = command_line(command, str(study), "--output", str(own), "--overwrite")
            self.assertEqual(done.returncode, 0, done.stderr)
        xarray.testing.assert_identical(capsulemap.open(own), dataset)
        if "sweep" in (commands or ("sweep",)):
            done = command_line("verify", str(saved))
            self.assertEqual(done.returncode, 0, done.stderr)
        else:
            # Of cases the command line puts the variables into another order.
            self.assertEqual(saved.read_bytes(), own.read_bytes())

    def test_what_is_saved_is_the_file_of_the_command_line(self) -> None:
        both = ["upward", "downward"]
        axes = {"omega": Axis(60, 62, 3)}
        self.assert_saved(capsulemap.sweep(FIG5, axes, inherit="omega", directions=both))
        starts = {"start_r": Axis("-2 mm", "2 mm", 4), "start_y1": Axis(-0.2, 0.2, 4)}
        self.assert_saved(capsulemap.basin(TWO_MOTIONS.replace(omega=155), starts))
        ranges = {"omega": Axis(60, 90), "p_d": Axis("2 N", "4 N")}
        self.assert_saved(capsulemap.sweep(FIG5, ranges, draws=Draws(5, seed=3)))
        wall = capsulemap.Oscillator.from_toml(SYSTEMS / "impact.toml")
        self.assert_saved(capsulemap.sweep(wall, {"start_phase": [0.0, 1.0]}))
        branch = capsulemap.branch(TWO_MOTIONS.replace(omega=140), "omega", (138, 141), start={"y1": 0.3})
        self.assert_saved(branch, "continue")

    def test_what_is_read_by_another_library_is_saved(self) -> None:
        saved, again = self.folder / "saved.h5", self.folder / "again.h5"
        capsulemap.save(capsulemap.sweep(FIG5, {"omega": Axis(60, 62, 3)}), saved)
        with xarray.open_dataset(saved, engine="h5netcdf") as file:
            capsulemap.save(file.load(), again)
        self.assertEqual(saved.read_bytes(), again.read_bytes())

    def test_no_part_is_taken_for_the_whole(self) -> None:
        dataset = capsulemap.sweep(FIG5, {"omega": Axis(60, 62, 3)})
        path = self.folder / "part.h5"
        with self.assertRaisesRegex(StudyError, "1 of the 3 values along `omega`"):
            capsulemap.save(dataset.isel(omega=[1]), path)
        with self.assertRaisesRegex(StudyError, "no variable `study`"):
            capsulemap.save(dataset.drop_vars("study"), path)
        self.assertFalse(path.exists())

    def test_nothing_is_replaced_unasked(self) -> None:
        dataset = capsulemap.sweep(FIG5, {"omega": [60.0]})
        path = self.folder / "there.h5"
        path.write_text("mine")
        with self.assertRaisesRegex(StudyError, "is there already"):
            capsulemap.save(dataset, path)
        self.assertEqual(path.read_text(), "mine")
        with self.assertRaises(capsulemap.MachineError):
            capsulemap.save(dataset, self.folder / "nowhere" / "a.h5")

    def test_variables_of_ones_own_are_kept(self) -> None:
        dataset = capsulemap.sweep(FIG5, {"omega": Axis(60, 62, 3)})
        speed = dataset.progression_speed
        dataset["mm_per_s"] = (speed.dims, 1e3 * speed.values, {"units": "mm/s", "long_name": "speed"})
        path = self.folder / "own.h5"
        capsulemap.save(dataset, path)
        xarray.testing.assert_equal(capsulemap.open(path), dataset)


class Kept(InAFolder):
    axes = {"omega": Axis(20, 120, 300), "p_d": Axis(1, 6, 100)}

    def test_a_kept_run_is_interrupted_and_resumed(self) -> None:
        path = self.folder / "kept.h5"
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
        timer.start()
        try:
            with warnings.catch_warnings(record=True) as warned:
                warnings.simplefilter("always")
                try:
                    part = capsulemap.sweep(FIG5, self.axes, keep=path)
                except KeyboardInterrupt:
                    # No block was whole.
                    part = None
        finally:
            timer.join()
            signal.signal(signal.SIGINT, before)
        if part is not None and warned:
            self.assertGreater(int((part.outcome < 0).sum()), 0)
            self.assertFalse(path.exists())
        whole = capsulemap.sweep(FIG5, self.axes, keep=path)
        xarray.testing.assert_identical(whole, capsulemap.open(path))
        xarray.testing.assert_equal(whole, capsulemap.sweep(FIG5, self.axes))
        self.assertEqual(os.listdir(self.folder), ["kept.h5"])

    def test_what_was_stopped_anywhere_is_resumed_to_the_same_numbers(self) -> None:
        starts = {"start_r": Axis("-4 mm", "4 mm", 200), "start_y1": Axis(-0.4, 0.4, 200)}
        plane = {"omega": Axis(130, 170, 130), "p_d": Axis(2, 3, 130)}
        line = {"omega": Axis(130, 170, 1500), "p_d": Axis(2, 3, 3)}
        asked: list[Callable[..., Any]] = [
            lambda **how: capsulemap.basin(TWO_MOTIONS.replace(omega=155), starts, refine=True, **how),
            lambda **how: capsulemap.sweep(TWO_MOTIONS, plane, refine={"progression_speed": 1e-3}, **how),
            lambda **how: capsulemap.sweep(TWO_MOTIONS, line, inherit="omega", directions=["upward"], **how),
        ]
        numbers = random.Random(STOPS)
        for number, ask in enumerate(asked):
            begun = time.monotonic()
            whole = ask()
            taken = time.monotonic() - begun
            path = self.folder / f"stopped-{number}.h5"
            stopped = 0
            for _ in range(STOPS):
                job = ask(keep=path, blocking=False)
                time.sleep(numbers.uniform(0, taken / 3))
                # What is done by then may be no whole block.
                with contextlib.suppress(StudyError):
                    job.cancel()
                stopped += job.status().state == "cancelled"
            self.assertGreater(stopped, 0)
            resumed = ask(keep=path)
            created = resumed.attrs.pop("created"), whole.attrs.pop("created")
            self.assertEqual(len(created), 2)
            xarray.testing.assert_identical(resumed, whole)

    def test_results_that_are_there_are_read(self) -> None:
        path = self.folder / "kept.h5"
        axes = {"omega": Axis(60, 62, 3)}
        first = capsulemap.sweep(FIG5, axes, keep=path, blocking=False)
        dataset = first.wait()
        self.assertEqual(first.status(), ("done", 3, 3))
        written = path.stat().st_mtime_ns
        xarray.testing.assert_identical(capsulemap.sweep(FIG5, axes, keep=path), dataset)
        self.assertEqual(path.stat().st_mtime_ns, written)
        with self.assertRaises(StudyError):
            capsulemap.sweep(FIG5, {"omega": [61.0]}, keep=path)
        other = capsulemap.sweep(FIG5, {"omega": [61.0]}, keep=path, overwrite=True)
        xarray.testing.assert_identical(capsulemap.open(path), other)

    def test_a_kept_study_has_its_branches(self) -> None:
        path = self.folder / "kept.h5"
        branch = '[[branches]]\nname = "a"\nalong = "omega"\nfrom = "54 rad/s"\nto = "56 rad/s"\n'
        study = capsulemap.Study.from_toml(FIG5.replace(omega=55).to_toml() + branch)
        xarray.testing.assert_equal(study.run(keep=path), study.run())
        self.assertIn("branch_point", capsulemap.open(path).sizes)


class Remarks(unittest.TestCase):
    def test_what_has_no_effect_is_warned_of_where_it_was_asked(self) -> None:
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            capsulemap.sweep(FIG5.replace(duty=0.3), {"omega": [60.0]})
            capsulemap.orbit(FIG5.replace(duty=0.3, omega=60))
        told = [it for it in warned if it.category is capsulemap.StudyWarning]
        self.assertEqual(len(told), 2)
        for it in told:
            self.assertIn("duty has no effect", str(it.message))
            self.assertEqual(it.filename, __file__)


if __name__ == "__main__":
    unittest.main()
