"""The offsets file that users write.

[tool.1] and [secondary.1] are in inches, and [zero.54] is in mm and degrees. The file is part of an export. A
tools file contains the tool shapes in the same tables [tool.1], which are also allowed in the offsets file.
Lengths are in inches, angles in degrees, and outlines (holder, profile) are texts in mm. Further cutting
edges of a tool are [tool.1.d2] to [tool.1.d9]. All mistakes of a file are reported together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.desk.toml_file import read_toml, refuse, unknown, unknown_key
from core.message import CodedError, Message
from core.store.store_rows import (
    FIELDS,
    MM_PER_INCH,
    OFFSETS,
    ZERO_CODES,
    Field,
    Kind,
    SecondaryRow,
    ShapeRow,
    Sort,
    ToolRow,
    Value,
    ZeroRow,
    with_fields,
)
from core.tool_edges import EDGES, edge_key, edge_of, tool_of

if TYPE_CHECKING:
    from core.part.tool_shape import ToolShape

_KINDS = (Kind.TOOL, Kind.SECONDARY)
_NUMBERS = {
    Kind.TOOL: ({str(number): number for number in OFFSETS}, "offset numbers are 1…32"),
    Kind.SECONDARY: ({str(number): number for number in OFFSETS}, "offset numbers are 1…32"),
    Kind.ZERO: ({str(code): code for code in ZERO_CODES}, ("settable zero offsets are 54…59 (G54 to G59)")),
}
_EXPECTED = {
    Sort.LENGTH: "a number in inches",
    Sort.METRIC: "a number in mm",
    Sort.ANGLE: "a number in degrees",
    Sort.WHOLE: "a whole number",
    Sort.TEXT: "a text",
    Sort.FLAG: "true or false",
}
TOOL_KEYS: Mapping[str, Field] = {**FIELDS[Kind.TOOL], **FIELDS[Kind.SHAPE]}
_EDGE_KEYS = frozenset(f"d{edge}" for edge in EDGES[1:])
ALIASES = {"tip": "quadrant"}  # Name of the field in tool data sheets.


def read_rows(path: Path) -> tuple[dict[int, ToolRow], dict[int, SecondaryRow], dict[int, ZeroRow]]:
    """Return the tool, secondary and zero offsets of a file as rows of the store.

    A missing key is 0 or empty. A tool with a shape but without X and Z has no offset, because its tip
    position is not specified. Raises CommandError with all mistakes.
    """
    data = read_toml(path)
    mistakes = _unknown_tables(data)
    tools = _tools(data, mistakes).placed
    secondary = {
        n: with_fields(SecondaryRow(), values) for n, values in _table(data, Kind.SECONDARY, mistakes)
    }
    masters = [f"tool.{n}" for n, row in tools.items() if row.master]
    mistakes += [
        CodedError(
            Message(
                "[tool.{number}.d{number2}] is an edge of T{number3}, but that tool has no X and Z values",
                number=tool_of(n),
                number2=edge_of(n),
                number3=tool_of(n),
            ),
            "edge-without-tool",
        )
        for n in tools
        if tool_of(n) not in tools
    ]
    if len(masters) > 1:
        mistakes.append(
            CodedError(
                Message(
                    "{masters} are both set as master; only one tool can be the master",
                    masters=" and ".join(masters),
                ),
                "two-masters",
            )
        )
    zero = {code: with_fields(ZeroRow(), values) for code, values in _table(data, Kind.ZERO, mistakes)}
    refuse(path, mistakes)
    return tools, secondary, zero


def read_shape_rows(path: Path) -> dict[int, ShapeRow]:
    """Return the tool shapes of a file as rows of the store. Raises CommandError with all mistakes."""
    data = read_toml(path)
    mistakes = _unknown_tables(data)
    shapes = _tools(data, mistakes).shapes
    refuse(path, mistakes)
    return shapes


def read_tool_shapes(path: Path) -> dict[int, ToolShape]:
    """Return the tools of a file that have a shape, in mm, with the nose radius and tip of the same table.

    Lengths are in inches in the file. Outlines of holder and profile are texts in mm. Raises CommandError
    with all mistakes.
    """
    data = read_toml(path)
    mistakes = _unknown_tables(data)
    found = _tools(data, mistakes)
    refuse(path, mistakes)
    if not found.shapes:
        return {}
    from app.desk.stored_shapes import tool_shapes

    return tool_shapes(found.shapes, found.rows)


def _unknown_tables(data: dict[str, object]) -> list[CodedError]:
    return [unknown_key(key, _KINDS) for key in data if key not in {*_KINDS, Kind.ZERO}]


class _Tools(NamedTuple):
    """The tools of a file: all offsets, the offsets with a specified position, and the shapes."""

    rows: dict[int, ToolRow]
    placed: dict[int, ToolRow]
    shapes: dict[int, ShapeRow]


def _tools(data: dict[str, object], mistakes: list[CodedError]) -> _Tools:
    found = _Tools({}, {}, {})
    for number, values in _table(data, Kind.TOOL, mistakes):
        shape = {name: value for name, value in values.items() if name in FIELDS[Kind.SHAPE]}
        offset = {name: value for name, value in values.items() if name not in shape}
        found.rows[number] = with_fields(ToolRow(), offset)
        if not shape or {"x", "z"} & offset.keys():
            found.placed[number] = found.rows[number]
        if shape:
            found.shapes[number] = with_fields(ShapeRow(), shape)
            mistakes += _shape_mistakes(number, found.shapes[number], found.rows[number])
    return found


def _shape_mistakes(number: int, row: ShapeRow, tool: ToolRow) -> Iterator[CodedError]:
    from app.desk.stored_shapes import row_mistakes

    if not row.kind:
        kinds = FIELDS[Kind.SHAPE]["kind"].range
        text = Message(
            "[tool.{number}] has a shape but no kind; set kind to one of {kinds}",
            number=number,
            kinds=kinds,
        )
        yield CodedError(text, "no-kind")
        return
    for wrong in row_mistakes(row, tool):
        yield CodedError(
            Message("tool.{number}.{field}: {wrong}", number=number, field=wrong.field, wrong=wrong.text),
            "invalid-shape",
        )


def _table(
    data: dict[str, object], kind: Kind, mistakes: list[CodedError]
) -> Iterator[tuple[int, dict[str, Value]]]:
    table, (numbers, those) = data.get(kind.value, {}), _NUMBERS[kind]
    if not isinstance(table, dict):
        mistakes.append(
            CodedError(
                Message(
                    "{kind} must contain tables such as [{kind2}.{numbers}]",
                    kind=kind,
                    kind2=kind,
                    numbers=next(iter(numbers)),
                ),
                "not-tables",
            )
        )
        return
    for name, entry in table.items():
        if name not in numbers:
            mistakes.append(
                CodedError(
                    Message("[{kind}.{name}] does not exist; {those}", kind=kind, name=name, those=those),
                    "unknown-number",
                )
            )
        elif not isinstance(entry, dict):
            mistakes.append(
                CodedError(
                    Message(
                        "{kind}.{name} must be a table, [{kind2}.{name2}]",
                        kind=kind,
                        name=name,
                        kind2=kind,
                        name2=name,
                    ),
                    "not-a-table",
                )
            )
        else:
            edges = _edges(entry) if kind is Kind.TOOL else {}
            own = {key: value for key, value in entry.items() if key not in edges}
            if own or not edges:
                yield numbers[name], _values(own, kind, name, mistakes)
            for key, values in edges.items():
                if not isinstance(values, dict):
                    mistakes.append(
                        CodedError(
                            Message(
                                "tool.{name}.{key} must be a table, [tool.{name2}.{key2}]",
                                name=name,
                                key=key,
                                name2=name,
                                key2=key,
                            ),
                            "not-a-table",
                        )
                    )
                    continue
                yield (
                    edge_key(numbers[name], int(key[1])),
                    _values(values, kind, Message("{name}.{key}", name=name, key=key), mistakes),
                )


def _edges(entry: dict[str, object]) -> dict[str, object]:
    """Return the further cutting edges of a tool, [tool.1.d2] to [tool.1.d9], by their keys."""
    return {key: value for key, value in entry.items() if key in _EDGE_KEYS}


def _values(entry: dict[str, object], kind: Kind, name: str, mistakes: list[CodedError]) -> dict[str, Value]:
    known = TOOL_KEYS if kind is Kind.TOOL else FIELDS[kind]
    values: dict[str, Value] = {}
    for key, value in entry.items():
        where = f"{kind}.{name}.{key}"
        full_key = ALIASES.get(key, key) if kind is Kind.TOOL else key
        field = known.get(full_key)
        if field is None:
            mistakes.append(unknown_key(key, known, f"{kind}.{name}"))
        elif field.name in values:
            mistakes.append(
                CodedError(
                    Message(
                        "{place} is specified under two names, {value}; use only one name",
                        place=where,
                        value=" and ".join(
                            [*(a for a, full in ALIASES.items() if full == full_key), full_key]
                        ),
                    ),
                    "key-twice",
                )
            )
        elif mistake := _mistake(where, field, value):
            mistakes.append(mistake)
        else:
            values[field.name] = _kept(field, value)
    return values


def _mistake(where: str, field: Field, value: object) -> CodedError | None:
    """Return the mistake in a value of the file, or None if the value is valid."""
    if not _fits(field, value):
        return CodedError(
            Message("{place} must be {expected}", place=where, expected=_EXPECTED[field.sort]), "wrong-type"
        )
    if field.choices and isinstance(value, str) and value not in field.choices:
        word = unknown(value or '""', field.choices)
        return CodedError(Message("{place} = {word}", place=where, word=word), "unknown-word")
    mistake = out_of_range(where, field, _kept(field, value), value)
    return CodedError(mistake, "out-of-range") if mistake else None


def _fits(field: Field, value: object) -> bool:
    """Return whether the TOML type of a value matches the field."""
    if isinstance(value, bool):
        return field.sort is Sort.FLAG
    if isinstance(value, str):
        return field.sort is Sort.TEXT
    return isinstance(value, int | float) and field.sort not in {Sort.FLAG, Sort.TEXT}


def _kept(field: Field, value: object) -> Value:
    if field.sort is Sort.LENGTH and isinstance(value, int | float):
        return value * MM_PER_INCH
    return value if isinstance(value, int | float | str) else 0.0


def shown(value: object) -> str:
    """Return a value as text for an error message."""
    return f"{value:g}" if isinstance(value, int | float) else repr(value)


def out_of_range(name: str, field: Field, value: Value, entered: object) -> str:
    """Return the message for a value out of its range, or an empty text. Lengths are in mm.

    NaN is always out of range. ``entered`` is the value as it is in the file.
    """
    if field.takes(value):
        return ""
    return Message(
        "{name} = {value} is out of range; expected {range}",
        name=name,
        value=shown(entered),
        range=field.range,
    )
