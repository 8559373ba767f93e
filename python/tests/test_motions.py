"""One motion: from its start, and what it settles to."""

from __future__ import annotations

import json
import math
import unittest

import capsulemap
import numpy

from program import FIG5, SYSTEMS, command_line

CASE = ("--omega", "77.91 rad/s", "--p-d", "4 N", "--k2", "2.42 kN/m", "--delta", "3.5 mm")


class Motions(unittest.TestCase):
    def setUp(self) -> None:
        self.told = json.loads(command_line("simulate", *CASE, "--cycles", "7", "--json").stdout)

    def test_an_orbit_is_the_one_of_the_command_line(self) -> None:
        orbit = capsulemap.orbit(FIG5.replace(omega=77.91))
        told = self.told["orbit"]
        self.assertEqual((orbit.outcome, orbit.period), ("periodic", 1))
        self.assertEqual(orbit.certificate, told["certificate"])
        parts = [[it.real, it.imag] for it in orbit.multipliers]
        self.assertEqual(parts, told["multipliers"])
        for name, value in orbit.outputs.items():
            self.assertTrue(value == told[name] or told[name] is None and math.isnan(value), name)
        self.assertEqual(orbit.units["progression_speed"], "m/s")
        self.assertAlmostEqual(orbit.outputs["progression_speed"], 10.298005e-3, places=9)
        self.assertEqual(sorted(orbit.section), ["r", "y1", "y2"])
        self.assertIsNone(orbit.failure)

    def test_a_history_has_the_period_of_its_orbit(self) -> None:
        history = capsulemap.orbit(FIG5.replace(omega=77.91)).history(cycles=2, samples_per_cycle=50)
        r = history.history_r.values
        self.assertEqual(r.shape, (101,))
        numpy.testing.assert_allclose(r[:51], r[50:], atol=1e-12)
        self.assertEqual(history.history_r.attrs["units"], "m")

    def test_a_simulation_is_the_one_of_the_command_line(self) -> None:
        dataset = capsulemap.simulate(FIG5.replace(omega="77.91 rad/s"), cycles=7)
        self.assertEqual(dataset.sizes["cycle"], 8)
        keys = {"cycle": "n", "time": "t"}
        for name in ("cycle", "time", "r", "y1", "x2", "y2", "work_net", "impacts"):
            told = [sample[keys.get(name, name)] for sample in self.told["section"]]
            self.assertEqual(dataset[name].values.tolist(), told, name)
        self.assertEqual(dataset.work_net.attrs["units"], "J")
        kinds = dataset.event_kind.attrs["flag_meanings"].split()
        codes = dataset.event_kind.attrs["flag_values"].tolist()
        found = [kinds[codes.index(kind)] for kind in dataset.event_kind.values]
        self.assertEqual(found, [event["kind"] for event in self.told["events"]])
        times = [event["t"] for event in self.told["events"]]
        self.assertEqual(dataset.event_time.values.tolist(), times)

    def test_starts_have_units(self) -> None:
        capsule = FIG5.replace(omega=77.91)
        numbers = capsulemap.simulate(capsule, start={"r": -1e-3, "y1": 0.1, "phase": math.pi / 2})
        texts = capsulemap.simulate(capsule, start={"r": "-1 mm", "y1": "10 cm/s", "phase": "90 deg"})
        self.assertEqual(numbers.r.values[0], -1e-3)
        numpy.testing.assert_array_equal(numbers.r.values, texts.r.values)

    def test_an_oscillator_without_a_drive(self) -> None:
        belt = capsulemap.Oscillator.from_toml(SYSTEMS / "belt.toml")
        self.assertEqual(belt.name, "mass on a belt")
        orbit = capsulemap.orbit(belt, start={"x": 1})
        words = ("simulate", "--system", str(SYSTEMS / "belt.toml"), "--start", "x=1", "--json")
        told = json.loads(command_line(*words).stdout)["orbit"]
        self.assertEqual((orbit.outcome, orbit.period), (told["outcome"], told["period"]))
        with self.assertRaises(capsulemap.StudyError):
            orbit.history()


if __name__ == "__main__":
    unittest.main()
