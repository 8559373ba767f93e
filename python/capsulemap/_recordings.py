"""Recordings of experiments as CSV files, from tables of Python."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from typing import Any, Union

from ._text import labelled_unit

Recording = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]
"""The path of a CSV file, or columns by name: a mapping of arrays, or a DataFrame of pandas or polars."""


def file_of(
    recording: Recording, units: Mapping[str, str | None], folder: str, name: str
) -> str:
    """The path of a recording, which is written to a folder where it is a table.

    A column whose name has a unit ("x2 [mm]") is in that unit, another one in SI units, which are ``units`` by name.
    """
    if isinstance(recording, (str, os.PathLike)):
        return os.path.abspath(recording)
    columns = _columns(recording)
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        raise ValueError(f"{name}: the columns have different lengths, {sorted(lengths)}")
    path = os.path.join(folder, f"{name}.csv")
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([_header(column, units, labelled_unit(recording[column])) for column in columns])
        writer.writerows(zip(*columns.values()))
    # Messages name it as it is called here.
    return os.path.basename(path)


def _header(column: str, units: Mapping[str, str | None], own: str | None) -> str:
    unit = own if own is not None and column in units else units.get(column)
    return column if unit is None else f"{column} [{unit}]"


def _columns(recording: Any) -> dict[str, list[str]]:
    """The columns of a table, with all digits of their numbers."""
    if hasattr(recording, "data_vars") or hasattr(recording, "to_frame"):
        kind = type(recording).__name__
        raise TypeError(f"expected a mapping of columns or a DataFrame, found {kind}: {{\"t\": ..., \"x2\": ...}} of its parts is one")
    names = recording.keys() if isinstance(recording, Mapping) else getattr(recording, "columns", None)
    if names is None:
        kind = type(recording).__name__
        raise TypeError(f"expected a path, a mapping of columns or a DataFrame, found {kind}")
    return {str(name): [_cell(it) for it in _listed(recording[name])] for name in names}


def _listed(column: Any) -> list[Any]:
    if hasattr(column, "dims") and hasattr(column, "values"):
        column = column.values
    for method in ("tolist", "to_list"):
        if hasattr(column, method):
            return list(getattr(column, method)())
    return list(column)


def _cell(value: Any) -> str:
    return repr(float(value)) if isinstance(value, (int, float)) else str(value)
