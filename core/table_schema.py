"""How a table of the machine file is declared, and the one reader that checks any of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from dataclasses import fields as fields_of
from math import inf
from typing import TYPE_CHECKING, NamedTuple, TypeGuard, TypeVar

from core.coded_error import CodedError
from core.key_declaration import (
    LENGTHS,
    Field,
    Kind,
    Pair,
    Schema,
    Value,
    keys_of,
    shown,
    to_file,
    to_model,
)
from core.message import Message
from core.nearest import nearest

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

# --- What is wrong with a machine file: all of it at once, each with path, value and what was expected.


class Finding(NamedTuple):
    """One thing that is wrong: the key's path, the value as the file has it, what would be right.

    ``code`` names the fault for tests, as in ``CodedError``.
    """

    path: str
    value: str
    expected: str
    code: str = ""

    def __str__(self) -> str:
        where = f"{self.path} = {self.value}" if self.value else self.path
        return " ".join(f"{where}: {self.expected}".splitlines())  # a key of TOML may hold a line end


class MachineFileError(CodedError):
    """A machine file cannot be used. ``errors`` holds every finding, ``source`` the file's name.

    ``code`` holds the codes of the findings, in their order.
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
    """A table as the reference of the machine file shows it.

    ``heading`` is the table's name in the file, with … in the place of a name that the owner chooses.
    """

    heading: str
    purpose: str
    keys: Schema = ()


class Values:
    """Values by path in the model's units; lengths are known only once the file's unit is."""

    def __init__(self, inch: bool | None) -> None:
        self.inch = inch
        self.found: dict[str, Value] = {}
        self.wrong: set[str] = set()  # refused or missing: it draws no second finding elsewhere
        self.left_out: dict[str, Field] = {}  # derived values that the file does not say

    def has(self, *paths: str) -> bool:
        return all(path in self.found for path in paths)

    def stated(self, path: str) -> bool:
        """Whether the file says it, rightly or wrongly."""
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
        """Whether the file rightly says this word there."""
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
        """A table as a dataclass, once nothing is wrong with it.

        A field has the value of its key, or of the key that ``keys`` names for it, or is ``given``.
        """
        keys = keys or {each.attribute: each.key for each in keys_of(kind)}
        names = [field.name for field in fields_of(kind) if field.name not in given]
        said = {name: self.found[f"{path}.{keys.get(name, name)}"] for name in names}
        return kind(**said, **given)


# Keys whose values hold passwords or tokens: also addresses, which have them in front of @, in the path or
# behind the question mark. A removed key is still in older files, which are compared with newer ones.
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
# Keys of earlier versions, with what to use in their place.
_REMOVED = {
    "sharing.git": (
        "sharing by git was removed; use a folder (key folder) or a PostgreSQL database (key postgresql)"
    )
}


def written(value: object) -> str:
    """A value the way TOML writes it, short enough for a sentence."""
    if isinstance(value, bool):
        return "true" if value else "false"
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."


def written_openly(path: str, value: object) -> str:
    """A value as TOML writes it, hidden if it holds a password or a token."""
    return HIDDEN if path in _SECRETS else written(value)


def joined(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def unknown_keys(table: Mapping[str, object], known: list[str], path: str) -> list[Finding]:
    """A finding for every key nobody reads, with the nearest one that is read, or what replaces it."""
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
    """Puts every good value of ``table`` into ``values`` under ``path``; returns what is wrong.

    ``children`` are tables inside that somebody else reads.
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
    """The finding about a value that the file has to say and does not."""
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
    """The numbers in a value: none, one or two. A whole number too large for a float counts as endless."""
    numbers = [part for part in (raw if isinstance(raw, list) else [raw]) if _number(part)]
    return [float(part) if abs(part) < _HUGE else inf for part in numbers]


def _problem(raw: object, field: Field, inch: bool | None) -> str:
    """What was expected instead of ``raw``, or nothing. NaN fails every range."""
    if not _shape_is_right(raw, field):
        return _expected(field, inch)
    if field.kind not in _NUMERIC or (inch is None and field.unit in LENGTHS):
        return ""
    # A bound written in inches is no binary number.
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
    """What stands in a parsed file at a path; None: nothing."""
    for key in path.split("."):
        data = data.get(key) if isinstance(data, dict) else None
    return data


# --- tables that drivers add ------------------------------------------------------------------------------


AT_PENDANT = "pendant."  # begins the address of a button or wheel of a pendant, which no backend knows


@dataclass(frozen=True, slots=True)
class FileReading:
    """A machine file of which the tables are read: what a driver may look at for its own rules and values."""

    data: Mapping[str, object]
    values: Values
    axes: tuple[str, ...]  # of the machine
    terminals: Mapping[str, str]  # of its inputs and outputs, by path: io.in.start → where it is wired
    tables: tuple[str, ...]  # paths of the tables of drivers that are there
    at_pendant: Mapping[str, str]  # what of them is not wired, but at a pendant

    def raw(self, path: str) -> object:
        """What stands in the file at a path, read or not; None: nothing."""
        return raw_at(self.data, path)

    def pots(self) -> dict[str, str]:
        """The terminals of its pots and wheels that are wired, by path."""
        paths = (f"io.analog.{name}.at" for name in self.names("io.analog"))
        said = {path: self.values.text(path) for path in paths if self.values.has(path)}
        return {path.removesuffix(".at"): at for path, at in said.items() if not at.startswith(AT_PENDANT)}

    def names(self, path: str) -> list[str]:
        """The keys of a table whose names are of the owner's choice."""
        table = self.raw(path)
        return list(table) if isinstance(table, dict) else []


def _nothing(_file: FileReading) -> Iterable[Finding]:
    return ()


def _no_others(_file: FileReading) -> Mapping[str, object]:
    return {}


@dataclass(frozen=True, slots=True)
class DriverTable:
    """A table of the machine file that belongs to a driver: its keys, its rules, and what it becomes.

    ``children`` are tables inside it, read by ``read_children``, which returns what is wrong with them.
    ``others`` returns what the table's object has in addition to its keys, once nothing is wrong.
    ``rules`` looks at every file, also one without this table.
    ``always``: a file without it has its defaults. ``port`` is the key that names a serial port.
    ``purpose`` is what the reference says about the table, ``parts`` the tables inside it.
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
        """The object that holds the values of the table."""
        return file.values.model(self.keys, self.path, **self.others(file))


@dataclass(frozen=True, slots=True)
class Driver:
    """A driver in the machine file; without ``backend`` it stands beside one.

    ``backend`` and ``spindle`` are its words in machine.backend and spindle.driver, ``orients``: that spindle
    can be stopped at an angle. ``count_rate`` the counts
    per second that it takes on an axis. ``terminal`` makes two ways to write one terminal equal, None for
    what is no address of this driver; ``inputs`` are the addresses that an input may have, in their order.
    ``after``: of an optional feature, the table that its tables follow in the reference.
    """

    tables: tuple[DriverTable, ...]
    backend: str = ""
    spindle: str = ""
    orients: bool = False
    count_rate: float = inf
    terminal: Callable[[FileReading, str], object] | None = None
    inputs: Callable[[], Iterator[str]] | None = None
    after: str = ""


def expected_table(path: str, raw: object) -> Finding:
    """The finding about something that is no table."""
    return Finding(
        path, written(raw), Message("this entry must be a table, [{path}]", path=path), "not-a-table"
    )


def read_named(raw: object, keys: Schema, path: str, values: Values) -> list[Finding]:
    """As ``read_table`` for every table inside one whose names are of the owner's choice."""
    if not isinstance(raw, dict):
        return [expected_table(path, raw)]
    return [
        found for name, entry in raw.items() for found in read_table(entry, keys, joined(path, name), values)
    ]


def read_axes_and_spindle(
    file: FileReading, axes: tuple[str, type], spindle: tuple[str, type]
) -> Iterator[Finding]:
    """A driver's tables by axis and for the spindle, each by its path and class; either may be left out."""
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
