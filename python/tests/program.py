"""What the tests share: systems, and results of the command line beside those of the package."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

# Files and datasets tell the same time, so that all of their attributes are equal.
os.environ["SOURCE_DATE_EPOCH"] = "1700000000"

import capsulemap
import xarray

ROOT = Path(__file__).resolve().parents[2]
SYSTEMS = ROOT / "systems"

FIG5 = capsulemap.Capsule(p_d=4, k2="2.42 kN/m", delta=3.5e-3)
"""The paper's Fig 5 without a frequency."""

TWO_MOTIONS = capsulemap.Capsule(
    m2="0.2 kg", c=1.77, mu_s=0.33, mu_d=0.165, p_d=2.79, k2="65.518 kN/m", delta="4.33 mm"
)
"""The capsule of studies/hysteresis.toml, which has two motions, without a frequency."""


def environment() -> dict[str, str]:
    """The environment of a process that is to find the package."""
    return {**os.environ, "PYTHONPATH": str(ROOT / "python")}


def command_line(*words: str) -> subprocess.CompletedProcess[str]:
    """Runs the command line of the package."""
    command = [sys.executable, "-m", "capsulemap", *words]
    return subprocess.run(command, env=environment(), capture_output=True, text=True, check=False)


class BesideTheCommandLine(unittest.TestCase):
    """Tests that hold datasets against the files of the command line."""

    def file_of(self, text: str, *commands: str) -> xarray.Dataset:
        """What a reader of HDF5 finds in the file of a study."""
        with tempfile.TemporaryDirectory() as folder:
            study, results = Path(folder, "study.toml"), Path(folder, "study.h5")
            study.write_text(text, encoding="utf-8")
            for command in commands:
                done = command_line(command, str(study), "--output", str(results))
                self.assertEqual(done.returncode, 0, done.stderr)
            with xarray.open_dataset(results, engine="h5netcdf") as file:
                read = file.load()
            xarray.testing.assert_identical(capsulemap.open(results), read)
            return read

    def assert_same_as_file(self, dataset: xarray.Dataset, *commands: str) -> None:
        """Sure that the command line writes the same to the bit for the study that a dataset keeps."""
        file = self.file_of(str(dataset["study"].item()), *(commands or ("sweep",)))
        xarray.testing.assert_identical(dataset, file)
        for name in file.variables:
            self.assertEqual(dataset[name].dtype, file[name].dtype, name)
            # NaN and signs of zero, too.
            self.assertEqual(dataset[name].values.tobytes(), file[name].values.tobytes(), name)
