"""Declaration of machine file keys, directly on the attributes that store their values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, StrEnum
from functools import cache
from typing import Any, NamedTuple, TypeVar, dataclass_transform

# --- Units of a machine file. The file has its own units; the model has mm, seconds, degrees and rpm.


MM_PER_INCH = 25.4


class FileUnit(StrEnum):
    """Unit of a number in the machine file, as shown in findings.

    ``len`` represents inches or millimeters, depending on the unit of the file.
    """

    UNITLESS = ""
    LENGTH = "len"
    FEED = "len/min"
    ACCELERATION = "len/s²"
    MILLISECONDS = "ms"
    SECONDS = "s"
    PERCENT = "%"
    DEGREES = "deg"
    RPM = "rpm"
    RPM_PER_SECOND = "rpm/s"
    C_AXIS_RPM = "rpm of the C axis"
    C_AXIS_RPM_PER_SECOND = "rpm/s of the C axis"
    DEGREES_PER_MINUTE = "deg/min"
    DEGREES_PER_SECOND_SQUARED = "deg/s²"
    KILOWATTS = "kW"


# Divisors instead of factors, so that 300 in/min gives exactly the same number as the word F300.
_DIVISOR = {
    FileUnit.FEED: 60.0,
    FileUnit.DEGREES_PER_MINUTE: 60.0,
    FileUnit.MILLISECONDS: 1000.0,
    FileUnit.PERCENT: 100.0,
}
_MULTIPLIER = {FileUnit.C_AXIS_RPM: 6.0, FileUnit.C_AXIS_RPM_PER_SECOND: 6.0, FileUnit.KILOWATTS: 1000.0}
LENGTH_UNITS = frozenset((FileUnit.LENGTH, FileUnit.FEED, FileUnit.ACCELERATION))


def convert_to_model_unit(value: float, unit: FileUnit, is_inch: bool) -> float:
    """Convert a number from the unit of the machine file to the unit of the model."""
    length = value * MM_PER_INCH if is_inch and unit in LENGTH_UNITS else value
    return length * _MULTIPLIER.get(unit, 1.0) / _DIVISOR.get(unit, 1.0)


def convert_to_file_unit(value: float, unit: FileUnit, is_inch: bool) -> float:
    """Convert a number from the unit of the model to the unit of the machine file."""
    number = value * _DIVISOR.get(unit, 1.0) / _MULTIPLIER.get(unit, 1.0)
    return number / MM_PER_INCH if is_inch and unit in LENGTH_UNITS else number


def format_unit(unit: FileUnit, is_inch: bool) -> str:
    """Return the text of a unit with a leading space; the unit of a length is in or mm.

    The result is an empty string for numbers without a unit.
    """
    text = unit.value.replace("len", "in" if is_inch else "mm")
    return f" {text}" if text else ""


def format_value(value: float, unit: FileUnit, is_inch: bool) -> str:
    """Return a number of the model as text, converted to the unit of the machine file."""
    return f"{convert_to_file_unit(value, unit, is_inch):.6g}{format_unit(unit, is_inch)}"


Pair = tuple[float, float]
NumberTriple = tuple[float, float, float]
KeyValue = float | bool | str | Pair | NumberTriple | tuple[float, ...]
Words = str  # a list of words, stored as one text separated by spaces


class ValueKind(Enum):
    """Kind of a machine file value, with the description that findings show."""

    NUMBER = "a number"
    INTEGER = "a whole number"
    BOOLEAN = "true or false"
    TEXT = "nonblank text in quotation marks"
    PAIR = "two numbers, [low, high]"
    TRIPLE = "three numbers, [x, y, z]"
    NUMBERS = "one to four numbers, [first, second]"
    CHOICE = "one of"
    WORDS = 'a list of words, such as ["one", "another"]'  # stored as one text separated by spaces


@dataclass(frozen=True, slots=True)
class KeyField:
    """A key of the machine file, with its kind, unit, range in the model's unit, and default.

    The key is required if ``default`` is None. ``attribute`` is the attribute that stores the value. If
    ``is_derived`` is True, the default depends on other values of the file (``machine_defaults.py``).
    ``meaning`` is the text of the reference page.
    """

    key: str
    attribute: str
    kind: ValueKind
    unit: FileUnit
    minimum: float
    maximum: float
    default: KeyValue | None
    choices: tuple[str | bool, ...]
    is_derived: bool
    meaning: str


# --- Declarations. A class declares the schema of a table, and its instances hold the values.


class KeyRange(NamedTuple):
    """Minimum and maximum of a number in the model's unit, and its unit in the file."""

    minimum: float = 0.0
    maximum: float = 0.0
    unit: FileUnit = FileUnit.UNITLESS


class _Key(NamedTuple):
    """A key declaration. Until the class is complete, it is stored as the default of the attribute.

    If ``name`` is empty, the key has the name of the attribute.
    """

    key_range: KeyRange
    meaning: str
    name: str
    default: KeyValue | None
    choices: tuple[str | bool, ...]
    is_derived: bool
    is_secret: bool


def declare_key(
    range: KeyRange = KeyRange(),  # noqa: B008  immutable
    *,
    meaning: str,
    name: str = "",
    default: KeyValue | None = None,
    choices: tuple[str | bool, ...] = (),
    is_derived: bool = False,
    is_secret: bool = False,
) -> Any:
    """Declare a key on an attribute of a class, with the attribute's annotation as the kind of value.

    ``name`` is the key in the file if it differs from the attribute's name. A value with ``is_secret`` is
    never printed. The other arguments are described in ``KeyField``.
    """
    return _Key(range, meaning, name, default, choices, is_derived, is_secret)


_KINDS = {
    "float": ValueKind.NUMBER,
    "int": ValueKind.INTEGER,
    "bool": ValueKind.BOOLEAN,
    "str": ValueKind.TEXT,
    "Pair": ValueKind.PAIR,
    "NumberTriple": ValueKind.TRIPLE,
    "tuple[float, ...]": ValueKind.NUMBERS,
    "Words": ValueKind.WORDS,
}
_Table = TypeVar("_Table")
# the keys declared by each class with ``make_key_table``, which replaces them by defaults
_declared: dict[type, Mapping[str, object]] = {}


@dataclass_transform(frozen_default=True, field_specifiers=(declare_key, field))
def make_key_table(table: type[_Table]) -> type[_Table]:
    """Convert a class that declares keys into a frozen dataclass with slots."""
    declared = dict(vars(table))
    for name, each in declared.items():
        if not isinstance(each, _Key):
            continue
        if each.default is None:
            setattr(table, name, field(repr=not each.is_secret))
        else:
            setattr(table, name, field(default=each.default, repr=not each.is_secret))
    made = dataclass(frozen=True, slots=True)(table)
    _declared[made] = declared
    return made


KeySchema = type | tuple[KeyField, ...]  # a class that declares keys, or the keys themselves


def get_declared_keys(table: KeySchema) -> tuple[KeyField, ...]:
    """Return the keys that a class declares, in the order of declaration."""
    return table if isinstance(table, tuple) else _keys_of_class(table)


@cache
def _keys_of_class(table: type) -> tuple[KeyField, ...]:
    return tuple(
        _field(name, each, base.__annotations__[name])
        for base in reversed(table.__mro__)
        for name, each in _declared.get(base, vars(base)).items()
        if isinstance(each, _Key)
    )


def _field(name: str, each: _Key, annotation: str) -> KeyField:
    kind = ValueKind.CHOICE if each.choices else _KINDS[annotation]
    low, high, unit = each.key_range
    return KeyField(
        each.name or name,
        name,
        kind,
        unit,
        low,
        high,
        each.default,
        each.choices,
        each.is_derived,
        each.meaning,
    )
