"""Results as labelled datasets: the variables, coordinates and attributes that a reader of the program's file has."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _capsulemap
from ._errors import StudyError

if TYPE_CHECKING:
    import numpy
    import xarray


def open(path: str | os.PathLike[str]) -> xarray.Dataset:  # noqa: A001
    """The results in a file of the program, all in memory.

    The same as ``xarray.open_dataset(path).load()``, without a library that reads HDF5 in Python, and with a check of the file's
    checksum. Raises StudyError where it is no file of results or not there, and MachineError where it cannot be read.
    """
    path = os.fsdecode(path)
    blocks = os.path.splitext(path)[0] + ".blocks"
    if not os.path.exists(path):
        told = "there is no such file"
        if os.path.isdir(blocks):
            told = f"is not whole yet: blocks of it are in {blocks}; the same call with keep= goes on"
        raise StudyError(f"{path}: {told}")
    return dataset(_capsulemap.read_results(path))


NODES = {
    "attractor_index": "attractors",
    "edge_index": "edges",
    "branch_request": "requests",
    "branch_index": "branches",
    "branch_point": "branch_points",
    "special_point": "special_points",
    "curve_index": "curves",
    "curve_point": "curve_points",
    "block": "blocks",
}
"""The nodes of a tree, by the dimension that their variables begin with."""


def tree(results: xarray.Dataset) -> xarray.DataTree:
    """Results as a tree: the cases and what is the same for all at the root, and a node for each table.

    The nodes are "attractors", "edges" (orbits on boundaries of basins), "branches", "branch_points", "special_points", "curves" and
    "curve_points", those that there are. Variables have the names that they have in the dataset. Needs xarray 2024.10 or later.
    """
    import xarray

    if not hasattr(results, "data_vars"):
        raise TypeError(f"expected a Dataset, found {type(results).__name__}")
    tables: dict[str, list[str]] = {}
    for name, variable in results.data_vars.items():
        first = str(variable.dims[0]) if variable.dims else ""
        tables.setdefault(NODES.get(first, "/"), []).append(str(name))
    nodes = {"/": results[tables.pop("/", [])]}
    constants = [name for name in results.coords if not results[name].dims]
    for node, own in sorted(tables.items()):
        nodes[node] = results[own].drop_vars(constants)
        # What is the same for all is told once.
        nodes[node].attrs = {}
    return xarray.DataTree.from_dict(nodes)


def names(category: xarray.DataArray) -> xarray.DataArray:
    """The names of a category, as ``outcome``, ``certificate`` or ``special_kind``, in place of its numbers.

    Raises ValueError where a variable is no category.
    """
    import numpy

    if not hasattr(category, "attrs") or not hasattr(category, "dims") or hasattr(category, "data_vars"):
        raise TypeError(f"expected a variable, as results.outcome, found {type(category).__name__}")
    own = category.attrs
    if "flag_values" not in own or "flag_meanings" not in own:
        raise ValueError(f"{category.name}: is no category, as it has no flag_meanings")
    codes, words = numpy.atleast_1d(own["flag_values"]), own["flag_meanings"].split(" ")
    named = dict(zip(codes.tolist(), words))
    values = numpy.array([named.get(code, "") for code in category.values.ravel().tolist()], dtype=object)
    named_all = category.copy(data=values.reshape(category.shape).astype(str))
    named_all.attrs = {"long_name": own.get("long_name", "")}
    return named_all


def dataset(raw: dict[str, Any]) -> xarray.Dataset:
    """What the library hands out as a dataset, in which missing numbers are NaN."""
    return _decoded(_variables(raw), raw["attributes"]).load()


def partial(done: _capsulemap.Partial) -> xarray.Dataset:
    """The cases that were done at a moment as a dataset whose numbers are put together as they are asked for."""
    import xarray
    from xarray.core import indexing

    raw = done.frame()
    variables = _variables(raw)
    for name, dimensions, shape, kind, attributes in done.labels():
        numbers = indexing.LazilyIndexedArray(_numbers(done, name, shape, kind))
        variables[name] = xarray.Variable(dimensions, numbers, attributes)
    return _decoded(variables, raw["attributes"])


def arrays(raw: dict[str, Any]) -> dict[str, tuple[Any, dict[str, Any]]]:
    """The values and the attributes of each variable, without xarray."""
    return {name: (values, own) for name, (_, values, own) in raw["variables"].items()}


def _variables(raw: dict[str, Any]) -> dict[str, Any]:
    import numpy

    each = raw["variables"].items()
    return {name: (dimensions, numpy.asarray(values), own) for name, (dimensions, values, own) in each}


def _decoded(variables: dict[str, Any], attributes: dict[str, Any]) -> xarray.Dataset:
    import xarray

    # Times are seconds as numbers.
    return xarray.decode_cf(xarray.Dataset(variables, attrs=attributes), decode_times=False)


def _numbers(done: _capsulemap.Partial, name: str, shape: tuple[int, ...], kind: str) -> Any:
    """The numbers of a variable, which are put together when they are first asked for."""
    import numpy
    from xarray.backends import BackendArray
    from xarray.core import indexing

    class Numbers(BackendArray):
        def __init__(self) -> None:
            self.shape = shape
            self.dtype = numpy.dtype(kind)
            self.whole: Any = None

        def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
            support = indexing.IndexingSupport.BASIC
            return indexing.explicit_indexing_adapter(key, self.shape, support, self.part)

        def part(self, key: tuple[Any, ...]) -> Any:
            if self.whole is None:
                self.whole = done.numbers(name)
            return self.whole[key]

    return Numbers()
