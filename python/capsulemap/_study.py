"""Studies: what to compute, as the command line's files say it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Literal, overload

from . import _capsulemap
from ._job import Job, waited
from ._systems import is_path

if TYPE_CHECKING:
    import xarray

NAME = "the study"
"""What stands for the file of a study that has none, in messages."""


class Study:
    """A study that obeys all rules: cases, branches, or both (studies/README.md)."""

    def __init__(self, study: _capsulemap.Study) -> None:
        self._study = study

    @staticmethod
    def from_toml(source: str | os.PathLike[str]) -> Study:
        """The study in the file at a path, with what it names beside it, or in a text.

        A text has more than one line, or an equals sign. Raises StudyError with all faults at once.
        """
        if is_path(source):
            return Study(_capsulemap.Study.read(os.fspath(source)))
        return Study(_capsulemap.Study.parse(str(source), NAME))

    def to_toml(self) -> str:
        """Its text, which a file of the command line may hold and results keep."""
        return self._study.text

    @property
    def sizes(self) -> dict[str, int]:
        """Number of values along each dimension of its cases, slowest first."""
        return self._study.sizes

    @property
    def remarks(self) -> list[str]:
        """What was taken where the study leaves it open, and what has no effect, in sentences."""
        return self._study.remarks

    @overload
    def run(self, *, blocking: Literal[True] = True) -> xarray.Dataset: ...

    @overload
    def run(self, *, blocking: Literal[False]) -> Job: ...

    @overload
    def run(self, *, blocking: bool) -> xarray.Dataset | Job: ...

    def run(self, *, blocking: bool = True) -> xarray.Dataset | Job:
        """Computes its cases, and its branches where it has some, in memory: the dataset that its file would hold.

        Ctrl-C returns what is done, with a PartialResultWarning. With ``blocking=False`` it is computed in the background.
        """
        return run(self._study, cases=True, branches=self._study.branches > 0, blocking=blocking)

    def __repr__(self) -> str:
        sizes = ", ".join(f"{name}: {length}" for name, length in self.sizes.items())
        branches = f", {self._study.branches} branches" if self._study.branches else ""
        return f"<Study ({sizes}){branches}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Study) and self.to_toml() == other.to_toml()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return (Study.from_toml, (self.to_toml() + "\n",))


def run(
    study: _capsulemap.Study, *, cases: bool, branches: bool, blocking: bool
) -> xarray.Dataset | Job:
    """Computes what is wanted of a study."""
    job = Job(study.begin(cases, branches))
    return waited(job, has_cases=cases) if blocking else job
