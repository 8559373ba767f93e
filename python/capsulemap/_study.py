"""Studies: what to compute, as the command line's files say it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Literal, NamedTuple, Union, overload

from . import _capsulemap, _text
from ._errors import StudyWarning, warn
from ._job import Job, waited
from ._systems import is_path

if TYPE_CHECKING:
    import xarray

NAME = "the study"
"""What stands for the file of a study that has none, in messages."""

Keep = Union[str, "os.PathLike[str]", None]
"""The path of the file of results in which a run is kept; None for one in memory."""


class Study:
    """A checked study: what to compute, cases, branches, or both (docs/study/file.md)."""

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
        """What is taken where the study leaves it open, and what has no effect, in sentences; to run it warns of them."""
        return self._study.remarks

    @overload
    def run(
        self, *, keep: Keep = None, overwrite: bool = False, blocking: Literal[True] = True
    ) -> xarray.Dataset: ...

    @overload
    def run(
        self, *, keep: Keep = None, overwrite: bool = False, blocking: Literal[False]
    ) -> Job: ...

    @overload
    def run(
        self, *, keep: Keep = None, overwrite: bool = False, blocking: bool
    ) -> xarray.Dataset | Job: ...

    def run(
        self, *, keep: Keep = None, overwrite: bool = False, blocking: bool = True
    ) -> xarray.Dataset | Job:
        """Computes its cases, and its branches, ramps and boundaries where it asks for some: the dataset that its file holds.

        With ``keep`` the results go to the file at that path ("NAME.h5") as they come: what a run that was interrupted has done stays
        beside it, block by block, in a folder NAME.blocks, and the same call resumes it; ``overwrite`` replaces the results of another study there. Ctrl-C returns what is done,
        with a PartialResultWarning. With ``blocking=False`` it is computed in the background.
        """
        branches = self._study.has_more_than_cases
        kept = Kept(keep, overwrite)
        return run(self._study, cases=True, branches=branches, kept=kept, blocking=blocking)

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


class Kept(NamedTuple):
    """Where results are kept as they come."""

    path: Keep = None
    """The file; None where they are in memory alone."""
    overwrite: bool = False
    """Whether results of another study there are replaced."""


def run(
    study: _capsulemap.Study, *, cases: bool, branches: bool, blocking: bool, kept: Kept = Kept()
) -> xarray.Dataset | Job:
    """Computes what is wanted of a study."""
    tell(study)
    path = None if kept.path is None else os.path.abspath(kept.path)
    _text.truth("blocking", blocking)
    job = Job(study.begin(cases, branches, path, kept.overwrite))
    return waited(job, has_cases=cases) if blocking else job


def tell(study: _capsulemap.Study) -> None:
    """Warns of what was taken where a study leaves it open, and of what has no effect."""
    for remark in study.remarks:
        warn(remark, StudyWarning)
