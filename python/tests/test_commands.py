"""What is asked of commands in processes of their own: trade-offs, experiments, figures and the page."""

from __future__ import annotations

import json
import math
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.request
import warnings
from pathlib import Path
from typing import Any

import capsulemap
import numpy
from capsulemap import Axis, Draws, StudyError

from program import FIG5, SYSTEMS, TWO_MOTIONS, command_line, environment

RIG = FIG5.replace(omega="77.91 rad/s")
"""The case that is recorded."""


def told_by_command_line(*words: str) -> dict[str, Any]:
    """The JSON object that the command line prints."""
    done = command_line(*words, "--json")
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    told: dict[str, Any] = json.loads(done.stdout)
    return told


class Basins(unittest.TestCase):
    def test_measures_of_basins_are_those_of_the_command_line(self) -> None:
        starts = {"start_r": Axis("-6 mm", "6 mm", 16), "start_y1": Axis(-1.5, 1.5, 16)}
        basin = capsulemap.basin(TWO_MOTIONS.replace(omega=155), starts)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "basin.h5")
            capsulemap.save(basin, path)
            told = told_by_command_line(
                "inspect", str(path), "--settled-within=5,50", "--density=start_r=0,2 mm", "--density=start_y1=0.1,0.5"
            )
        density = {"start_r": (0, "2 mm"), "start_y1": (0.1, 0.5)}
        found = capsulemap.basin_measures(basin, settled_within=[5, 50], density=density)
        self.assertEqual(found, {name: told[name] for name in ("wada", "settling", "weighted")})
        self.assertFalse(found["wada"]["applicable"])
        self.assertEqual(basin.attractor_cycles_median.values.tolist(), [it["quantiles"][0] for it in found["settling"]["attractors"]])
        with self.assertRaisesRegex(StudyError, "start_q"):
            capsulemap.basin_measures(basin, density={"start_q": (0, 1)})

    def test_draws_may_have_a_normal_distribution(self) -> None:
        starts = {"start_y1": capsulemap.Normal("0.4 m/s", 0.5, stop="0.5 m/s")}
        with self.assertWarnsRegex(capsulemap.StudyWarning, "normal distribution of mean 0.4 m/s"):
            drawn = capsulemap.basin(TWO_MOTIONS.replace(omega=155), starts, draws=40)
        self.assertLessEqual(float(drawn.start_y1.max()), 0.5)
        self.assertIn("normal distribution of mean 0.4 m/s", drawn.attrs["study_remarks"])

    def test_where_motions_go_is_what_the_command_line_says(self) -> None:
        axes = {"omega": [157, 160, 165], "start_y1": Axis(-1.5, 1.5, 9)}
        along = capsulemap.sweep(TWO_MOTIONS, axes)
        found = capsulemap.tipping(along, step=("160 rad/s", 165), draws=20, ball=0.01)
        self.assertEqual([found["steps"][0][end] for end in ("from", "to")], [160.0, 165.0])
        for row in found["steps"][0]["attractors"]:
            # One motion is left, and all others fold.
            self.assertEqual(sum(it["count"] for it in row["orbit"]) + row["unknown"], 20)
class Sensitivities(unittest.TestCase):
    def test_the_answer_is_that_of_the_command_line(self) -> None:
        draws = Draws(base_samples=8, kind="saltelli")
        results = capsulemap.sweep(FIG5, {"omega": Axis(70, 80), "p_d": Axis(3, 4)}, draws=draws)
        self.assertEqual(results.sizes["draw"], 32)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "results.h5")
            capsulemap.save(results, path)
            expected = told_by_command_line("sensitivity", str(path), "--resamples=50")
            found = capsulemap.sensitivity(path, resamples=50)
        power = expected["outputs"]["power"]
        self.assertEqual(found["quantity"].values.tolist(), ["omega", "p_d"])
        self.assertEqual(set(found.output.values.tolist()), set(expected["outputs"]))
        of_power = found.sel(output="power")
        self.assertEqual(float(of_power.ST.sel(quantity="p_d")), power["quantities"]["p_d"]["ST"])
        self.assertEqual(float(of_power.S1_conf.sel(quantity="omega")), power["quantities"]["omega"]["S1_conf"])
        self.assertEqual(float(of_power.variance), power["variance"])
        some = capsulemap.sensitivity(results, ["power", "progression_speed"])
        self.assertEqual(some.output.values.tolist(), ["power", "progression_speed"])
        with self.assertRaises(StudyError) as raised:
            capsulemap.sensitivity(results, "period")
        self.assertEqual([fault.key for fault in raised.exception.faults], ["of"])


class TradeOffs(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.results = capsulemap.sweep(FIG5, {"omega": Axis(60, 90, 11), "p_d": Axis(2, 4, 3)})

    def test_the_answer_is_that_of_the_command_line(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "results.h5")
            capsulemap.save(self.results, path)
            words = ["--where=omega > 65", "--budget=300 mW", "--speed=0.004", "--top=2", "--margins"]
            words += ["--tolerances=k2 = 0.05", "--draws=20"]
            expected = told_by_command_line("tradeoff", str(path), *words)
            found = capsulemap.tradeoff(
                path,
                where="omega > 65",
                budget="300 mW",
                speed=4e-3,
                top=2,
                margins=True,
                tolerances={"k2": 0.05},
                draws=20,
            )
        self.assertEqual(found.told, expected)
        front = found.front
        self.assertEqual(front.sizes["point"], len(expected["front"]))
        for place, row in enumerate(expected["front"]):
            point = front.isel(point=place)
            self.assertEqual(float(point.power), row["power"])
            self.assertEqual(float(point.omega), row["parameters"]["omega"])
            self.assertEqual(str(point.outcome.item()), row["outcome"])
            slope = float(point.sensitivity.sel(parameter="k2"))
            self.assertEqual(slope, row["sensitivity"]["k2"])
        self.assertEqual(front.power.attrs["units"], "W")
        self.assertEqual(front.omega.attrs["units"], "rad/s")
        best = found.optima.sel(optimum="fastest_within_budget")
        self.assertLessEqual(float(best.power), 0.3)
        self.assertEqual(best.case.item(), expected["fastest_within_budget"]["case"])
        self.assertGreaterEqual(float(found.optima.sel(optimum="least_for_speed").progression_speed), 4e-3)
        self.assertIn("kept_under_tolerances", front)
        self.assertEqual(found.top.sizes["point"], 2)

    def test_a_refined_front_of_a_dataset(self) -> None:
        plain = capsulemap.tradeoff(self.results)
        refined = capsulemap.tradeoff(self.results, refine=True, starts=8)
        self.assertGreater(refined.front.sizes["point"], plain.front.sizes["point"])
        # The same question is answered from what was found, and drawn with it.
        begun = time.monotonic()
        again = capsulemap.tradeoff(refined, refine=True, starts=8)
        self.assertEqual(again.told["front"], refined.told["front"])
        print(f"the same trade-off again took {time.monotonic() - begun:.1f} s", file=sys.stderr)
        self.assertIn("motions on the front", repr(refined))
        both = [capsulemap.figure(it, "trade-off", of="power") for it in (refined, self.results)]
        self.assertNotEqual(*(Path(it._file("svg")).read_text(encoding="utf-8") for it in both))
        fastest = [float(it.optima.sel(optimum="fastest").progression_speed) for it in (plain, refined)]
        self.assertGreaterEqual(abs(fastest[1]), abs(fastest[0]))

    def test_a_budget_is_spent_to_its_end(self) -> None:
        spent = capsulemap.tradeoff(self.results, refine=True, starts=8, budget="300 mW")
        bounded = capsulemap.tradeoff(self.results, refine=True, starts=8, where="power < 300 mW")
        within = spent.optima.sel(optimum="fastest_within_budget")
        self.assertLessEqual(float(within.power), 0.3)
        self.assertGreater(float(within.power), 0.3 * (1 - 1e-6))
        best = float(bounded.optima.sel(optimum="fastest").progression_speed)
        self.assertGreater(float(within.progression_speed), best * (1 - 1e-6))
        none = capsulemap.tradeoff(self.results, budget="1 uW")
        self.assertTrue(math.isnan(float(none.optima.sel(optimum="fastest_within_budget").progression_speed)))
        self.assertIn("fastest_within_budget: there is no such motion", none.notes)
        nothing = capsulemap.tradeoff(self.results, where="power < 1 uW", budget="1 uW")
        self.assertEqual(nothing.front.sizes["point"], 0)
        self.assertIn("0 motions on the front", repr(nothing))
        with self.assertRaises(StudyError) as caught:
            capsulemap.tradeoff(self.results, gain="sped")
        self.assertEqual(caught.exception.faults[0].key, "gain")

    def test_all_faults_are_told_by_their_keys(self) -> None:
        with self.assertRaises(StudyError) as caught:
            capsulemap.tradeoff(self.results, budget="3 kg", tolerances={"omga": 0.1})
        self.assertEqual([it.key for it in caught.exception.faults], ["budget", "tolerances"])
        with self.assertRaises(StudyError) as caught:
            capsulemap.tradeoff(self.results, direction="sideways")
        fault = caught.exception.faults[0]
        self.assertEqual(fault.key, "direction")
        self.assertIn("either", fault.message)
        self.assertNotIn("\x1b", str(caught.exception))
        with self.assertRaisesRegex(StudyError, "k3: the study gives it no value"):
            capsulemap.tradeoff(self.results, tolerances={"k3": 0.1})
        with self.assertRaises((StudyError, capsulemap.MachineError)):
            capsulemap.tradeoff("nowhere.h5")

    def test_ctrl_c_ends_it(self) -> None:
        timer = threading.Timer(1.5, signal.raise_signal, [signal.SIGINT])
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        asked: list[float] = []
        timer.start()
        try:
            begun = time.monotonic()
            with self.assertRaises(KeyboardInterrupt):
                capsulemap.tradeoff(self.results, refine=True, starts=100_000)
            asked.append(time.monotonic() - begun - 1.5)
        finally:
            signal.signal(signal.SIGINT, before)
            timer.join()
        print(f"a command ended {1e3 * asked[0]:.0f} ms after Ctrl-C", file=sys.stderr)
        self.assertLess(asked[0], 10)


class Experiments(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.study = cls.folder / "study.toml"
        cls.study.write_text(RIG.to_toml(), encoding="utf-8")
        words = ["--output", str(cls.folder / "rig"), "--cycles", "12"]
        done = command_line("synthesize", str(cls.study), *words)
        assert done.returncode == 0, done.stderr

    def columns(self, name: str) -> dict[str, Any]:
        """The columns of a recording, in SI units, by their names without units."""
        path = self.folder / "rig" / name
        header = path.read_text(encoding="utf-8").splitlines()[0].split(",")
        numbers = numpy.loadtxt(path, delimiter=",", skiprows=1, ndmin=2).T
        return {it.split(" [")[0]: of for it, of in zip(header, numbers)}

    def test_a_fit_is_that_of_the_command_line(self) -> None:
        motion = self.folder / "rig" / "motion.csv"
        words = ["--study", str(self.study), "--vary=k2=1 kN/m..5 kN/m,mu_d=0.1..0.6", "--starts=2"]
        expected = told_by_command_line("fit", str(motion), *words)
        bounds = {"k2": (1000, "5 kN/m"), "mu_d": (0.1, 0.6)}
        table = self.columns("motion.csv")
        found = capsulemap.fit(table, RIG.replace(k2="2.42 kN/m"), bounds, starts=2)
        for row, own in zip(expected["fitted"], found.told["fitted"]):
            self.assertEqual(own, row)
        self.assertEqual(found.misfit, expected["misfit"])
        self.assertEqual(list(found.parameters.parameter.values), ["k2", "mu_d"])
        k2 = found.parameters.sel(parameter="k2")
        self.assertEqual(k2.unit.item(), "N/m")
        self.assertLess(abs(float(k2.value) - 2420), 5 * float(k2.standard_error))
        self.assertEqual(found.system, RIG.replace(**found.values))
        # A table in mm is the same record, to rounding.
        table["x2 [mm]"] = 1e3 * table.pop("x2")
        again = capsulemap.fit([table], [RIG], bounds, starts=2)
        self.assertTrue(math.isclose(again.values["k2"], found.values["k2"], rel_tol=1e-6))

    def test_a_comparison_has_a_figure(self) -> None:
        found = capsulemap.compare(self.columns("motion.csv"), RIG, explain=[{"k2": (1000, 5000)}])
        motion = self.folder / "rig" / "motion.csv"
        words = ["--explain=k2=1 kN/m..5 kN/m"]
        expected = told_by_command_line("compare", str(motion), str(self.study), *words)
        self.assertEqual(found.told, expected)
        self.assertEqual(list(found.errors.signal.values), ["x2", "r", "a1"])
        found.figure.save(self.folder / "comparison.pdf")
        self.assertEqual((self.folder / "comparison.pdf").read_bytes()[:5], b"%PDF-")
        with self.assertRaises(StudyError):
            found.figure.save(self.folder / "comparison.svg")

    def test_what_may_be_wrong_with_a_recording_is_warned_of(self) -> None:
        table = self.columns("motion.csv")
        wrong = {**table, "x2": 1e3 * table["x2"], "place": table["x2"]}
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            found = capsulemap.compare(wrong, RIG)
            capsulemap.fit({**table, "place": table["x2"]}, RIG, {"k2": (1000, 5000)}, starts=1)
        told = [str(it.message) for it in warned if it.category is capsulemap.StudyWarning]
        self.assertTrue(any("unit" in it for it in told), told)
        self.assertEqual(sum("left out: place" in it for it in told), 2, told)
        self.assertEqual(found.warnings, found.told["warnings"])

    def test_constants_are_those_of_the_command_line(self) -> None:
        words = ["--m1=0.11 kg", "--m2=0.53 kg"]
        expected = told_by_command_line("identify", str(self.folder / "rig"), *words)
        tests = ["free_vibration", "static_force", "pull", "coasting", "motor"]
        tables = {it: self.columns(f"{it.replace('_', '-')}.csv") for it in tests}
        found = capsulemap.identify(**tables, m1=0.11, m2="0.53 kg")
        own, of_command = found.told["identified"], expected["identified"]
        for both in zip(own, of_command):
            self.assertEqual(*({**it, "recording": ""} for it in both))
        self.assertLess(abs(found.values["k1"] - 1420), 30)
        capsule = RIG.replace(**{name: it for name, it in found.values.items() if name != "motor_constant"})
        self.assertEqual(capsulemap.orbit(capsule).outcome, "periodic")

    def test_an_oscillator_of_ones_own_is_fitted(self) -> None:
        duffing = capsulemap.Oscillator.from_toml(SYSTEMS / "duffing.toml", w=1)
        made = duffing.replace(c=0.1, p=0.25)
        history = capsulemap.orbit(made, start={"x": 0.5}).history(cycles=5, samples_per_cycle=40, start="start")
        times = 2 * math.pi * history.history_time.values
        noise = 1e-4 * numpy.random.default_rng(1).standard_normal(len(times))
        table = {"t": times, "x": history.history_x.values + noise}
        found = capsulemap.fit(table, duffing, {"c": (0.01, 0.5), "p": (0.1, 0.5)}, start={"x": 0.4})
        for name, value in made.parameters.items():
            if name in found.values:
                error = float(found.parameters.standard_error.sel(parameter=name))
                self.assertLess(abs(found.values[name] - value), 5 * error)
        self.assertEqual(sorted(found.values), ["c", "p"])
        self.assertLess(abs(found.misfit - 1), 0.3)
        errors = capsulemap.compare(table, found.system).errors
        self.assertEqual(list(errors.signal.values), ["x"])
        with self.assertRaisesRegex(StudyError, "1 row of numbers"):
            capsulemap.fit({"t": [0.0], "x": [1.0]}, duffing, {"c": (0.01, 0.5)})

    def test_faults_name_the_recording_and_its_line(self) -> None:
        table = {**self.columns("motion.csv"), "x2": ["nothing"] * 1000}
        with self.assertRaises(ValueError):
            capsulemap.fit(table, RIG, {"k2": (1000, 5000)})
        table = self.columns("motion.csv")
        table["r"] = table["r"].astype(object)
        table["r"][4] = "much"
        with self.assertRaises(StudyError) as caught:
            capsulemap.fit(table, RIG, {"k2": (1000, 5000)})
        self.assertEqual([it.line for it in caught.exception.faults], [6])
        self.assertIn("recording.csv", str(caught.exception))


class Figures(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_figure_is_that_of_the_command_line(self) -> None:
        results = capsulemap.sweep(FIG5, {"omega": Axis(60, 90, 16), "p_d": Axis(2, 4, 4)})
        found = capsulemap.figure(results, "map", of="progression_speed", x="omega", title="$k_2$")
        path = self.folder / "results.h5"
        capsulemap.save(results, path)
        words = ["--kind=map", "--of=progression_speed", "--x=omega", "--title=$k_2$", "--name=figure"]
        done = command_line("figure", str(path), *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        for form in ("svg", "png", "pdf"):
            saved = self.folder / f"saved.{form}"
            found.save(saved)
            self.assertEqual(saved.read_bytes(), (self.folder / f"figure.{form}").read_bytes(), form)
        found.save(self.folder / "saved.csv")
        self.assertIn("omega", (self.folder / "saved.csv").read_text(encoding="utf-8"))
        shown, sizes = found._repr_mimebundle_()
        self.assertTrue(shown["image/png"].startswith("iVBORw0KGgo"))
        self.assertGreater(sizes["image/png"]["width"], 100)

    def test_a_figure_with_panels_limits_and_measured_points(self) -> None:
        results = capsulemap.sweep(FIG5, {"omega": Axis(60, 90, 16)})
        capsulemap.figure(
            results,
            "bifurcation",
            of=["section_r", "progression_speed"],
            limits={"progression_speed": (0, "20 mm/s")},
            unit={"omega": "Hz"},
            points={"omega": [70.0, 80.0], "progression_speed": [5e-3, 9e-3]},
            width="84 mm",
            legend=False,
        )

    def test_what_cannot_be_drawn_is_told_at_once(self) -> None:
        results = capsulemap.sweep(FIG5, {"omega": Axis(60, 90, 4)})
        with self.assertRaises(StudyError):
            capsulemap.figure(results, "basin")
        with self.assertRaisesRegex(StudyError, "possible values"):
            capsulemap.figure(results, "pie")
        with self.assertRaises(TypeError):
            capsulemap.figure(results.progression_speed, "map")  # type: ignore[arg-type]


class Pages(unittest.TestCase):
    def test_a_page_is_there_until_it_is_closed(self) -> None:
        results = capsulemap.sweep(TWO_MOTIONS, {"omega": Axis(140, 150, 4)})
        with capsulemap.explore(results, browser=False) as page:
            # The page knows its browser by a cookie.
            browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
            with browser.open(page.address, timeout=30) as answer:
                self.assertIn(b"capsulemap", answer.read())
            self.assertIn(page.address, page._repr_html_())
        self.assertFalse(page._command.is_running())
        with socket.create_server(("127.0.0.1", 0)) as taken, self.assertRaisesRegex(StudyError, "listened"):
            capsulemap.explore(results, port=taken.getsockname()[1], browser=False)

    @unittest.skipUnless(os.path.isdir("/proc/self/task"), "processes are looked for on Linux alone")
    def test_a_page_ends_with_its_process(self) -> None:
        code = (
            "import capsulemap as cm, os, signal\n"
            "runs = cm.sweep(cm.Capsule(omega=70, k2='2 kN/m', delta='3 mm'), {'p_d': [2.0, 3.0]})\n"
            "page = cm.explore(runs, browser=False)\n"
            "print(page._command._process.pid, flush=True)\n"
            "os.kill(os.getpid(), signal.SIGKILL)\n"
        )
        done = subprocess.run(
            [sys.executable, "-c", code], env=environment(), capture_output=True, text=True, check=False
        )
        page = Path("/proc", done.stdout.strip())
        limit = time.monotonic() + 20
        while is_alive(page) and time.monotonic() < limit:
            time.sleep(0.05)
        self.assertFalse(is_alive(page), done.stderr)


def is_alive(process: Path) -> bool:
    """Whether a process of Linux runs, and is not only waited for."""
    try:
        return (process / "stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


if __name__ == "__main__":
    unittest.main()
