"""Comparison of an imported tool table with the stored offsets and tool shapes.

The resulting plan contains only values that differ. The import does not change wear, the master tool or
additional cutting edges.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

from core.message import CodedError, Message
from core.store.store_rows import FieldValue, OffsetKind, ToolOffsetRow, ToolShapeRow, replace_fields

if TYPE_CHECKING:
    from core.extras.tool_tables.tool_entry import ToolEntry, ToolTable

_NEAR = 1e-6  # mm, the rounding of a file with six decimals


class ImportStatus(StrEnum):
    """Status of an imported tool relative to the stored tool with the same number."""

    NEW = "new"
    CHANGED = "changed"
    UNCHANGED = "unchanged"
    SKIPPED = "left-out"


class FieldChange(NamedTuple):
    """Changed field of a tool, with its old and new value in mm or degrees.

    The old value is None if the field was not set.
    """

    offset_kind: OffsetKind
    field_name: str
    old_value: FieldValue | None
    new_value: FieldValue


@dataclass(frozen=True, slots=True)
class ToolImportPlan:
    """Planned changes of one tool, with its position in the imported file and notes for the user."""

    tool_number: int
    file_position: str
    status: ImportStatus
    field_changes: tuple[FieldChange, ...]
    notes: tuple[str, ...]

    def get_new_values(self, kind: OffsetKind) -> dict[str, FieldValue]:
        """Return the new values of the tool for one offset table, by field."""
        return {each.field_name: each.new_value for each in self.field_changes if each.offset_kind is kind}


ChangesByTable = Mapping[OffsetKind, Mapping[int, Mapping[str, FieldValue]]]


def collect_changes(plans: tuple[ToolImportPlan, ...]) -> ChangesByTable:
    """Return the new values of all plans, by offset table and tool number."""
    kinds = {
        kind: {p.tool_number: v for p in plans if (v := p.get_new_values(kind))}
        for kind in (OffsetKind.TOOL, OffsetKind.SHAPE)
    }
    return {kind: rows for kind, rows in kinds.items() if rows}


@dataclass(frozen=True, slots=True)
class StoredTools:
    """Stored offsets and shapes of the tools, by tool number."""

    tool_offsets: Mapping[int, ToolOffsetRow]
    tool_shapes: Mapping[int, ToolShapeRow]

    def make_import_plans(self, table: ToolTable, *, imports_positions: bool) -> tuple[ToolImportPlan, ...]:
        """Return one plan for each tool of an imported table.

        If ``imports_positions`` is False, X and Z are not imported.
        """
        return tuple(self._plan(entry, positions=imports_positions) for entry in table.tools.values())

    def _plan(self, entry: ToolEntry, *, positions: bool) -> ToolImportPlan:
        offset, notes = self._offset(entry, positions=positions)
        old_tool, old_shape = (
            self.tool_offsets.get(entry.tool_number),
            self.tool_shapes.get(entry.tool_number),
        )
        shape = dict(entry.shape_values)
        changes = (
            *_differences(OffsetKind.TOOL, old_tool, offset),
            *_differences(OffsetKind.SHAPE, old_shape, shape),
        )
        known = old_tool is not None or old_shape is not None
        if changes:
            status = ImportStatus.CHANGED if known else ImportStatus.NEW
        else:
            status = ImportStatus.UNCHANGED if known else ImportStatus.SKIPPED
        return ToolImportPlan(
            entry.tool_number, entry.file_position_text, status, changes, (*entry.notes, *notes)
        )

    def _offset(self, entry: ToolEntry, *, positions: bool) -> tuple[dict[str, FieldValue], list[str]]:
        """Return the offset values of a tool that can be imported, and notes about the other values."""
        offset, notes = dict(entry.offset_values), []
        if not positions and {"x", "z"} & offset.keys():
            notes.append("X and Z are not imported")
            offset = {name: value for name, value in offset.items() if name not in {"x", "z"}}
        if offset and entry.tool_number not in self.tool_offsets and not {"x", "z"} <= offset.keys():
            names = ", ".join(name.replace("_", " ") for name in offset)
            notes.append(
                Message(
                    "not imported before the tool is touched off: {names}; touch off T{number}, then import "
                    "the file again with --replace",
                    names=names,
                    number=entry.tool_number,
                )
            )
            offset = {}
        return offset, notes

    def find_shape_errors(self, plans: tuple[ToolImportPlan, ...]) -> Iterator[CodedError]:
        """Yield an error for each contradiction in the tool shapes that the planned changes would cause."""
        from app.desk.stored_shapes import find_shape_row_mistakes

        for plan in plans:
            shape = replace_fields(
                self.tool_shapes.get(plan.tool_number, ToolShapeRow()), plan.get_new_values(OffsetKind.SHAPE)
            )
            tool = replace_fields(
                self.tool_offsets.get(plan.tool_number, ToolOffsetRow()), plan.get_new_values(OffsetKind.TOOL)
            )
            for wrong in find_shape_row_mistakes(shape, tool) if shape.kind and plan.field_changes else ():
                text = Message(
                    "{place} (T{number}): {field}: {text}",
                    place=plan.file_position,
                    number=plan.tool_number,
                    field=wrong.field_name,
                    text=wrong.message,
                )
                yield CodedError(text, wrong.code)


def _differences(
    kind: OffsetKind, old: ToolOffsetRow | ToolShapeRow | None, values: Mapping[str, FieldValue]
) -> Iterator[FieldChange]:
    for name, new in values.items():
        before: FieldValue | None = None if old is None else getattr(old, name)
        if before is None or not _is_same(before, new):
            yield FieldChange(kind, name, before, new)


def _is_same(old: FieldValue, new: FieldValue) -> bool:
    if isinstance(old, str) or isinstance(new, str):
        return old == new
    return abs(old - new) <= _NEAR
