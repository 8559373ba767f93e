"""Results as files of the program, which all of its commands take."""

from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from typing import TYPE_CHECKING, Any, Union, cast

from . import _capsulemap
from ._errors import StudyError

if TYPE_CHECKING:
    import xarray

    from ._tradeoff import TradeOff

Results = Union["xarray.Dataset", str, "os.PathLike[str]", "TradeOff"]
"""A dataset of this package, the path of a file of results, or a trade-off, with what its searches have found."""


def save(
    results: xarray.Dataset, path: str | os.PathLike[str], *, overwrite: bool = False
) -> None:
    """Writes a whole dataset to a file of results, as the command line writes them ("NAME.h5").

    Variables of your own are kept; attributes of variables beside ``units``, ``long_name`` and the flags are not. Raises StudyError
    where cases or parts were taken away, or a file is there and not to be overwritten, and MachineError where it cannot be written.
    """
    if not hasattr(results, "data_vars"):
        raise TypeError(f"expected a Dataset, found {type(results).__name__}")
    check_free(path, overwrite)
    _capsulemap.write_results(os.fspath(path), _raw(results))


def check_free(path: str | os.PathLike[str], overwrite: bool) -> None:
    """Sure that nothing is replaced unasked."""
    if not overwrite and os.path.lexists(path):
        raise StudyError(f"{os.fspath(path)}: is there already; another path, or overwrite=True")


class Folder:
    """A folder for a while, which goes with this object."""

    def __init__(self) -> None:
        self.name = tempfile.mkdtemp(prefix="capsulemap-")
        self._end = weakref.finalize(self, shutil.rmtree, self.name, ignore_errors=True)


class Place:
    """A file of results, which is there as long as this object is."""

    def __init__(self, results: Results) -> None:
        self._folder: Folder | None = None
        self._other: Place | None = None
        self.path: str
        other = getattr(results, "place", None)
        if isinstance(other, Place):
            self._other, self.path = other, other.path
            return
        if isinstance(results, (str, os.PathLike)):
            self.path = os.path.abspath(results)
            return
        if not hasattr(results, "data_vars"):
            raise TypeError(f"expected a Dataset or a path, found {type(results).__name__}")
        self._folder = Folder()
        self.path = os.path.join(self._folder.name, "results.h5")
        save(cast("xarray.Dataset", results), self.path)


def _raw(results: xarray.Dataset) -> dict[str, Any]:
    """A dataset as a file has it: numbers for what is missing, and the types of numbers that it was read with."""
    import numpy
    from xarray import conventions

    encoded, _ = conventions.cf_encoder(results.variables, results.attrs)
    variables = {}
    for name, variable in encoded.items():
        values = numpy.asarray(variable.values)
        if values.dtype.kind in "OS":
            values = values.astype(str)
        # Arrays of numpy may lie in any order in memory.
        variables[name] = (variable.dims, numpy.ascontiguousarray(values).reshape(values.shape), variable.attrs)
    return {"variables": variables, "attributes": dict(results.attrs)}
