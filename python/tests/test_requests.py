"""What is asked: systems that do not change, and every mistake told at once."""

from __future__ import annotations

import copy
import pickle
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path

import capsulemap
import numpy
import xarray
from capsulemap import Axis, Capsule, Oscillator, Study, StudyError

from program import FIG5, SYSTEMS, command_line


class Systems(unittest.TestCase):
    def test_a_capsule_does_not_change(self) -> None:
        with self.assertRaises(AttributeError):
            FIG5.omega = 3  # type: ignore[attr-defined]
        other = FIG5.replace(omega=70)
        self.assertEqual(dict(other.parameters), {**FIG5.parameters, "omega": 70})
        self.assertEqual(other.replace(omega=None), FIG5)
        self.assertEqual(hash(other), hash(FIG5.replace(omega="70.0 rad/s")))
        self.assertEqual(eval(repr(other)), other)

    def test_systems_are_copied_and_sent(self) -> None:
        for system in (FIG5, Oscillator.from_toml(SYSTEMS / "belt.toml", c=0.2)):
            self.assertEqual(copy.deepcopy(system), system)
            self.assertEqual(pickle.loads(pickle.dumps(system)), system)

    def test_texts_and_files_are_the_same(self) -> None:
        path = SYSTEMS / "belt.toml"
        text = Oscillator.from_toml(path.read_text(encoding="utf-8"))
        self.assertEqual(text, Oscillator.from_toml(str(path)))
        study = Study.from_toml(FIG5.replace(omega=70).to_toml())
        self.assertEqual(Study.from_toml(study.to_toml()), study)

    def test_a_quantity_of_another_package_is_its_text(self) -> None:
        class Kilonewton:
            magnitude, units = 2.42, "kN/m"

        capsule = FIG5.replace(k2=Kilonewton())
        self.assertEqual(capsule.to_toml(), FIG5.replace(k2="2.42 kN/m").to_toml())


class Mistakes(unittest.TestCase):
    def test_all_faults_are_told_at_once(self) -> None:
        with self.assertRaises(StudyError) as raised:
            capsulemap.sweep(Capsule(k2="4 N", p_d=-1), {"omega": [10, 20]})
        self.assertIsInstance(raised.exception, ValueError)
        keys = {fault.key for fault in raised.exception.faults}
        self.assertEqual(keys, {"parameters.k2", "parameters.p_d", "parameters.delta"})
        # A name that is unknown is told where it is given; what is missing may come as an axis.
        with self.assertRaises(StudyError) as raised:
            Capsule(k2="4 N", mu=0.3)
        self.assertEqual({fault.key for fault in raised.exception.faults}, {"parameters.k2", "parameters.mu"})
        self.assertTrue(all(fault.line is None for fault in raised.exception.faults))

    def test_arguments_of_another_kind_are_told_by_name(self) -> None:
        axes = {"omega": [60.0, 70.0]}
        wrong: list[tuple[str, Callable[[], object]]] = [
            ("start", lambda: capsulemap.orbit(FIG5.replace(omega=60), start="1 mm")),  # type: ignore[arg-type]
            ("protocol", lambda: capsulemap.sweep(FIG5, axes, protocol="fast")),  # type: ignore[call-overload]
            ("axes", lambda: capsulemap.sweep(FIG5, "omega")),  # type: ignore[call-overload]
            ("inherit", lambda: capsulemap.sweep(FIG5, axes, inherit=True)),  # type: ignore[call-overload]
            ("draws", lambda: capsulemap.sweep(FIG5, axes, draws="many")),  # type: ignore[call-overload]
            ("blocking", lambda: capsulemap.sweep(FIG5, axes, blocking="no")),  # type: ignore[call-overload]
            ("ends", lambda: capsulemap.branch(FIG5.replace(omega=60), "omega", 3)),  # type: ignore[arg-type]
            ("Capsule", lambda: capsulemap.fit({"t": []}, "capsule", {})),  # type: ignore[arg-type]
            ("vary", lambda: capsulemap.fit({"t": []}, FIG5.replace(omega=60), {"k2": "6 kN/m"})),  # type: ignore[dict-item]
            ("variable", lambda: capsulemap.names("outcome")),  # type: ignore[arg-type]
        ]
        for name, ask in wrong:
            with self.subTest(name), self.assertRaisesRegex(TypeError, name):
                ask()

    def test_axes_are_called_by_their_names(self) -> None:
        for axes, key in [
            ({"omega": [60.0], "k2": ["1 N", "2 N"]}, "axes['k2']"),
            ({"k2": ["1 kN/m", 2.0]}, "axes.k2"),
            ({"omega": Axis(60, 70)}, "axes['omega']"),
            ({"r": [1e-3]}, "axes['r']"),
        ]:
            with self.subTest(key=key), self.assertRaises(StudyError) as raised:
                capsulemap.sweep(FIG5.replace(omega=60), axes)
            self.assertIn(key, raised.exception.faults[0].key)
        with self.assertRaisesRegex(StudyError, "starts alone"):
            capsulemap.basin(FIG5.replace(omega=60), {"k2": [1e3, 2e3]})

    def test_one_text_is_one_name_and_labelled_arrays_have_units(self) -> None:
        both = [
            capsulemap.sweep(FIG5, {"omega": [60.0]}, outputs=it)  # type: ignore[call-overload]
            for it in ("power", ["power"])
        ]
        xarray.testing.assert_equal(*both)
        stiffness = xarray.DataArray(2.42, attrs={"units": "kN/m"})
        self.assertEqual(FIG5.replace(k2=stiffness).to_toml(), FIG5.replace(k2="2.42 kN/m").to_toml())
        frequencies = xarray.DataArray([10.0, 11.0], dims="omega", attrs={"units": "Hz"})
        found = capsulemap.sweep(FIG5, {"omega": frequencies}).omega
        numpy.testing.assert_allclose(found, 2 * numpy.pi * frequencies.values)
        self.assertEqual(capsulemap.simulate(FIG5.replace(omega=60), cycles=numpy.int64(2)).sizes["cycle"], 3)
        self.assertIn("power", FIG5.names["outputs"])

    def test_they_are_those_of_the_command_line(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "wrong.toml")
            path.write_text('[parameters]\nk2 = "4 N"\n[[axes]]\nname = "omeg"\npoints = 1\n')
            done = command_line("sweep", str(path), "--dry-run")
            self.assertEqual(done.returncode, 2)
            with self.assertRaises(StudyError) as raised:
                Study.from_toml(path)
        self.assertEqual(done.stderr.strip(), f"capsulemap: {raised.exception}")
        lines = done.stderr.strip().splitlines()[1:]
        self.assertEqual([line.strip() for line in lines], [str(it) for it in raised.exception.faults])
        again = pickle.loads(pickle.dumps(raised.exception))
        self.assertEqual((str(again), again.faults), (str(raised.exception), raised.exception.faults))

    def test_values_that_are_no_quantities(self) -> None:
        for wrong in ([1, 2], True, object(), b"3"):
            with self.subTest(wrong=wrong), self.assertRaises(StudyError):
                capsulemap.sweep(FIG5.replace(omega=wrong), {})
        with self.assertRaises(TypeError):
            capsulemap.sweep("capsule", {})  # type: ignore[arg-type]

    def test_unknown_models_outputs_and_choices(self) -> None:
        for capsule, outputs in (
            (FIG5.replace(omega=70, drive="triangle"), None),
            (FIG5.replace(omega=70), ["speed"]),
            (Capsule(model="capsul", omega=70), None),
        ):
            with self.assertRaises(StudyError) as raised:
                capsulemap.sweep(capsule, {}, outputs=outputs)
            self.assertIn("unknown", str(raised.exception))

    def test_systems_with_faults(self) -> None:
        with self.assertRaises(StudyError) as raised:
            Oscillator.from_toml('[system]\nname = "a"\nstates = { x = "m" }\n')
        self.assertTrue(raised.exception.faults)

    def test_files_that_are_not_there_or_none_of_the_program(self) -> None:
        with self.assertRaises((StudyError, capsulemap.MachineError)):
            capsulemap.open("nowhere.h5")
        with self.assertRaises(StudyError):
            Study.from_toml("nowhere.toml")
        with tempfile.NamedTemporaryFile(suffix=".h5") as file:
            file.write(b"no results")
            file.flush()
            with self.assertRaises((StudyError, capsulemap.MachineError)):
                capsulemap.open(file.name)

    def test_threads(self) -> None:
        for wrong in (0, -1):
            with self.assertRaises(StudyError):
                capsulemap.set_threads(wrong)
        one = sweep_on(1)
        self.assertTrue(one.identical(sweep_on(3)))
        capsulemap.set_threads(None)


def sweep_on(threads: int) -> xarray.Dataset:
    """A small sweep on so many threads."""
    capsulemap.set_threads(threads)
    return capsulemap.sweep(FIG5, {"omega": [60, 70, 80, 90]})


if __name__ == "__main__":
    unittest.main()
