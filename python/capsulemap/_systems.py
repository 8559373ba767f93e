"""What is simulated: capsules and oscillators of one's own, with values of their parameters."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, TypeVar

from . import _capsulemap, _text
from ._errors import StudyError
from ._text import Quantity

Self = TypeVar("Self", bound="_Parametric")


class _Parametric:
    """Values of parameters, which do not change."""

    __slots__ = ("_given",)
    _given: dict[str, Quantity]

    def __init__(self, given: Mapping[str, Quantity]) -> None:
        kept = {name: value for name, value in given.items() if value is not None}
        object.__setattr__(self, "_given", kept)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} does not change: use .replace({name}=...)")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} does not change: use .replace({name}=None)")

    @property
    def parameters(self) -> Mapping[str, Quantity]:
        """The values that are given, by name."""
        return dict(self._given)

    def replace(self: Self, **values: Quantity) -> Self:
        """The same with other values; ``None`` takes a value away."""
        return self._with({**self._given, **values})

    @property
    def names(self) -> Mapping[str, Mapping[str, str]]:
        """What there is to ask for, by name: "parameters", "choices", "starts" (keys of a start) and "outputs", each with its unit, its value
        where none is given, and its meaning."""
        told = self._description()
        parameters = {
            name: f"[{told['parameters'][name] or '1'}] {meaning}{'' if usual is None else f', {usual:g} unless given'}"
            for name, (usual, meaning) in told["told"].items()
        }
        starts = {
            name.removeprefix("start_"): f"[{unit or '1'}], {name} on an axis"
            for name, unit in told["coordinates"].items()
            if name.startswith("start_")
        }
        outputs = {name: f"[{unit}] {meaning}" for name, (unit, meaning) in told["outputs"].items()}
        choices = {name: " or ".join(options) for name, options in told["choices"].items()}
        return {"parameters": parameters, "choices": choices, "starts": starts, "outputs": outputs}

    def _check_names(self) -> None:
        """Sure that a system has the parameters and choices that are given; else all that is wrong with what is given is told."""
        known = self._description()
        if all(name in known["parameters"] or name in known["choices"] for name in self._given):
            return
        try:
            _capsulemap.Study.built(self.to_toml(), "the parameters")
        except StudyError as error:
            # What is not given may come as an axis.
            own = [fault for fault in error.faults if fault.key.removeprefix("parameters.") in self._given]
            told = "".join(f"\n  {fault}" for fault in own)
            faults = "1 fault" if len(own) == 1 else f"{len(own)} faults"
            raise StudyError(f"the parameters: {faults}{told}", own) from None

    def to_toml(self) -> str:
        """The system as the text of a study file, with numbers in SI units."""
        return self._text(())

    def _with(self: Self, given: Mapping[str, Quantity]) -> Self:
        raise NotImplementedError

    def _head(self) -> str:
        return ""

    def _tail(self) -> str:
        return ""

    def _description(self) -> dict[str, Any]:
        raise NotImplementedError

    def _units(self) -> dict[str, str | None]:
        """The unit of a number, by the names of parameters and of coordinates of the start."""
        description = self._description()
        return {**description["parameters"], **description["coordinates"]}

    def _table(self, varied: tuple[str, ...]) -> str:
        """The table of parameters without those that vary."""
        units = self._description()["parameters"]
        pairs = {
            name: _text.quantity(f"parameters.{name}", value, units.get(name))
            for name, value in self._given.items()
            if name not in varied
        }
        return _text.table("[parameters]", pairs)

    def _text(self, varied: tuple[str, ...]) -> str:
        return (self._head() + self._table(varied) + self._tail()).lstrip("\n")

    def _key(self) -> tuple[str, str]:
        return (type(self).__name__, self.to_toml())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Parametric) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())


class Capsule(_Parametric):
    """A vibro-impact capsule.

    Each value is a number in SI units ([N], [m], [N/m], [rad/s], ...), a text with a unit ("2.42 kN/m"), or the name of a choice
    (``drive="square"``). What is not given is as in Table 1 of the paper; ``omega``, ``p_d``, ``k2`` and ``delta`` must be given, here
    or on an axis. ``model="capsule-over-folds"`` is the capsule over folds. ``names`` has all names with units and meanings. Raises
    StudyError where a name is unknown.
    """

    __slots__ = ("_model",)
    _model: str

    def __init__(self, *, model: str = "capsule", **values: Quantity) -> None:
        super().__init__(values)
        object.__setattr__(self, "_model", model)
        self._check_names()

    @property
    def model(self) -> str:
        """The name of its model."""
        return self._model

    def _with(self, given: Mapping[str, Quantity]) -> Capsule:
        return Capsule(model=self._model, **given)

    def _head(self) -> str:
        return "" if self._model == "capsule" else f"model = {_text.quoted(self._model)}\n"

    def _description(self) -> dict[str, Any]:
        return _described(self._model, None)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_capsule, (self._model, self._given))

    def __repr__(self) -> str:
        model = [] if self._model == "capsule" else [f"model={self._model!r}"]
        return f"Capsule({', '.join(model + [f'{name}={value!r}' for name, value in self._given.items()])})"


class Oscillator(_Parametric):
    """An oscillator that is given as text: rates, events, switches, friction, pulses and outputs (docs/systems.md)."""

    __slots__ = ("_name", "_tables")
    _name: str
    _tables: str

    def __init__(self, name: str, tables: str, given: Mapping[str, Quantity]) -> None:
        super().__init__(given)
        object.__setattr__(self, "_name", name)
        object.__setattr__(self, "_tables", tables)
        self._check_names()

    @staticmethod
    def from_toml(source: str | os.PathLike[str], **values: Quantity) -> Oscillator:
        """The oscillator in the file at a path, or in a text, with these values of its parameters.

        A text has more than one line, or an equals sign. Raises StudyError with all faults of the text.
        """
        if is_path(source):
            name, tables = _capsulemap.read_system(path=os.fspath(source))
        else:
            name, tables = _capsulemap.read_system(text=str(source))
        return Oscillator(name, tables, values)

    @property
    def name(self) -> str:
        """Its name."""
        return self._name

    def _with(self, given: Mapping[str, Quantity]) -> Oscillator:
        return Oscillator(self._name, self._tables, given)

    def _tail(self) -> str:
        return f"\n{self._tables}\n"

    def _description(self) -> dict[str, Any]:
        return _described(None, self._tables)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_oscillator, (self._name, self._tables, self._given))

    def __repr__(self) -> str:
        values = "".join(f", {name}={value!r}" for name, value in self._given.items())
        return f"<Oscillator {self._name!r}{values}>"


def is_path(source: str | os.PathLike[str]) -> bool:
    """Whether something is the path of a file rather than a text."""
    return not isinstance(source, str) or ("\n" not in source and "=" not in source)


def _capsule(model: str, given: Mapping[str, Quantity]) -> Capsule:
    return Capsule(model=model, **given)


def _oscillator(name: str, tables: str, given: Mapping[str, Quantity]) -> Oscillator:
    # The library knows a system once it has read it.
    _capsulemap.read_system(text=tables)
    return Oscillator(name, tables, given)


@lru_cache(maxsize=64)
def _described(model: str | None, tables: str | None) -> dict[str, Any]:
    return _capsulemap.describe(model=model, tables=tables)
