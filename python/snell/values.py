"""What all parts of a scene have in common: they are tables of the scene file, compared and shown by what they say."""

from __future__ import annotations

import difflib
import math
import operator
import os
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, fields
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from .errors import SceneError, SnellError

#: Of what may stand in a scene.
LARGEST = 1e15

V = TypeVar("V", bound="Value")
Vector: TypeAlias = "Sequence[float] | NDArray[np.floating[Any]]"
Color: TypeAlias = "float | Sequence[float] | NDArray[np.floating[Any]]"
Steps: TypeAlias = "Sequence[Mapping[str, Any]]"


class Value:
    """A table of the scene file. Two are equal if they say the same, whether by tuples, lists or arrays."""

    #: Fields that are no keys of the file.
    beside: ClassVar[frozenset[str]] = frozenset()
    #: Fields whose keys in the file are other ones.
    called: ClassVar[Mapping[str, str]] = {}
    #: Fields that are colours, where one number is gray.
    colors: ClassVar[frozenset[str]] = frozenset()

    def plain(self, place: str = "") -> dict[str, Any]:
        """Return the form of the file: numbers, texts, lists and dictionaries; what is None is left out."""
        table = {}
        for field in own_fields(type(self)):
            value = getattr(self, field.name)
            if value is not None and field.name not in self.beside:
                key = self.called.get(field.name, field.name)
                value = plain(value, join(place, key))
                table[key] = gray(value) if field.name in self.colors else value
        return table

    @classmethod
    def of(cls: type[V], table: Mapping[str, Any]) -> V:
        """Make one of its form in a file."""
        return cls(**{key: frozen(value) for key, value in table.items()})

    def replace(self: V, **changes: Any) -> V:
        """Return a copy of its own with some fields changed."""
        mine = {field.name: copied(getattr(self, field.name)) for field in own_fields(type(self))}
        return type(self)(**(mine | changes))

    def __eq__(self, other: object) -> bool:
        return (
            self.plain() == other.plain() if type(other) is type(self) and isinstance(other, Value) else NotImplemented
        )

    __hash__ = None  # type: ignore[assignment] # they can be changed

    if not TYPE_CHECKING:  # which knows the fields, and would take any name otherwise

        def __setattr__(self, name: str, value: object) -> None:
            if name not in self.__dataclass_fields__:  # a misspelt field would change nothing
                raise self._no_field(name)
            object.__setattr__(self, name, value)

        def __getattr__(self, name: str) -> Any:
            raise self._no_field(name)

    def _no_field(self, name: str) -> AttributeError:
        """Return what is wrong with the name of a field."""
        near = difflib.get_close_matches(name, [field.name for field in own_fields(type(self))], 1)
        meant = f"; did you mean `{near[0]}`?" if near else ""
        return AttributeError(f"a {type(self).__name__} has no field `{name}`{meant}", name=name, obj=self)

    def __repr__(self) -> str:
        said = ((field, getattr(self, field.name)) for field in own_fields(type(self)))
        listed = (f"{field.name}={shown(value)}" for field, value in said if not is_default(field, value))
        return f"{type(self).__name__}({', '.join(listed)})"


def own_fields(kind: type[Value]) -> tuple[Field[Any], ...]:
    """Return the fields of a dataclass; all kinds of values are some."""
    return fields(kind)  # type: ignore[arg-type]


def join(place: str, key: str) -> str:
    """Return the place of a key in a table."""
    return f"{place}.{key}" if place else key


def is_default(field: Field[Any], value: Any) -> bool:
    """Say whether a field need not be written down."""
    default = field.default_factory() if field.default_factory is not MISSING else field.default
    return type(default) is type(value) and bool(default == value)


def plain(value: Any, place: str) -> Any:
    """Return a value as JSON has it."""
    match value:
        case Value():
            return value.plain(place)
        case bool() | str():
            return value
        case np.bool_():
            return bool(value)
        case int() | np.integer():
            return int(value)
        case float() | np.floating():
            return finite(float(value), place)
        case np.ndarray():
            return plain(value.tolist(), place)
        case Mapping():
            return {str(key): plain(inner, join(place, str(key))) for key, inner in list(value.items())}
        case os.PathLike():
            return os.fspath(value)
        case Sequence():
            return [plain(inner, f"{place}[{index}]") for index, inner in enumerate(list(value))]
    raise SceneError([(place, f"expected a number, a text or a list, read {value!r}", None)])


def finite(number: float, place: str) -> float:
    """Return the number; JSON has no other ones."""
    if not math.isfinite(number):
        raise SceneError([(place, f"expected a number between -1e15 and 1e15, read {number}", None)])
    return number


def whole(value: Any, place: str, error: type[SnellError]) -> int:
    """Return a whole number.

    Raises
    ------
    SnellError
        Of the given kind, if it is none.
    """
    try:
        return operator.index(value)
    except TypeError:
        raise error([(place, f"expected a whole number, read {value!r}", None)]) from None


def gray(color: Any) -> Any:
    """Return a colour, in one number where three are the same."""
    alike = isinstance(color, list) and len(color) == 3 and color[0] == color[1] == color[2]
    return color[0] if alike else color


def frozen(value: Any) -> Any:
    """Return a value of a file with lists of numbers as tuples."""
    if isinstance(value, list):
        inner = [frozen(element) for element in value]
        return inner if any(isinstance(element, dict | list | Value) for element in inner) else tuple(inner)
    return {key: frozen(inner) for key, inner in value.items()} if isinstance(value, dict) else value


def copied(value: Any) -> Any:
    """Return a copy of everything that can be changed, but the numbers of meshes."""
    match value:
        case Value():
            return value.replace()
        case list():
            return [copied(inner) for inner in value]
        case dict():
            return {key: copied(inner) for key, inner in value.items()}
    return value


def shown(value: Any) -> str:
    """Return what can be typed again."""
    match value:
        case np.ndarray() | np.generic():
            return shown(frozen(value.tolist()))
        case tuple():
            return f"({', '.join(map(shown, value))}{',' if len(value) == 1 else ''})"
        case list():
            return f"[{', '.join(map(shown, value))}]"
        case dict():
            return f"{{{', '.join(f'{key!r}: {shown(inner)}' for key, inner in value.items())}}}"
    return repr(value)
