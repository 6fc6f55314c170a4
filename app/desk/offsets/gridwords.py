"""F8 in words: the cells of the table, the question, and what an answer would change."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.desk.arithmetic import EntryError
from app.desk.offsets.entry import marked, shown_value, value_typed, word
from app.desk.offsets.figures import not_set
from app.desk.offsets.shown import Rows

if TYPE_CHECKING:
    from app.desk.offsets.grid import ToolGrid


def cell(grid: ToolGrid, number: int, name: str) -> str:
    """A cell of the table; X and Z of another tool from the master when that is asked for."""
    book, mode = grid.book, grid.ledger.mode
    row, new = book.tools.get(number), grid.cells.new
    if row is None:
        known = number == new.number and name in new.values
        return shown_value(name, new.values[name], mode) if known else ""
    master = book.tools.get(book.master)
    if grid.relative and master is not None and name in {"x", "z"} and number != book.master:
        at = "xz".index(name)
        return shown_value(name, row.offset[at] - master.offset[at], mode)
    return shown_value(name, getattr(row, name), mode)


def question(grid: ToolGrid) -> str:
    """What is asked: tool and field."""
    mark = marked(grid.name, grid.ledger.mode)
    return f"T{grid.number}  {word(grid.name)}{f' {mark}' if mark else ''}?"


def old_to_new(grid: ToolGrid) -> str:
    """The cell before and after what is typed, or else the last change."""
    if not (grid.text or grid.writing):
        return grid.ledger.last_told
    was = cell(grid, grid.number, grid.name) or (not_set() if grid.tool is None else "")
    mode = grid.ledger.mode
    try:
        new = shown_value(grid.name, value_typed(grid.name, grid.text, mode), mode)
    except EntryError:
        new = "…"  # half a sum is no mistake yet
    return f"{was}  →  {new}"


def proposed(grid: ToolGrid) -> Rows:
    """The tables as they would be with what is typed."""
    tools, secondary, row = grid.book.tools, grid.book.secondary, grid.tool
    if row is None or not grid.text:
        return tools, secondary
    try:
        value = value_typed(grid.name, grid.text, grid.ledger.mode)
    except EntryError:
        return tools, secondary
    return {**tools, grid.number: row._replace(**{grid.name: value})}, secondary  # type: ignore[arg-type]
