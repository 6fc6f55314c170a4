"""Reader of the offsets file and the tools file, which users write in TOML.

- Offsets file: tables [tool.1] and [secondary.1] in inches, and [zero.54] in mm and degrees. An export
  contains this file.
- Tools file: tool shapes in tables [tool.1], which the offsets file may also contain. Lengths are in
  inches and angles in degrees. Outlines (holder, profile) are texts in mm.

Additional cutting edges of a tool are [tool.1.d2] to [tool.1.d9]. All mistakes are reported together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.desk.toml_file import describe_unknown_key, make_unknown_key_error, raise_mistakes, read_toml
from core.message import CodedError, Message
from core.store.store_rows import (
    FIELDS_BY_KIND,
    MM_PER_INCH,
    OFFSET_NUMBERS,
    ZERO_CODES,
    FieldType,
    FieldValue,
    OffsetKind,
    RowField,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
    replace_fields,
)
from core.tool_edges import EDGE_NUMBERS, get_edge_number, get_tool_number, make_edge_row_number

if TYPE_CHECKING:
    from core.part.tool_shape import ToolShape

_FILE_KINDS = (OffsetKind.TOOL, OffsetKind.SECONDARY)
_NUMBER_RANGES = {
    OffsetKind.TOOL: ({str(number): number for number in OFFSET_NUMBERS}, "offset numbers are 1…32"),
    OffsetKind.SECONDARY: ({str(number): number for number in OFFSET_NUMBERS}, "offset numbers are 1…32"),
    OffsetKind.ZERO: (
        {str(code): code for code in ZERO_CODES},
        ("settable zero offsets are 54…59 (G54 to G59)"),
    ),
}
_EXPECTED_TYPES = {
    FieldType.LENGTH: "a number in inches",
    FieldType.METRIC_LENGTH: "a number in mm",
    FieldType.ANGLE: "a number in degrees",
    FieldType.INTEGER: "a whole number",
    FieldType.TEXT: "a text",
    FieldType.BOOLEAN: "true or false",
}
TOOL_TABLE_KEYS: Mapping[str, RowField] = {
    **FIELDS_BY_KIND[OffsetKind.TOOL],
    **FIELDS_BY_KIND[OffsetKind.SHAPE],
}
_EDGE_KEYS = frozenset(f"d{edge}" for edge in EDGE_NUMBERS[1:])
KEY_ALIASES = {"tip": "quadrant"}  # Name of the field in tool data sheets.


def read_offset_rows(
    path: Path,
) -> tuple[dict[int, ToolOffsetRow], dict[int, SecondaryOffsetRow], dict[int, ZeroOffsetRow]]:
    """Return the tool, secondary and zero offsets of a file as database rows.

    A missing key is read as 0 or as an empty text. A tool that has a shape but neither X nor Z gets no
    offset, because its tip position is not specified. Raise CommandError, which lists all mistakes of the
    file.
    """
    data = read_toml(path)
    mistakes = _unknown_tables(data)
    tools = _tools(data, mistakes).positioned_rows
    secondary = {
        n: replace_fields(SecondaryOffsetRow(), values)
        for n, values in _table(data, OffsetKind.SECONDARY, mistakes)
    }
    masters = [f"tool.{n}" for n, row in tools.items() if row.master]
    mistakes += [
        CodedError(
            Message(
                "[tool.{number}.d{number2}] is an edge of T{number3}, but that tool has no X and Z values",
                number=get_tool_number(n),
                number2=get_edge_number(n),
                number3=get_tool_number(n),
            ),
            "edge-without-tool",
        )
        for n in tools
        if get_tool_number(n) not in tools
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
    zero = {
        code: replace_fields(ZeroOffsetRow(), values)
        for code, values in _table(data, OffsetKind.ZERO, mistakes)
    }
    raise_mistakes(path, mistakes)
    return tools, secondary, zero


def read_shape_rows(path: Path) -> dict[int, ToolShapeRow]:
    """Return the tool shapes of a file as database rows.

    Raise CommandError, which lists all mistakes of the tool tables. The secondary and zero offsets of the
    file are not checked.
    """
    data = read_toml(path)
    mistakes = _unknown_tables(data)
    shapes = _tools(data, mistakes).shapes
    raise_mistakes(path, mistakes)
    return shapes


def read_tool_shapes(path: Path) -> dict[int, ToolShape]:
    """Return all tool shapes of a file in mm, with the nose radius and tip quadrant of each tool.

    In the file, lengths are in inches. The outlines of holder and profile are strings in mm. The secondary
    and zero offsets of the file are not checked. Raises CommandError, which lists all mistakes of the tool
    tables, if there is a mistake.
    """
    data = read_toml(path)
    mistakes = _unknown_tables(data)
    found = _tools(data, mistakes)
    raise_mistakes(path, mistakes)
    if not found.shapes:
        return {}
    from app.desk.stored_shapes import make_tool_shapes

    return make_tool_shapes(found.shapes, found.rows)


def _unknown_tables(data: dict[str, object]) -> list[CodedError]:
    return [
        make_unknown_key_error(key, _FILE_KINDS) for key in data if key not in {*_FILE_KINDS, OffsetKind.ZERO}
    ]


class _ToolTables(NamedTuple):
    """The tools of a file: all tool offsets, those with a specified position, and the tool shapes."""

    rows: dict[int, ToolOffsetRow]
    positioned_rows: dict[int, ToolOffsetRow]
    shapes: dict[int, ToolShapeRow]


def _tools(data: dict[str, object], mistakes: list[CodedError]) -> _ToolTables:
    found = _ToolTables({}, {}, {})
    for number, values in _table(data, OffsetKind.TOOL, mistakes):
        shape = {name: value for name, value in values.items() if name in FIELDS_BY_KIND[OffsetKind.SHAPE]}
        offset = {name: value for name, value in values.items() if name not in shape}
        found.rows[number] = replace_fields(ToolOffsetRow(), offset)
        if not shape or {"x", "z"} & offset.keys():
            found.positioned_rows[number] = found.rows[number]
        if shape:
            found.shapes[number] = replace_fields(ToolShapeRow(), shape)
            mistakes += _shape_mistakes(number, found.shapes[number], found.rows[number])
    return found


def _shape_mistakes(number: int, row: ToolShapeRow, tool: ToolOffsetRow) -> Iterator[CodedError]:
    from app.desk.stored_shapes import find_shape_row_mistakes

    if not row.kind:
        kinds = FIELDS_BY_KIND[OffsetKind.SHAPE]["kind"].range_text
        text = Message(
            "[tool.{number}] has a shape but no kind; set kind to one of {kinds}",
            number=number,
            kinds=kinds,
        )
        yield CodedError(text, "no-kind")
        return
    for wrong in find_shape_row_mistakes(row, tool):
        yield CodedError(
            Message(
                "tool.{number}.{field}: {wrong}", number=number, field=wrong.field_name, wrong=wrong.message
            ),
            "invalid-shape",
        )


def _table(
    data: dict[str, object], kind: OffsetKind, mistakes: list[CodedError]
) -> Iterator[tuple[int, dict[str, FieldValue]]]:
    """Yield number and values of each row of a kind of offset, and append errors to ``mistakes``."""
    table, (numbers, those) = data.get(kind.value, {}), _NUMBER_RANGES[kind]
    if not isinstance(table, dict):
        text = "{kind} must contain tables such as [{kind2}.{numbers}]"
        message = Message(text, kind=kind, kind2=kind, numbers=next(iter(numbers)))
        mistakes.append(CodedError(message, "not-tables"))
        return
    for name, entry in table.items():
        if name not in numbers:
            message = Message("[{kind}.{name}] does not exist; {those}", kind=kind, name=name, those=those)
            mistakes.append(CodedError(message, "unknown-number"))
        elif not isinstance(entry, dict):
            text = "{kind}.{name} must be a table, [{kind2}.{name2}]"
            message = Message(text, kind=kind, name=name, kind2=kind, name2=name)
            mistakes.append(CodedError(message, "not-a-table"))
        else:
            edges = _read_edges(entry) if kind is OffsetKind.TOOL else {}
            own = {key: value for key, value in entry.items() if key not in edges}
            if own or not edges:
                yield numbers[name], _values(own, kind, name, mistakes)
            yield from _read_edge_rows(numbers[name], name, edges, mistakes)


def _read_edge_rows(
    number: int, name: str, edges: dict[str, object], mistakes: list[CodedError]
) -> Iterator[tuple[int, dict[str, FieldValue]]]:
    """Yield the rows of the additional cutting edges of a tool, and append their mistakes."""
    for key, values in edges.items():
        if isinstance(values, dict):
            place = Message("{name}.{key}", name=name, key=key)
            row = _values(values, OffsetKind.TOOL, place, mistakes)
            yield make_edge_row_number(number, int(key[1])), row
        else:
            text = "tool.{name}.{key} must be a table, [tool.{name2}.{key2}]"
            message = Message(text, name=name, key=key, name2=name, key2=key)
            mistakes.append(CodedError(message, "not-a-table"))


def _read_edges(entry: dict[str, object]) -> dict[str, object]:
    """Return the additional cutting edges of a tool, from the tables [tool.1.d2] to [tool.1.d9]."""
    return {key: value for key, value in entry.items() if key in _EDGE_KEYS}


def _values(
    entry: dict[str, object], kind: OffsetKind, name: str, mistakes: list[CodedError]
) -> dict[str, FieldValue]:
    known = TOOL_TABLE_KEYS if kind is OffsetKind.TOOL else FIELDS_BY_KIND[kind]
    values: dict[str, FieldValue] = {}
    for key, value in entry.items():
        where = f"{kind}.{name}.{key}"
        full_key = KEY_ALIASES.get(key, key) if kind is OffsetKind.TOOL else key
        field = known.get(full_key)
        if field is None:
            mistakes.append(make_unknown_key_error(key, known, f"{kind}.{name}"))
        elif field.name in values:
            mistakes.append(
                CodedError(
                    Message(
                        "{place} is specified under two names, {value}; use only one name",
                        place=where,
                        value=" and ".join(
                            [*(a for a, full in KEY_ALIASES.items() if full == full_key), full_key]
                        ),
                    ),
                    "key-twice",
                )
            )
        elif mistake := _find_mistake(where, field, value):
            mistakes.append(mistake)
        else:
            values[field.name] = _kept(field, value)
    return values


def _find_mistake(where: str, field: RowField, value: object) -> CodedError | None:
    """Return the mistake in a value of the offsets file, or None if the value is valid."""
    if not _fits_field(field, value):
        return CodedError(
            Message("{place} must be {expected}", place=where, expected=_EXPECTED_TYPES[field.field_type]),
            "wrong-type",
        )
    if field.choices and isinstance(value, str) and value not in field.choices:
        word = describe_unknown_key(value or '""', field.choices)
        return CodedError(Message("{place} = {word}", place=where, word=word), "unknown-word")
    mistake = find_range_error(where, field, _kept(field, value), value)
    return CodedError(mistake, "out-of-range") if mistake else None


def _fits_field(field: RowField, value: object) -> bool:
    """Return whether a TOML value has the type that its offset field requires."""
    if isinstance(value, bool):
        return field.field_type is FieldType.BOOLEAN
    if isinstance(value, str):
        return field.field_type is FieldType.TEXT
    return isinstance(value, int | float) and field.field_type not in {FieldType.BOOLEAN, FieldType.TEXT}


def _kept(field: RowField, value: object) -> FieldValue:
    if field.field_type is FieldType.LENGTH and isinstance(value, int | float):
        return value * MM_PER_INCH
    return value if isinstance(value, int | float | str) else 0.0


def format_value(value: object) -> str:
    """Return a value as text for an error message."""
    return f"{value:g}" if isinstance(value, int | float) else repr(value)


def find_range_error(name: str, field: RowField, value: FieldValue, entered_value: object) -> str:
    """Return the message for a value out of range, or an empty string if it is in range.

    Lengths are in mm. NaN is always out of range. ``entered_value`` is the value in the file.
    """
    if field.is_valid_value(value):
        return ""
    return Message(
        "{name} = {value} is out of range; expected {range}",
        name=name,
        value=format_value(entered_value),
        range=field.range_text,
    )
