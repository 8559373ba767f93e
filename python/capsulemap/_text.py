"""Writes values as they stand in a study file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from typing import Any

from ._errors import Fault, StudyError

Quantity = Any
"""A number in SI units, a text with a unit, or an object with ``magnitude`` and ``units``, as those of pint."""


def quoted(text: str) -> str:
    """A text in quotes."""
    # Escapes of JSON are escapes of TOML, but for those of characters beyond 16 bits.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def number(value: float) -> str:
    """A number with all its digits."""
    return repr(float(value))


def quantity(key: str, value: Quantity, unit: str | None) -> str:
    """A quantity, of which a number is in ``unit``, or has none."""
    if isinstance(value, str):
        return quoted(value)
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return _foreign(value, unit)
    if isinstance(value, bool) or not _is_number(value):
        what = "a number in SI units or a text with a unit"
        raise _unfit(key, f"expected {what}, found {type(value).__name__} {value!r}")
    return number(value) if unit is None else quoted(f"{number(value)} {unit}")


def words(key: str, value: Quantity, unit: str | None = None) -> str:
    """A quantity as an option of the command line has it: a plain number is in SI units, or gets this unit."""
    if isinstance(value, str):
        return value
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return str(json.loads(_foreign(value, None)))
    written = quantity(key, value, None)
    return written if unit is None else f"{written} {unit}"


def quantities(key: str, values: Iterable[Quantity], unit: str | None) -> str:
    """A list of quantities."""
    return "[" + ", ".join(quantity(key, value, unit) for value in values) + "]"


def plain(key: str, value: object) -> str:
    """A value of a key that is no quantity: a truth, a number, a text, a list or a table."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Integral):
        return str(int(value))
    if _is_number(value):
        return number(value)  # type: ignore[arg-type]
    if isinstance(value, Mapping):
        return inline({name: plain(f"{key}.{name}", of) for name, of in value.items()})
    if isinstance(value, Iterable):
        return "[" + ", ".join(plain(key, each) for each in value) + "]"
    raise _unfit(key, f"expected a number, a text, a list or a table, found {type(value).__name__}")


def inline(pairs: Mapping[str, str]) -> str:
    """A table within a line, of values that are written already."""
    return "{ " + ", ".join(f"{name(key)} = {value}" for key, value in pairs.items()) + " }"


def name(key: str) -> str:
    """A key."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else quoted(key)


def table(header: str, pairs: Mapping[str, str]) -> str:
    """A table with its header, of values that are written already; nothing without pairs."""
    if not pairs:
        return ""
    lines = [header, *(f"{name(key)} = {value}" for key, value in pairs.items())]
    return "\n" + "\n".join(lines) + "\n"


def _is_number(value: object) -> bool:
    # A scalar of numpy is a number, an array is none.
    return isinstance(value, Real) or (hasattr(value, "__float__") and getattr(value, "ndim", 0) == 0)


def _foreign(value: Any, unit: str | None) -> str:
    magnitude = number(value.magnitude)
    words = format(value.units, "~C") if hasattr(value.units, "dimensionality") else str(value.units)
    words = words.replace("**", "").replace("*", " ").strip()
    return magnitude if unit is None and words in ("", "dimensionless") else quoted(f"{magnitude} {words}")


def _unfit(key: str, message: str) -> StudyError:
    fault = Fault(None, key, message)
    return StudyError(f"the study: 1 fault\n  {fault}", [fault])
