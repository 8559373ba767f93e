"""Computations in the background."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from . import _capsulemap, _results
from ._errors import PartialResultWarning, StudyError, warn
from ._progress import Progress

if TYPE_CHECKING:
    import xarray


class Status(NamedTuple):
    """How far a computation is."""

    state: str
    """"running", "done", "cancelled" or "failed"."""
    done: int
    """Cases that are done."""
    cases: int
    """Cases of the study; where boundaries alone are computed fewer are needed."""


class Job:
    """A study that is computed in the background. Its threads end with it, when it is cancelled, or when no variable holds it any more."""

    def __init__(self, job: _capsulemap.Job) -> None:
        self._job = job
        self._dataset: xarray.Dataset | None = None
        self._error: Exception | None = None
        self._cancelled = False

    def wait(self, seconds: float | None = None) -> xarray.Dataset:
        """The results, once they are there.

        Raises TimeoutError where they are not within so many seconds, StudyError or MachineError where the computation failed. Of a
        job that was cancelled it is what was done. Ctrl-C ends the waiting, not the job.
        """
        if not self._job_has_ended(seconds):
            raise TimeoutError(f"not done within {seconds} s: {self.status()}")
        self._take()
        if self._error is not None:
            raise self._error
        return self.partial() if self._dataset is None else self._dataset

    def status(self) -> Status:
        """How far it is."""
        done, cases = self._job.progress()
        if not self._has_result() and self._job.is_running():
            return Status("running", done, cases)
        self._take()
        if self._error is not None:
            return Status("failed", done, cases)
        return Status("cancelled" if self._dataset is None else "done", done, cases)

    def partial(self) -> xarray.Dataset:
        """What is done by now: cases not yet done have the outcome "missing", and NaN or 0 in place of numbers.

        Attractors, and what is inferred where boundaries alone are computed, come at the end, and are not in it before; of a run that
        is kept in a file it is what its blocks hold. Raises StudyError where such a run has no block yet.
        """
        if not self._has_result() and not self._job.is_running():
            self._take()
        if self._dataset is not None:
            return self._dataset
        done = self._job.partial()
        return _results.dataset(done) if isinstance(done, dict) else _results.partial(done)

    def cancel(self) -> xarray.Dataset:
        """Ends the computation and returns what is done."""
        self._job.cancel()
        self._job.wait(1.0)
        return self.partial()

    def _has_result(self) -> bool:
        return self._dataset is not None or self._error is not None or self._cancelled

    def _job_has_ended(self, seconds: float | None) -> bool:
        return self._has_result() or self._job.wait(seconds)

    def _take(self) -> None:
        """Takes the result of a job that has ended."""
        if self._has_result():
            return
        try:
            raw = self._job.result()
        except Exception as error:
            self._error = error
            return
        self._cancelled = raw is None
        self._dataset = None if raw is None else _results.dataset(raw)

    def __repr__(self) -> str:
        return f"<Job {self.status()}>"


def waited(job: Job, *, has_cases: bool) -> xarray.Dataset:
    """The results of a job, whose progress is shown; after Ctrl-C what is done, with a warning, where that is something."""
    progress = Progress()
    try:
        while not job._job.wait(progress.interval):
            progress.show(*job._job.progress())
        progress.end()
        return job.wait()
    except KeyboardInterrupt:
        job._job.cancel()
        progress.end()
        if not has_cases:
            raise
        return _interrupted(job)


def _interrupted(job: Job) -> xarray.Dataset:
    """What is done of a job that was interrupted."""
    _, cases = job._job.progress()
    try:
        dataset = job.partial()
    except StudyError:
        # No block of a run that is kept is whole yet.
        raise KeyboardInterrupt("no block was whole, so that nothing is kept") from None
    done = int((dataset["outcome"] >= 0).sum())
    told = f"interrupted: {done} of {cases} cases are done, the others have the outcome \"missing\""
    warn(told, PartialResultWarning)
    return dataset
