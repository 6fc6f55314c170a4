"""Tool tables as CSV files, for example from Mach or a spreadsheet.

A file has a line of headings, followed by one tool per line. Fields are separated by commas, semicolons or
tabs. A number may have a decimal comma.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence

from core.extras.tool_tables.csv_columns import (
    NOSE_DIAMETER,
    NUMBER,
    X_DIAMETER,
    TableColumn,
    identify_column,
)
from core.extras.tool_tables.tool_entry import (
    DIAMETER_FIELD,
    MM_PER_UNIT,
    TABLE_FIELDS,
    TableReader,
    ToolEntry,
)
from core.message import Message, find_similar_word
from core.store.store_rows import FieldType, FieldValue, RowField

MAX_LINES = 10_000
_SEPARATORS = ";\t,"  # The first of them that the heading contains.
_FLAGS = {"1": True, "yes": True, "true": True, "0": False, "no": False, "false": False}
_HEADINGS = {NUMBER: "T", "x": "X radius"}


def read_tools(table: TableReader, text: str) -> None:
    """Add the tools of a CSV file to ``table``."""
    lines = text.splitlines(keepends=True)
    start = next((n for n, line in enumerate(lines) if line.strip(" \t\r\n,;")), 0)
    if len(lines) > MAX_LINES:
        message = Message("the file has more than {most} lines; it is not a tool table", most=MAX_LINES)
        table.add_mistake(Message("line {line}", line=MAX_LINES + 1), "too-long", message)
        return
    heading = lines[start] if lines else ""
    separator = next((each for each in _SEPARATORS if each in heading), ",")
    rows = csv.reader(io.StringIO("".join(lines[start:])), delimiter=separator, strict=True)
    try:
        columns = _columns(table, start + 1, next(rows, []))
        if not table.mistakes:
            for row in rows:
                if any(cell.strip() for cell in row):
                    _read_row(table, Message("line {line}", line=start + rows.line_num), row, columns)
    except csv.Error as error:
        place = Message("line {line}", line=start + rows.line_num)
        table.add_mistake(place, "not-csv", Message("not valid CSV ({error}); check the quotes", error=error))


def _columns(table: TableReader, line: int, headings: Sequence[str]) -> tuple[TableColumn, ...]:
    """Return the columns with a known field, and add a note that lists the other headings.

    A mistake is reported if two columns have the same field, if no column has the tool number, or if it is
    not specified whether X is a radius or a diameter.
    """
    place = Message("line {line}", line=line)
    assigned = _assigned(table, place, headings)
    found = [
        column
        for index, heading in enumerate(headings)
        if (column := identify_column(index, heading, assigned.get(index, "")))
    ]
    mapped = set(assigned.values())
    found = [each for each in found if each.column_index in assigned or each.field_name not in mapped]
    fields = [each.field_name for each in found]
    for field in sorted({each for each in fields if fields.count(each) > 1}):
        text = Message("two columns are {field}; use --map {field}=COLUMN to select one", field=field)
        table.add_mistake(place, "column-twice", text)
    if NUMBER not in fields:
        text = Message(
            "no column has the tool number; use --map number=COLUMN. The columns are: {names}",
            names=", ".join(heading.strip()[:40] for heading in headings[:40]) or "none",
        )
        table.add_mistake(place, "no-number-column", text)
    _check_x(table, place, found)
    unused = [
        h.strip()[:40]
        for i, h in enumerate(headings)
        if h.strip() and i not in {c.column_index for c in found}
    ]
    if unused:
        table.notes.append(Message("columns that are not imported: {names}", names=", ".join(unused[:40])))
    return tuple(found)


def _assigned(table: TableReader, place: str, headings: Sequence[str]) -> dict[int, str]:
    """Return the fields that the option --map assigns to columns, by column index."""
    names = [heading.strip().lower() for heading in headings]
    found: dict[int, str] = {}
    for field, column in table.options.columns.items():
        if column.strip().lower() in names:
            found[names.index(column.strip().lower())] = field
            continue
        near = find_similar_word(column, [heading.strip() for heading in headings])
        text = Message(
            "the file has no column {column}; {remedy}",
            column=column,
            remedy=Message("did you mean {near}?", near=near)
            if near
            else Message("its columns are: {names}", names=", ".join(h.strip()[:40] for h in headings[:40])),
        )
        table.add_mistake(place, "unknown-column", text)
    return found


def _check_x(table: TableReader, place: str, columns: Iterable[TableColumn]) -> None:
    """Report a mistake if it is not specified whether X is a radius or a diameter."""
    for each in columns:
        if each.field_name == "x" and not (each.is_radius or table.options.x_meaning):
            text = Message(
                "column {name} can be a radius or a diameter; add --x radius or --x diameter",
                name=each.heading,
            )
            table.add_mistake(place, "x-unclear", text)


def _read_row(table: TableReader, place: str, row: Sequence[str], columns: Iterable[TableColumn]) -> None:
    """Add the tool in one row to the table."""
    mistakes = len(table.mistakes)
    cells = {
        each.field_name: (each, row[each.column_index].strip())
        for each in columns
        if each.column_index < len(row)
    }
    column, text = cells.pop(NUMBER, (None, ""))
    where = Message("{place}, column {column}", place=place, column=column.heading if column else NUMBER)
    if not text:
        table.add_mistake(where, "no-number", "the line has no tool number; add T1 to T32")
        return
    number = table.check_tool_number(where, table.parse_number(where, text.upper().removeprefix("T")))
    if number is None or len(table.mistakes) > mistakes:
        return
    values = {
        field: value
        for field, (each, cell) in cells.items()
        if cell and (value := _value(table, place, each, cell)) is not None
    }
    if len(table.mistakes) == mistakes:
        _convert_diameters(table, values)
        table.add_tool(number, place, values, str(values.get("remark", "")))


def _convert_diameters(table: TableReader, values: dict[str, FieldValue]) -> None:
    """Convert the diameters of X and of the nose to radii."""
    if table.options.x_meaning == "diameter" and X_DIAMETER not in values and "x" in values:
        values[X_DIAMETER] = values.pop("x")
    for diameter, radius in ((X_DIAMETER, "x"), (NOSE_DIAMETER, "nose_radius")):
        if diameter in values:
            values[radius] = float(values.pop(diameter)) / 2.0


def _value(table: TableReader, place: str, column: TableColumn, cell: str) -> FieldValue | None:
    """Return the value of a cell, with lengths in mm.

    If the value is invalid, a mistake of the file is reported and the result is None.
    """
    where = Message("{place}, column {column}", place=place, column=column.heading)
    field = _field(column.field_name)
    if field.field_type is FieldType.TEXT:
        return _text(table, where, field, cell)
    if field.field_type is FieldType.BOOLEAN:
        if cell.lower() in _FLAGS:
            return _FLAGS[cell.lower()]
        table.add_mistake(
            where, "not-a-flag", Message("{text} is not valid; use 1 or 0", text=repr(cell[:40]))
        )
        return None
    value = table.parse_number(where, cell.replace(",", ".") if cell.count(",") == 1 else cell)
    if value is None or field.field_type is not FieldType.LENGTH:
        return (
            int(value)
            if value is not None and field.field_type is FieldType.INTEGER and value.is_integer()
            else value
        )
    if not value:
        return value
    return value * (MM_PER_UNIT[column.unit] if column.unit else table.get_unit_mm(where))


def _field(name: str) -> RowField:
    same = {X_DIAMETER: "x", NOSE_DIAMETER: "nose_radius", DIAMETER_FIELD: "diameter"}
    return TABLE_FIELDS[same.get(name, name)]


def _text(table: TableReader, where: str, field: RowField, cell: str) -> str | None:
    """Return the text of a cell; if the field has choices, return the matching choice."""
    if not field.choices:
        return cell
    word = cell.lower().replace(" ", "-")
    word = {"r": "right", "l": "left", "n": "neutral", "center-drill": "centre-drill"}.get(word, word)
    if word in field.choices:
        return word
    text = Message("{text} is unknown; use {range}", text=repr(cell[:40]), range=field.range_text)
    table.add_mistake(where, "unknown-word", text)
    return None


# --- writing -----------------------------------------------------------------------------------------------


def format_table(tools: Iterable[ToolEntry], unit: str) -> str:
    """Return the tools as a CSV table. Lengths are in ``unit``, which the headings contain."""
    rows = list(tools)
    names = [
        name for name in TABLE_FIELDS if any({**t.offset_values, **t.shape_values}.get(name) for t in rows)
    ]
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow([_HEADINGS[NUMBER], *(_heading(name, unit) for name in names)])
    table.writerows(_cells(tool, names, MM_PER_UNIT[unit]) for tool in rows)
    return out.getvalue()


DERIVED_FIELDS = (X_DIAMETER, NOSE_DIAMETER)
"""Columns with twice the value of a radius, which a file can have in addition to the stored fields."""
_RADIUS_OF = {X_DIAMETER: "x", NOSE_DIAMETER: "nose_radius"}


def list_written_fields(columns: Iterable[str]) -> frozenset[str]:
    """Return the fields in which TurnDesk stores the values of these CSV columns.

    A diameter is stored as a radius.
    """
    return frozenset(_RADIUS_OF.get(each, each) for each in columns)


def format_columns(tools: Iterable[ToolEntry], unit: str, columns: Mapping[str, str]) -> str:
    """Return the tools as a CSV table; ``columns`` maps each field to its heading, in column order."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(columns.values())
    for tool in tools:
        values: dict[str, FieldValue] = {**tool.offset_values, **tool.shape_values}
        for diameter, radius in _RADIUS_OF.items():
            if radius in values:
                values[diameter] = 2.0 * float(values[radius])
        table.writerow(
            str(tool.tool_number) if name == NUMBER else _cell(name, values.get(name, ""), MM_PER_UNIT[unit])
            for name in columns
        )
    return out.getvalue()


def _heading(name: str, unit: str) -> str:
    text = _HEADINGS.get(name, name.replace("_", " ").capitalize())
    return f"{text} ({unit})" if TABLE_FIELDS[name].field_type is FieldType.LENGTH else text


def _cells(tool: ToolEntry, names: Iterable[str], factor: float) -> Iterator[str]:
    values: Mapping[str, FieldValue] = {**tool.offset_values, **tool.shape_values}
    yield str(tool.tool_number)
    yield from (_cell(name, values.get(name, ""), factor) for name in names)


def _cell(name: str, value: FieldValue, factor: float) -> str:
    """Return a value as the text of a cell; lengths are divided by ``factor``."""
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, float) and _field(name).field_type is FieldType.LENGTH:
        return f"{value / factor:.6f}"
    return f"{value:g}" if isinstance(value, float) else _harmless(value)


def _harmless(value: FieldValue) -> str:
    """Return the value as a text that a spreadsheet does not evaluate as a formula."""
    text = str(value)
    return f" {text}" if text[:1] in {"=", "+", "-", "@"} else text
