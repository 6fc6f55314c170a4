"""The offsets file: [tool.1] x z nose_radius …, [secondary.1] x z r, in inches; also part of an export."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from app.cli.toml_file import read_toml, refuse, unknown
from app.cli.zero_file import TABLE
from core.interpreter.job_setup import SecondaryOffset, ToolOffset
from core.store.fields import FIELDS, Field, Sort
from core.store.rows import MM_PER_INCH, OFFSETS, Kind, SecondaryRow, ToolRow, Value

_NUMBERS = {str(number): number for number in OFFSETS}
_KINDS = {kind.value: kind for kind in Kind}
_EXPECTED = {
    Sort.LENGTH: "a number of inches",
    Sort.WHOLE: "a whole number",
    Sort.TEXT: "a text",
    Sort.FLAG: "true or false",
}


def read_offsets(path: Path) -> tuple[dict[int, ToolOffset], dict[int, SecondaryOffset]]:
    """Tool (geometry and wear together) and secondary offsets in mm by number, for the interpreter.

    Raises CommandError naming every mistake.
    """
    tools, secondary = read_rows(path)
    return (
        {n: ToolOffset(*row.offset, row.nose_radius) for n, row in tools.items()},
        {n: SecondaryOffset(*row) for n, row in secondary.items()},
    )


def read_rows(path: Path) -> tuple[dict[int, ToolRow], dict[int, SecondaryRow]]:
    """Every field of the file as the store keeps it, lengths in mm; a missing key is 0 or empty.

    Raises CommandError naming every mistake.
    """
    data = read_toml(path)
    mistakes = [unknown(key, _KINDS) for key in data if key not in {*_KINDS, TABLE}]
    tools = {n: ToolRow(**values) for n, values in _table(data, Kind.TOOL, mistakes)}  # type: ignore[arg-type]
    secondary = {
        n: SecondaryRow(**values)  # type: ignore[arg-type]
        for n, values in _table(data, Kind.SECONDARY, mistakes)
    }
    masters = [f"tool.{n}" for n, row in tools.items() if row.master]
    if len(masters) > 1:
        mistakes.append(f"{' and '.join(masters)} are both master; one tool at most is")
    refuse(path, mistakes)
    return tools, secondary


def _table(
    data: dict[str, object], kind: Kind, mistakes: list[str]
) -> Iterator[tuple[int, dict[str, Value]]]:
    table = data.get(kind.value, {})
    if not isinstance(table, dict):
        mistakes.append(f"{kind} must hold tables such as [{kind}.1]")
        return
    for name, entry in table.items():
        if name not in _NUMBERS:
            mistakes.append(f"[{kind}.{name}] does not exist; offsets are 1…32")
        elif not isinstance(entry, dict):
            mistakes.append(f"{kind}.{name} must be a table, [{kind}.{name}]")
        else:
            yield _NUMBERS[name], _values(entry, kind, name, mistakes)


def _values(entry: dict[str, object], kind: Kind, name: str, mistakes: list[str]) -> dict[str, Value]:
    known, values = FIELDS[kind], {}
    for key, value in entry.items():
        where = f"{kind}.{name}.{key}"
        if key not in known:
            mistakes.append(f"[{kind}.{name}] {unknown(key, known)}")
            continue
        field = known[key]
        if not _fits(field, value):
            mistakes.append(f"{where} must be {_EXPECTED[field.sort]}")
        elif mistake := out_of_range(field, kept := _kept(field, value)):
            mistakes.append(f"{where} = {shown(value)} {mistake}")
        else:
            values[key] = kept
    return values


def _fits(field: Field, value: object) -> bool:
    """Whether TOML gave the sort of value that this field is."""
    if isinstance(value, bool):
        return field.sort is Sort.FLAG
    if isinstance(value, str):
        return field.sort is Sort.TEXT
    return isinstance(value, int | float) and field.sort in {Sort.LENGTH, Sort.WHOLE}


def _kept(field: Field, value: object) -> Value:
    if field.sort is Sort.LENGTH and isinstance(value, int | float):
        return value * MM_PER_INCH
    return value if isinstance(value, int | float | str) else 0.0


def shown(value: object) -> str:
    """A value as a sentence repeats it."""
    return f"{value:g}" if isinstance(value, int | float) else repr(value)


def out_of_range(field: Field, value: Value) -> str:
    """What is wrong with a value (lengths mm), or nothing; NaN is out of every range."""
    return "" if field.takes(value) else f"is out of range; expected {field.range}"
