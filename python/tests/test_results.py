"""Datasets are those of the command line's files: numbers to the bit, labels and attributes."""

from __future__ import annotations

import os
import random
import unittest
import warnings

import capsulemap
import numpy
import xarray
from capsulemap import Axis, Draws

from program import FIG5, SYSTEMS, TWO_MOTIONS, BesideTheCommandLine

STUDIES = int(os.environ.get("STUDIES", "6"))
"""How many random studies are compared."""


class Results(BesideTheCommandLine):
    def test_a_sweep_with_inherited_starts(self) -> None:
        dataset = capsulemap.sweep(
            FIG5,
            {"omega": numpy.linspace(60, 90, 7)},
            inherit="omega",
            directions=["upward", "downward"],
            protocol={"points": 3, "impact_points": 2},
        )
        self.assertEqual(dict(dataset.progression_speed.sizes), {"omega": 7, "direction": 2})
        self.assertEqual(dataset.progression_speed.attrs["units"], "m/s")
        self.assertGreater(float(dataset.progression_speed.sel(omega=75, direction="upward")), 0.005)
        self.assert_same_as_file(dataset)

    def test_a_sweep_with_histories_and_units_of_its_own(self) -> None:
        axes = {"k2": ["2 kN/m", "20 kN/m"], "omega": Axis("10 Hz", "12 Hz", 3, spacing="logarithmic")}
        dataset = capsulemap.sweep(
            capsulemap.Capsule(p_d="4 N", delta="1.5 mm"),
            axes,
            outputs=["progression_speed", "power"],
            history={"cycles": 2, "samples_per_cycle": 10},
            title="µ and \"quotes\"",
        )
        self.assertEqual(dataset.history_r.sizes["history_time"], 21)
        self.assertEqual(dataset.attrs["title"], "µ and \"quotes\"")
        self.assert_same_as_file(dataset)

    def test_outputs_of_its_own(self) -> None:
        own = {"speed_per_power": "progression_speed/power"}
        outputs = {"keep": ["progression_speed", "power", "speed_per_power"], "own": own}
        dataset = capsulemap.sweep(FIG5, {"omega": [70, 75]}, outputs=outputs)
        numpy.testing.assert_array_equal(dataset.speed_per_power, dataset.progression_speed / dataset.power)
        self.assertEqual(dataset.speed_per_power.attrs["units"], "m/J")
        self.assertEqual(dataset.speed_per_power.attrs["long_name"], own["speed_per_power"])
        self.assert_same_as_file(dataset)

    @unittest.skipUnless(hasattr(xarray, "DataTree"), "this xarray has no trees")
    def test_a_tree_has_all_of_a_dataset(self) -> None:
        system, axes = TWO_MOTIONS.replace(omega=155), {"start_r": Axis("-4 mm", "4 mm", 6)}
        both = [
            capsulemap.basin(system, {**axes, "start_y1": Axis(-0.4, 0.4, 6)}),
            capsulemap.branch(TWO_MOTIONS.replace(omega=140), "omega", (138, 160), start={"y1": 0.3}),
        ]
        for dataset in both:
            tree = capsulemap.tree(dataset)
            found = {name: it for node in tree.subtree for name, it in node.data_vars.items()}
            self.assertEqual(set(found), set(dataset.data_vars))
            for name, variable in found.items():
                numpy.testing.assert_array_equal(variable, dataset[name])
        self.assertEqual(tree["special_points"].sizes["special_point"], dataset.sizes["special_point"])
        self.assertEqual(dict(tree["branches"].attrs), {})

    def test_categories_have_names(self) -> None:
        dataset = capsulemap.sweep(FIG5, {"omega": Axis(60, 90, 3)})
        self.assertEqual(list(capsulemap.names(dataset.outcome).values), ["periodic"] * 3)
        self.assertEqual(capsulemap.names(dataset.certificate).dims, ("omega",))
        with self.assertRaisesRegex(ValueError, "no category"):
            capsulemap.names(dataset.period)

    def test_a_basin_with_its_attractors(self) -> None:
        axes = {"start_r": Axis("-4 mm", "4 mm", 12), "start_y1": Axis(-0.4, 0.4, 10)}
        dataset = capsulemap.basin(TWO_MOTIONS.replace(omega=155), axes)
        self.assertEqual(dataset.sizes["attractor_index"], 2)
        self.assertAlmostEqual(float(dataset.attractor_share.sum()), 1.0)
        self.assert_same_as_file(dataset)

    def test_a_refined_basin(self) -> None:
        axes = {"start_r": Axis("-4 mm", "4 mm", 130), "start_y1": Axis(-0.4, 0.4, 130)}
        dataset = capsulemap.basin(TWO_MOTIONS.replace(omega=155), axes, refine=True)
        self.assertLess(int((dataset.cycles > 0).sum()), dataset.cycles.size)
        self.assert_same_as_file(dataset)

    def test_a_refined_map(self) -> None:
        axes = {"omega": Axis(110, 180, 66), "p_d": Axis(2, 4, 64)}
        dataset = capsulemap.sweep(TWO_MOTIONS, axes, refine={"progression_speed": "30 mm/s"})
        self.assertIn("inferred", dataset.outcome.attrs["flag_meanings"])
        self.assert_same_as_file(dataset)

    def test_draws(self) -> None:
        drawn = {"omega": (110, 180), "p_d": Axis("2 N", "4 N")}
        for kind in ("uniform", "low-discrepancy"):
            dataset = capsulemap.sweep(TWO_MOTIONS, drawn, draws=Draws(12, seed=3, kind=kind))
            self.assertEqual(dict(dataset.omega.sizes), {"draw": 12})
            self.assert_same_as_file(dataset)

    def test_a_branch(self) -> None:
        dataset = capsulemap.branch(
            TWO_MOTIONS.replace(omega=140), "omega", (138, "150 rad/s"), start={"y1": 0.3}
        )
        self.assertGreater(dataset.sizes["branch_point"], 2)
        self.assert_same_as_file(dataset, "continue")

    def test_cases_and_branches_of_one_study(self) -> None:
        study = capsulemap.Study.from_toml(
            TWO_MOTIONS.to_toml()
            + """
[[axes]]
name = "omega"
values = ["140 rad/s", "155 rad/s", "160 rad/s"]
[[branches]]
name = "progression"
along = "omega"
at = { omega = "141 rad/s" }
start = { y1 = "0.3 m/s" }
from = "140 rad/s"
to = "143 rad/s"
"""
        )
        self.assertEqual(study.sizes, {"omega": 3})
        self.assert_same_as_file(study.run(), "sweep", "continue")

    def test_an_oscillator_given_as_text(self) -> None:
        belt = capsulemap.Oscillator.from_toml(SYSTEMS / "belt.toml", c=0.05)
        dataset = capsulemap.sweep(belt, {"belt": [1.0, 1.5]}, start={"x": 1.0})
        self.assertEqual(float(dataset.c), 0.05)
        self.assert_same_as_file(dataset)

    def test_one_case(self) -> None:
        self.assert_same_as_file(capsulemap.sweep(FIG5.replace(omega=77.91), {}))

    def test_the_family_of_capsules(self) -> None:
        capsule = FIG5.replace(drive="square", duty=0.3, k3="20 kN/m", delta_3="4 mm", omega=60)
        dataset = capsulemap.sweep(capsule, {"incline": numpy.array([0.0, 0.05])})
        self.assertEqual(dataset.attrs["drive"], "square")
        self.assert_same_as_file(dataset)

    def test_random_studies(self) -> None:
        # Some of what is drawn has no effect under the law that is drawn.
        warnings.simplefilter("ignore", capsulemap.StudyWarning)
        self.addCleanup(warnings.resetwarnings)
        random_numbers = random.Random(42)
        for number in range(STUDIES):
            with self.subTest(number=number):
                self.assert_same_as_file(*random_study(random_numbers))


def random_capsule(numbers: random.Random) -> capsulemap.Capsule:
    """A capsule that is drawn."""
    return capsulemap.Capsule(
        omega=numbers.uniform(20, 150),
        p_d=numbers.uniform(1, 6),
        k2=10 ** numbers.uniform(3, 5),
        delta=numbers.uniform(0.5e-3, 5e-3),
        resistance=numbers.choice(["coulomb-stribeck", "coulomb"]),
    )


def random_study(numbers: random.Random) -> tuple[xarray.Dataset, str]:
    """The results of a small study that is drawn, and the command for it."""
    capsule = random_capsule(numbers)
    protocol = {"max_cycles": 300, "exponent_cycles": 256, "points": numbers.randrange(4)}
    starts = {"start_r": Axis(-3e-3, 3e-3, 3), "start_y1": Axis(-0.3, 0.3, 3)}
    kind = numbers.choice(["inherited", "values", "draws", "basin", "map", "text", "branch"])
    if kind == "inherited":
        axes: dict[str, object] = {"omega": Axis(20, numbers.uniform(30, 160), numbers.randrange(2, 9))}
        directions = numbers.sample(["upward", "downward", "afresh"], 2)
        dataset = capsulemap.sweep(capsule, axes, inherit="omega", directions=directions, protocol=protocol)
    elif kind == "values":
        phases = sorted(numbers.uniform(0, 6) for _ in range(2))
        axes = {"p_d": [numbers.uniform(1, 6) for _ in range(3)], "start_phase": phases}
        dataset = capsulemap.sweep(capsule, axes, protocol=protocol)
    elif kind == "draws":
        axes = {"start_r": (-3e-3, 3e-3), "start_y1": (-0.3, 0.3)}
        draws = Draws(numbers.randrange(1, 20), seed=numbers.randrange(1000))
        dataset = capsulemap.basin(capsule, axes, draws=draws, protocol=protocol)
    elif kind == "basin":
        dataset = capsulemap.basin(capsule, starts, protocol=protocol)
    elif kind == "map":
        axes = {"omega": Axis(60, 90, 20), "p_d": Axis(1, numbers.uniform(2, 6), 20)}
        most = {"progression_speed": numbers.uniform(1e-4, 1e-2)}
        dataset = capsulemap.sweep(capsule, axes, refine=most, protocol=protocol)
    elif kind == "text":
        name = numbers.choice(["impact", "duffing", "two_stops"])
        system = capsulemap.Oscillator.from_toml(SYSTEMS / f"{name}.toml")
        own = numbers.choice(list(system._description()["parameters"]))
        values = [numbers.uniform(0.3, 0.9) for _ in range(2)]
        dataset = capsulemap.sweep(system, {own: values}, protocol=protocol)
    else:
        omega = float(str(capsule.parameters["omega"]))
        dataset = capsulemap.branch(capsule, "omega", (omega - 2, omega + 2), protocol=protocol)
    return dataset, "continue" if kind == "branch" else "sweep"


if __name__ == "__main__":
    unittest.main()
