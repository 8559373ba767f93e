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
        raise unfit(key, f"expected {what}, found {type(value).__name__} {value!r}")
    own = labelled_unit(value)
    if own is not None:
        return quoted(f"{number(value)} {own}")
    return number(value) if unit is None else quoted(f"{number(value)} {unit}")


def labelled_unit(value: object) -> str | None:
    """The unit that an array of xarray is labelled with, if any."""
    own = getattr(value, "attrs", None)
    unit = own.get("units") if isinstance(own, Mapping) else None
    return unit if isinstance(unit, str) and unit != "1" else None


def words(key: str, value: Quantity, unit: str | None = None) -> str:
    """A quantity as an option of the command line has it: a plain number is in SI units, or gets this unit."""
    if isinstance(value, str):
        return value
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return str(json.loads(_foreign(value, None)))
    own = labelled_unit(value)
    if own is not None:
        return f"{number(value)} {own}"
    written = quantity(key, value, None)
    return written if unit is None else f"{written} {unit}"


def quantities(key: str, values: Iterable[Quantity], unit: str | None) -> str:
    """A list of quantities, texts with units or numbers, but not both."""
    values = list(values)
    texts = [it for it in values if isinstance(it, str)]
    if unit is not None and 0 < len(texts) < len(values):
        told = "numbers in SI units and texts with units are mixed; a range with so many points is capsulemap.Axis(start, stop, points)"
        raise unfit(key, told)
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
    raise unfit(key, f"expected a number, a text, a list or a table, found {type(value).__name__}")


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


def mapping(key: str, value: object, example: str) -> None:
    """Sure that an argument is a mapping, or nothing."""
    if value is not None and not isinstance(value, Mapping):
        raise TypeError(f"{key}: expected a mapping, as {example}, found {type(value).__name__} {value!r}")


def whole(key: str, value: object, least: int = 0) -> None:
    """Sure that an argument is a whole number."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        raise unfit(key, f"expected a whole number, {least} or more, found {value!r}")


def truth(key: str, value: object) -> None:
    """Sure that an argument is True or False."""
    if not isinstance(value, bool):
        raise TypeError(f"{key}: expected True or False, found {value!r}")


def pair(key: str, value: object, what: str) -> tuple[Any, Any]:
    """An argument of two parts."""
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable) or len(parts := list(value)) != 2:
        raise TypeError(f"{key}: expected {what}, found {value!r}")
    return parts[0], parts[1]


def listed(value: Any) -> list[Any] | None:
    """Several of something; a text alone is one."""
    if value is not None and not isinstance(value, Iterable):
        raise TypeError(f"expected a name or several, found {value!r}")
    return None if value is None else [value] if isinstance(value, str) else list(value)


def unfit(key: str, message: str) -> StudyError:
    """An error of one key."""
    fault = Fault(None, key, message)
    return StudyError(f"the study: 1 fault\n  {fault}", [fault])
