"""Declarations of the tables of a machine file, and functions that read and check the tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from dataclasses import fields as fields_of
from math import inf
from typing import TYPE_CHECKING, NamedTuple, TypeGuard, TypeVar

from core.key_declaration import (
    LENGTH_UNITS,
    KeyField,
    KeySchema,
    KeyValue,
    Pair,
    ValueKind,
    convert_to_file_unit,
    convert_to_model_unit,
    format_value,
    get_declared_keys,
)
from core.message import CodedError, Message, find_similar_word
from core.secret_values import _REMOVED, format_toml_value, format_without_secrets

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


class FileFinding(NamedTuple):
    """An error in a machine file, with the path of the key, the value in the file, and the expected value.

    ``code`` identifies the error for tests, as in ``CodedError``.
    """

    path: str
    value: str
    expected_value: str
    code: str = ""

    def __str__(self) -> str:
        where = f"{self.path} = {self.value}" if self.value else self.path
        return " ".join(f"{where}: {self.expected_value}".splitlines())  # a TOML key may contain a line break


class MachineFileError(CodedError):
    """An error raised if a machine file cannot be used.

    ``errors`` contains all findings, and ``source`` is the name of the file. ``code`` contains the codes of
    the findings in order.
    """

    def __init__(self, errors: Sequence[FileFinding], source: str) -> None:
        self.findings = tuple(errors)
        self.source = source
        text = "; ".join(str(finding) for finding in self.findings)
        super().__init__(f"{source}: {text}", " ".join(each.code for each in self.findings if each.code))


_Model = TypeVar("_Model", bound="DataclassInstance")


_HUGE = 10**300
_NUMERIC = frozenset(
    (ValueKind.NUMBER, ValueKind.INTEGER, ValueKind.PAIR, ValueKind.TRIPLE, ValueKind.NUMBERS)
)


@dataclass(frozen=True, slots=True)
class TableDescription:
    """Description of a table for the reference page of the machine file.

    ``heading`` is the table's name in the file, with … in place of a name that the machine owner chooses.
    """

    heading: str
    purpose: str
    keys: KeySchema = ()


class FileValues:
    """Values of a machine file by key path, in the units of the machine model.

    Lengths can be read only if the file specifies its unit of length.
    """

    def __init__(self, is_inch: bool | None) -> None:
        self.is_inch = is_inch
        self.values_by_path: dict[str, KeyValue] = {}
        self.invalid_paths: set[str] = set()  # invalid or missing values, which cause no further findings
        self.omitted_fields: dict[str, KeyField] = {}  # derived values that are not in the file

    def has_values(self, *paths: str) -> bool:
        """Return whether a valid value exists at every path."""
        return all(path in self.values_by_path for path in paths)

    def is_specified(self, path: str) -> bool:
        """Return whether the file contains a value at this path, valid or invalid."""
        return path in self.values_by_path or path in self.invalid_paths

    def read_number(self, path: str) -> float:
        """Return the number at the path.

        Raises KeyError if no valid value exists, or TypeError if the value is a string or a list.
        """
        value = self.values_by_path[path]
        if isinstance(value, str | tuple):
            raise TypeError(f"{path} holds no number")
        return float(value)

    def read_flag(self, path: str) -> bool:
        """Return whether the value at the path is true.

        Raises KeyError if no valid value exists.
        """
        return self.values_by_path[path] is True

    def text(self, path: str) -> str:
        """Return the value at the path as text.

        Raises KeyError if no valid value exists.
        """
        return str(self.values_by_path[path])

    def has_text(self, path: str, text: str) -> bool:
        """Return whether the value at the path is valid and equals this text."""
        return self.has_values(path) and self.text(path) == text

    def read_integer(self, path: str) -> int:
        """Return the number at the path as an integer, without its decimal places.

        Raises KeyError if no valid value exists, or TypeError if the value is a string or a list.
        """
        return int(self.read_number(path))

    def read_pair(self, path: str) -> Pair:
        """Return the two numbers at the path.

        Raises KeyError if no valid value exists, or TypeError if the value is not a list of two numbers.
        """
        value = self.values_by_path[path]
        if not isinstance(value, tuple) or len(value) != 2:
            raise TypeError(f"{path} holds no pair")
        return value

    def read_numbers(self, path: str) -> tuple[float, ...]:
        """Return the list of numbers at the path.

        Raises KeyError if no valid value exists, or TypeError if the value is not a list.
        """
        value = self.values_by_path[path]
        if not isinstance(value, tuple):
            raise TypeError(f"{path} holds no list")
        return value

    def make_model(
        self, kind: type[_Model], path: str, keys: Mapping[str, str] = {}, /, **given: object
    ) -> _Model:
        """Return the dataclass object for a table without errors.

        The value of a field comes from ``given``, from the key that ``keys`` specifies for the field, or
        from the key with the field's name.
        """
        keys = keys or {each.attribute: each.key for each in get_declared_keys(kind)}
        names = [field.name for field in fields_of(kind) if field.name not in given]
        said = {name: self.values_by_path[f"{path}.{keys.get(name, name)}"] for name in names}
        return kind(**said, **given)


def join_path(path: str, key: str) -> str:
    """Return the path of a key in the table at ``path``; an empty path is the top level of the file."""
    return f"{path}.{key}" if path else key


def find_unknown_keys(table: Mapping[str, object], known: list[str], path: str) -> list[FileFinding]:
    """Return a finding for every unknown key.

    The finding names the most similar known key, or the replacement if the key was removed.
    """
    found = []
    for key in table:
        place = join_path(path, key)
        if place in _REMOVED:
            found.append(FileFinding(place, "", _REMOVED[place], "removed-key"))
        elif key not in known:
            near = find_similar_word(key, known)
            hint = (
                Message("did you mean {nearest}?", nearest=near)
                if near
                else Message("use one of these keys: {known}", known=", ".join(known))
            )
            found.append(FileFinding(place, "", Message("unknown key; {hint}", hint=hint), "unknown-key"))
    return found


def read_table_values(
    table: object, keys: KeySchema, path: str, values: FileValues, children: tuple[str, ...] = ()
) -> list[FileFinding]:
    """Store all valid values of ``table`` in ``values`` under ``path``; return the findings.

    ``children`` are the names of inner tables that are read separately.
    """
    if not isinstance(table, dict):
        return [
            FileFinding(
                path,
                format_toml_value(table),
                Message("this entry must be a table, [{path}]", path=path),
                "not-a-table",
            )
        ]
    fields = get_declared_keys(keys)
    findings = find_unknown_keys(table, [*(field.key for field in fields), *children], path)
    for field in fields:
        place = join_path(path, field.key)
        raw = table.get(field.key)
        if raw is None:
            findings += _default(field, place, values)
        elif problem := _problem(raw, field, values.is_inch):
            values.invalid_paths.add(place)
            findings.append(
                FileFinding(place, format_without_secrets(place, raw), f"expected {problem}", "wrong-value")
            )
        elif values.is_inch is not None or field.unit not in LENGTH_UNITS:
            values.values_by_path[place] = _converted(raw, field, bool(values.is_inch))
    return findings


def _default(field: KeyField, place: str, values: FileValues) -> list[FileFinding]:
    if field.is_derived:
        values.omitted_fields[place] = field
        return []
    if field.default is None:
        values.invalid_paths.add(place)
        return [make_missing_finding(place, field, values.is_inch)]
    values.values_by_path[place] = field.default
    return []


def make_missing_finding(path: str, field: KeyField, is_inch: bool | None) -> FileFinding:
    """Return the finding for a required value that is missing."""
    return FileFinding(
        path,
        "",
        Message("this value is missing; expected {field}", field=_expected(field, is_inch)),
        "missing",
    )


def _number(raw: object) -> TypeGuard[int | float]:
    return isinstance(raw, int | float) and not isinstance(raw, bool)


def _shape_is_right(raw: object, field: KeyField) -> bool:
    match field.kind:
        case ValueKind.NUMBER:
            return _number(raw)
        case ValueKind.INTEGER:
            return isinstance(raw, int) and not isinstance(raw, bool)
        case ValueKind.BOOLEAN:
            return isinstance(raw, bool)
        case ValueKind.TEXT | ValueKind.WORDS:
            return (
                _is_words(raw)
                if field.kind is ValueKind.WORDS
                else isinstance(raw, str) and bool(raw.strip())
            )
        case ValueKind.PAIR | ValueKind.TRIPLE | ValueKind.NUMBERS:
            counts = {ValueKind.PAIR: (2,), ValueKind.TRIPLE: (3,)}.get(field.kind, range(1, 5))
            return isinstance(raw, list) and len(raw) in counts and all(_number(part) for part in raw)
        case ValueKind.CHOICE:
            return any(raw is choice or (isinstance(raw, str) and raw == choice) for choice in field.choices)


def _is_words(raw: object) -> bool:
    return isinstance(raw, list) and all(isinstance(each, str) and len(each.split()) == 1 for each in raw)


def _parts(raw: object) -> list[float]:
    """Return the numbers in a raw value.

    Integers that are too large for a float become infinite.
    """
    numbers = [part for part in (raw if isinstance(raw, list) else [raw]) if _number(part)]
    return [float(part) if abs(part) < _HUGE else inf for part in numbers]


def _problem(raw: object, field: KeyField, is_inch: bool | None) -> str:
    """Return a description of the expected value if ``raw`` is invalid, otherwise an empty string.

    NaN is always invalid.
    """
    if not _shape_is_right(raw, field):
        return _expected(field, is_inch)
    if field.kind not in _NUMERIC or (is_inch is None and field.unit in LENGTH_UNITS):
        return ""
    # A bound in inches is not an exact binary number.
    low, high = field.minimum - 1e-9 * abs(field.minimum), field.maximum + 1e-9 * abs(field.maximum)
    parts = _parts(raw)
    inside = all(low <= convert_to_model_unit(part, field.unit, bool(is_inch)) <= high for part in parts)
    ordered = field.kind in {ValueKind.TRIPLE, ValueKind.NUMBERS} or parts == sorted(set(parts))
    return "" if inside and ordered else _expected(field, is_inch)


def _converted(raw: object, field: KeyField, inch: bool) -> KeyValue:
    if isinstance(raw, bool | str):
        return raw
    if field.kind is ValueKind.WORDS and isinstance(raw, list):
        return " ".join(word.strip() for word in raw)
    numbers = [convert_to_model_unit(part, field.unit, inch) for part in _parts(raw)]
    if field.kind is ValueKind.INTEGER:
        return int(numbers[0])
    if field.kind is ValueKind.TRIPLE:
        return numbers[0], numbers[1], numbers[2]
    if field.kind is ValueKind.NUMBERS:
        return tuple(numbers)
    return (numbers[0], numbers[1]) if field.kind is ValueKind.PAIR else numbers[0]


def _expected(field: KeyField, inch: bool | None) -> str:
    if field.kind is ValueKind.CHOICE:
        return Message(
            "one of these values: {choice}",
            choice=", ".join(format_toml_value(choice) for choice in field.choices),
        )
    if field.kind not in _NUMERIC or (inch is None and field.unit in LENGTH_UNITS):
        return str(field.kind.value)
    low = f"{convert_to_file_unit(field.minimum, field.unit, bool(inch)):.6g}"
    return f"{field.kind.value}, {low}…{format_value(field.maximum, field.unit, bool(inch))}"


def find_raw_value(data: object, path: str) -> object:
    """Return the unprocessed value at a path of a parsed file, or None if the path does not exist."""
    for key in path.split("."):
        data = data.get(key) if isinstance(data, dict) else None
    return data


# --- tables that drivers add ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class MachineFileReading:
    """A machine file that is being read, with the values that drivers and their rules need."""

    parsed_data: Mapping[str, object]
    file_values: FileValues
    axes: tuple[str, ...]  # axes of the machine
    terminals: Mapping[str, str]  # terminals of inputs and outputs, by path such as io.in.start
    tables: tuple[str, ...]  # paths of the driver tables in the file
    separate_device_inputs: Mapping[
        str, str
    ]  # inputs on a device outside the backend, such as a pendant, by path
    address_prefixes: tuple[str, ...]  # prefixes of the addresses on such devices

    def raw(self, path: str) -> object:
        """Return the unprocessed value at a path of the machine file, or None if the path does not exist."""
        return find_raw_value(self.parsed_data, path)

    def find_wired_pots(self) -> dict[str, str]:
        """Return the terminals of the wired potentiometers and handwheels by path."""
        paths = (f"io.analog.{name}.at" for name in self.list_table_keys("io.analog"))
        said = {path: self.file_values.text(path) for path in paths if self.file_values.has_values(path)}
        return {
            path.removesuffix(".at"): at
            for path, at in said.items()
            if not at.startswith(self.address_prefixes)
        }

    def list_table_keys(self, path: str) -> list[str]:
        """Return the keys of a table in which the machine owner chooses the keys."""
        table = self.raw(path)
        return list(table) if isinstance(table, dict) else []


def _nothing(_file: MachineFileReading) -> Iterable[FileFinding]:
    return ()


def _no_others(_file: MachineFileReading) -> Mapping[str, object]:
    return {}


@dataclass(frozen=True, slots=True)
class DriverTable:
    """A table of the machine file that belongs to a driver, with its keys, rules and dataclass.

    - ``child_tables`` are the names of inner tables, which ``read_children`` reads and checks.
    - ``read_other_values`` returns the attributes of the dataclass that are not keys. It is called if
      there are no findings.
    - ``check_rules`` checks every file, including a file without this table.
    - ``is_always_read`` means that a missing table gets its default values.
    - ``serial_port_key`` is the key that names a serial port.
    - ``purpose`` is the text of the reference page, and ``sub_tables`` are the tables inside this table.
    """

    path: str
    key_class: type[DataclassInstance]
    read_other_values: Callable[[MachineFileReading], Mapping[str, object]] = _no_others
    child_tables: tuple[str, ...] = ()
    read_children: Callable[[MachineFileReading], Iterable[FileFinding]] = _nothing
    check_rules: Callable[[MachineFileReading], Iterable[FileFinding]] = _nothing
    is_always_read: bool = False
    serial_port_key: str = ""
    _: KW_ONLY
    purpose: str
    sub_tables: tuple[TableDescription, ...] = ()

    def make_model(self, file: MachineFileReading) -> object:
        """Return the dataclass object with the values of the table."""
        return file.file_values.make_model(self.key_class, self.path, **self.read_other_values(file))


@dataclass(frozen=True, slots=True)
class DriverDeclaration:
    """A driver as described in the machine file.

    - ``backend_name`` and ``spindle`` are the driver's names in machine.backend and spindle.driver.
      ``backend_name`` is empty for a driver that is used in addition to a backend.
    - ``can_orient_spindle`` means that the spindle can stop at an angle.
    - ``max_count_rate`` is the highest rate in counts per second that the driver accepts for an axis.
    - ``normalize_terminal`` returns the same value for equivalent terminal addresses, and None for an
      address of another driver.
    - ``inputs`` yields the possible input addresses in order.
    - ``address_prefix`` is the prefix of the addresses of a device that is not part of the backend.
    """

    tables: tuple[DriverTable, ...]
    backend_name: str = ""
    spindle: str = ""
    can_orient_spindle: bool = False
    max_count_rate: float = inf
    normalize_terminal: Callable[[MachineFileReading, str], object] | None = None
    inputs: Callable[[], Iterator[str]] | None = None
    address_prefix: str = ""


def make_table_finding(path: str, raw: object) -> FileFinding:
    """Return the finding for a value that must be a table but is not."""
    return FileFinding(
        path,
        format_toml_value(raw),
        Message("this entry must be a table, [{path}]", path=path),
        "not-a-table",
    )


def read_named_tables(raw: object, keys: KeySchema, path: str, values: FileValues) -> list[FileFinding]:
    """Read every nested table of a table in which the machine owner chooses the names.

    Each nested table is read with ``read_table_values``.
    """
    if not isinstance(raw, dict):
        return [make_table_finding(path, raw)]
    return [
        found
        for name, entry in raw.items()
        for found in read_table_values(entry, keys, join_path(path, name), values)
    ]


def read_axes_and_spindle(
    file: MachineFileReading, axes: tuple[str, type], spindle: tuple[str, type]
) -> Iterator[FileFinding]:
    """Read a driver's tables for the axes and for the spindle; yield the findings.

    ``axes`` and ``spindle`` each contain a table's path and its class. Both tables may be missing from the
    file.
    """
    (path, kind), (spindle_path, spindle_kind) = axes, spindle
    named, turns = file.raw(path), file.raw(spindle_path)
    if isinstance(named, dict):
        yield from find_unknown_keys(named, list(file.axes), path)
        named = {name: entry for name, entry in named.items() if name in file.axes}
    yield from read_named_tables({} if named is None else named, kind, path, file.file_values)
    if turns is None or isinstance(turns, dict):
        yield from read_table_values(turns or {}, spindle_kind, spindle_path, file.file_values)
    else:
        yield make_table_finding(spindle_path, turns)
