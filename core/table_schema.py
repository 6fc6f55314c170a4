"""Declaration of the tables of a machine file, and the reader that checks them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from dataclasses import fields as fields_of
from math import inf
from typing import TYPE_CHECKING, NamedTuple, TypeGuard, TypeVar

from core.key_declaration import LENGTHS, Field, Kind, Pair, Schema, Value, keys_of, shown, to_file, to_model
from core.message import CodedError, Message, nearest

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

# --- Findings in a machine file, all reported together, each with path, value and expected value.


class Finding(NamedTuple):
    """An error in a machine file: path of the key, value in the file, and expected value.

    ``code`` identifies the error for tests, as in ``CodedError``.
    """

    path: str
    value: str
    expected: str
    code: str = ""

    def __str__(self) -> str:
        where = f"{self.path} = {self.value}" if self.value else self.path
        return " ".join(f"{where}: {self.expected}".splitlines())  # a TOML key may contain a line break


class MachineFileError(CodedError):
    """A machine file cannot be used. ``errors`` has all findings, and ``source`` the name of the file.

    ``code`` has the codes of the findings in order.
    """

    def __init__(self, errors: Sequence[Finding], source: str) -> None:
        self.errors = tuple(errors)
        self.source = source
        text = "; ".join(str(finding) for finding in self.errors)
        super().__init__(f"{source}: {text}", " ".join(each.code for each in self.errors if each.code))


_Model = TypeVar("_Model", bound="DataclassInstance")


_HUGE = 10**300
_NUMERIC = frozenset((Kind.NUMBER, Kind.WHOLE, Kind.PAIR, Kind.TRIPLE, Kind.NUMBERS))


@dataclass(frozen=True, slots=True)
class TableReference:
    """Description of a table for the reference page of the machine file.

    ``heading`` is the table's name in the file, with … in place of a name that the owner chooses.
    """

    heading: str
    purpose: str
    keys: Schema = ()


class Values:
    """Values of a machine file by path, in the model's units.

    Lengths can be read only when the unit of the file is known.
    """

    def __init__(self, inch: bool | None) -> None:
        self.inch = inch
        self.found: dict[str, Value] = {}
        self.wrong: set[str] = set()  # invalid or missing values, which cause no further findings
        self.left_out: dict[str, Field] = {}  # derived values that are not in the file

    def has(self, *paths: str) -> bool:
        return all(path in self.found for path in paths)

    def stated(self, path: str) -> bool:
        """Return whether the file contains the value, valid or invalid."""
        return path in self.found or path in self.wrong

    def number(self, path: str) -> float:
        value = self.found[path]
        if isinstance(value, str | tuple):
            raise TypeError(f"{path} holds no number")
        return float(value)

    def flag(self, path: str) -> bool:
        return self.found[path] is True

    def text(self, path: str) -> str:
        return str(self.found[path])

    def says(self, path: str, text: str) -> bool:
        """Return whether the file has this valid text at the path."""
        return self.has(path) and self.text(path) == text

    def whole(self, path: str) -> int:
        return int(self.number(path))

    def pair(self, path: str) -> Pair:
        value = self.found[path]
        if not isinstance(value, tuple) or len(value) != 2:
            raise TypeError(f"{path} holds no pair")
        return value

    def numbers(self, path: str) -> tuple[float, ...]:
        value = self.found[path]
        if not isinstance(value, tuple):
            raise TypeError(f"{path} holds no list")
        return value

    def model(
        self, kind: type[_Model], path: str, keys: Mapping[str, str] = {}, /, **given: object
    ) -> _Model:
        """Return a table as a dataclass, if it has no errors.

        A field gets the value of its key, of the key that ``keys`` specifies for it, or from ``given``.
        """
        keys = keys or {each.attribute: each.key for each in keys_of(kind)}
        names = [field.name for field in fields_of(kind) if field.name not in given]
        said = {name: self.found[f"{path}.{keys.get(name, name)}"] for name in names}
        return kind(**said, **given)


# Keys whose values contain passwords or tokens. Addresses may contain them before @, in the path or after the
# question mark. A removed key may still occur in older files, which are compared with newer ones.
_SECRETS = frozenset(
    {
        "announce.hook",
        "announce.password",
        "sharing.git",
        "sharing.postgresql",
        "status_page.agents",
        "status_page.desks",
        "status_page.token",
    }
)
HIDDEN = "***"
# Keys of earlier versions, with their replacements.
_REMOVED = {
    "sharing.git": (
        "sharing by git was removed; use a folder (key folder) or a PostgreSQL database (key postgresql)"
    )
}


def written(value: object) -> str:
    """Return a value in TOML syntax, shortened for a message."""
    if isinstance(value, bool):
        return "true" if value else "false"
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."


def written_openly(path: str, value: object) -> str:
    """Return a value in TOML syntax, masked if it contains a password or token."""
    return HIDDEN if path in _SECRETS else written(value)


def joined(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def unknown_keys(table: Mapping[str, object], known: list[str], path: str) -> list[Finding]:
    """Return a finding for every unknown key, with the most similar known key or its replacement."""
    found = []
    for key in table:
        place = joined(path, key)
        if place in _REMOVED:
            found.append(Finding(place, "", _REMOVED[place], "removed-key"))
        elif key not in known:
            near = nearest(key, known)
            hint = (
                Message("did you mean {nearest}?", nearest=near)
                if near
                else Message("use one of these keys: {known}", known=", ".join(known))
            )
            found.append(Finding(place, "", Message("unknown key; {hint}", hint=hint), "unknown-key"))
    return found


def read_table(
    table: object, keys: Schema, path: str, values: Values, children: tuple[str, ...] = ()
) -> list[Finding]:
    """Store all valid values of ``table`` in ``values`` under ``path``; return the findings.

    ``children`` are inner tables that are read elsewhere.
    """
    if not isinstance(table, dict):
        return [
            Finding(
                path,
                written(table),
                Message("this entry must be a table, [{path}]", path=path),
                "not-a-table",
            )
        ]
    fields = keys_of(keys)
    findings = unknown_keys(table, [*(field.key for field in fields), *children], path)
    for field in fields:
        place = joined(path, field.key)
        raw = table.get(field.key)
        if raw is None:
            findings += _default(field, place, values)
        elif problem := _problem(raw, field, values.inch):
            values.wrong.add(place)
            findings.append(Finding(place, written_openly(place, raw), f"expected {problem}", "wrong-value"))
        elif values.inch is not None or field.unit not in LENGTHS:
            values.found[place] = _converted(raw, field, bool(values.inch))
    return findings


def _default(field: Field, place: str, values: Values) -> list[Finding]:
    if field.derived:
        values.left_out[place] = field
        return []
    if field.default is None:
        values.wrong.add(place)
        return [missing(place, field, values.inch)]
    values.found[place] = field.default
    return []


def missing(place: str, field: Field, inch: bool | None) -> Finding:
    """Return the finding for a required value that is missing."""
    return Finding(
        place,
        "",
        Message("this value is missing; expected {field}", field=_expected(field, inch)),
        "missing",
    )


def _number(raw: object) -> TypeGuard[int | float]:
    return isinstance(raw, int | float) and not isinstance(raw, bool)


def _shape_is_right(raw: object, field: Field) -> bool:
    match field.kind:
        case Kind.NUMBER:
            return _number(raw)
        case Kind.WHOLE:
            return isinstance(raw, int) and not isinstance(raw, bool)
        case Kind.FLAG:
            return isinstance(raw, bool)
        case Kind.TEXT | Kind.WORDS:
            return _is_words(raw) if field.kind is Kind.WORDS else isinstance(raw, str) and bool(raw.strip())
        case Kind.PAIR | Kind.TRIPLE | Kind.NUMBERS:
            counts = {Kind.PAIR: (2,), Kind.TRIPLE: (3,)}.get(field.kind, range(1, 5))
            return isinstance(raw, list) and len(raw) in counts and all(_number(part) for part in raw)
        case Kind.CHOICE:
            return any(raw is choice or (isinstance(raw, str) and raw == choice) for choice in field.choices)


def _is_words(raw: object) -> bool:
    return isinstance(raw, list) and all(isinstance(each, str) and len(each.split()) == 1 for each in raw)


def _parts(raw: object) -> list[float]:
    """Return the numbers in a value. Whole numbers too large for a float become infinite."""
    numbers = [part for part in (raw if isinstance(raw, list) else [raw]) if _number(part)]
    return [float(part) if abs(part) < _HUGE else inf for part in numbers]


def _problem(raw: object, field: Field, inch: bool | None) -> str:
    """Return the expected value if ``raw`` is invalid, otherwise an empty text. NaN is always invalid."""
    if not _shape_is_right(raw, field):
        return _expected(field, inch)
    if field.kind not in _NUMERIC or (inch is None and field.unit in LENGTHS):
        return ""
    # A bound in inches is not an exact binary number.
    low, high = field.low - 1e-9 * abs(field.low), field.high + 1e-9 * abs(field.high)
    parts = _parts(raw)
    inside = all(low <= to_model(part, field.unit, bool(inch)) <= high for part in parts)
    ordered = field.kind in {Kind.TRIPLE, Kind.NUMBERS} or parts == sorted(set(parts))
    return "" if inside and ordered else _expected(field, inch)


def _converted(raw: object, field: Field, inch: bool) -> Value:
    if isinstance(raw, bool | str):
        return raw
    if field.kind is Kind.WORDS and isinstance(raw, list):
        return " ".join(word.strip() for word in raw)
    numbers = [to_model(part, field.unit, inch) for part in _parts(raw)]
    if field.kind is Kind.WHOLE:
        return int(numbers[0])
    if field.kind is Kind.TRIPLE:
        return numbers[0], numbers[1], numbers[2]
    if field.kind is Kind.NUMBERS:
        return tuple(numbers)
    return (numbers[0], numbers[1]) if field.kind is Kind.PAIR else numbers[0]


def _expected(field: Field, inch: bool | None) -> str:
    if field.kind is Kind.CHOICE:
        return Message(
            "one of these values: {choice}", choice=", ".join(written(choice) for choice in field.choices)
        )
    if field.kind not in _NUMERIC or (inch is None and field.unit in LENGTHS):
        return str(field.kind.value)
    low = f"{to_file(field.low, field.unit, bool(inch)):.6g}"
    return f"{field.kind.value}, {low}…{shown(field.high, field.unit, bool(inch))}"


def raw_at(data: object, path: str) -> object:
    """Return the value at a path of a parsed file, or None."""
    for key in path.split("."):
        data = data.get(key) if isinstance(data, dict) else None
    return data


# --- tables that drivers add ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FileReading:
    """A machine file while its tables are read, for the rules and values of drivers."""

    data: Mapping[str, object]
    values: Values
    axes: tuple[str, ...]  # axes of the machine
    terminals: Mapping[str, str]  # terminals of inputs and outputs, by path such as io.in.start
    tables: tuple[str, ...]  # paths of the driver tables in the file
    elsewhere: Mapping[str, str]  # inputs on a device outside the backend, such as a pendant, by path
    prefixes: tuple[str, ...]  # prefixes of the addresses on such devices

    def raw(self, path: str) -> object:
        """Return the unprocessed value at a path of the file, or None."""
        return raw_at(self.data, path)

    def pots(self) -> dict[str, str]:
        """Return the terminals of the wired pots and handwheels, by path."""
        paths = (f"io.analog.{name}.at" for name in self.names("io.analog"))
        said = {path: self.values.text(path) for path in paths if self.values.has(path)}
        return {path.removesuffix(".at"): at for path, at in said.items() if not at.startswith(self.prefixes)}

    def names(self, path: str) -> list[str]:
        """Return the keys of a table whose names the owner chooses."""
        table = self.raw(path)
        return list(table) if isinstance(table, dict) else []


def _nothing(_file: FileReading) -> Iterable[Finding]:
    return ()


def _no_others(_file: FileReading) -> Mapping[str, object]:
    return {}


@dataclass(frozen=True, slots=True)
class DriverTable:
    """A table of the machine file that belongs to a driver, with its keys, rules and dataclass.

    ``children`` are inner tables that ``read_children`` reads; it returns their findings. ``others`` returns
    the attributes of the dataclass that are not keys, if there are no findings. ``rules`` checks every file,
    even a file without this table. ``always`` means that a missing table gets its defaults. ``port`` is the
    key with a serial port. ``purpose`` is the text of the reference page, and ``parts`` are the tables
    inside.
    """

    path: str
    keys: type[DataclassInstance]
    others: Callable[[FileReading], Mapping[str, object]] = _no_others
    children: tuple[str, ...] = ()
    read_children: Callable[[FileReading], Iterable[Finding]] = _nothing
    rules: Callable[[FileReading], Iterable[Finding]] = _nothing
    always: bool = False
    port: str = ""
    _: KW_ONLY
    purpose: str
    parts: tuple[TableReference, ...] = ()

    def model(self, file: FileReading) -> object:
        """Return the object with the values of the table."""
        return file.values.model(self.keys, self.path, **self.others(file))


@dataclass(frozen=True, slots=True)
class Driver:
    """A driver as described in the machine file; ``backend`` is empty for a driver in addition to a backend.

    ``backend`` and ``spindle`` are its names in machine.backend and spindle.driver. ``orients`` means that
    its spindle can stop at an angle. ``count_rate`` is the highest rate in counts per second that it accepts
    for an axis. ``terminal`` returns equal values for equivalent addresses, and None for an address of
    another driver. ``inputs`` yields the possible addresses of inputs in order. ``prefix`` begins the
    addresses on the driver's own device outside the backend.
    """

    tables: tuple[DriverTable, ...]
    backend: str = ""
    spindle: str = ""
    orients: bool = False
    count_rate: float = inf
    terminal: Callable[[FileReading, str], object] | None = None
    inputs: Callable[[], Iterator[str]] | None = None
    prefix: str = ""


def expected_table(path: str, raw: object) -> Finding:
    """Return the finding for a value that should be a table."""
    return Finding(
        path, written(raw), Message("this entry must be a table, [{path}]", path=path), "not-a-table"
    )


def read_named(raw: object, keys: Schema, path: str, values: Values) -> list[Finding]:
    """Read every inner table of a table whose names the owner chooses, as ``read_table`` does."""
    if not isinstance(raw, dict):
        return [expected_table(path, raw)]
    return [
        found for name, entry in raw.items() for found in read_table(entry, keys, joined(path, name), values)
    ]


def read_axes_and_spindle(
    file: FileReading, axes: tuple[str, type], spindle: tuple[str, type]
) -> Iterator[Finding]:
    """Read a driver's tables for the axes and for the spindle; yield the findings.

    Each table is given by its path and class. Both tables may be missing from the file.
    """
    (path, kind), (spindle_path, spindle_kind) = axes, spindle
    named, turns = file.raw(path), file.raw(spindle_path)
    if isinstance(named, dict):
        yield from unknown_keys(named, list(file.axes), path)
        named = {name: entry for name, entry in named.items() if name in file.axes}
    yield from read_named({} if named is None else named, kind, path, file.values)
    if turns is None or isinstance(turns, dict):
        yield from read_table(turns or {}, spindle_kind, spindle_path, file.values)
    else:
        yield expected_table(spindle_path, turns)
