"""Rules for changes to offsets, used by the screen and the command line.

The rules define which changes are suspicious, and which access right each change requires. A rule compares
the new value with the value in use. The limits are larger than the usual size correction between two parts,
but smaller than most errors of a digit, a sign or a decimal point. Zero offsets and presets are not
checked, because a new setup can move them by any distance. Instead, the proof of the program compares the
resulting path with the axis travel.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from enum import StrEnum
from typing import NamedTuple

from core.access.access_table import ProtectedChange
from core.machine.machine_model import Machine
from core.store.offsets.touch_off import TouchPosition
from core.store.store_rows import (
    FIELDS_BY_KIND,
    FieldValue,
    MillToolRow,
    OffsetKind,
    OffsetRow,
    SecondaryOffsetRow,
    ToolOffsetRow,
    replace_fields,
)

LARGE_CHANGE_MM = 0.5  # Geometry: about .02 in.
# Wear: .010 in as entered, X on the diameter. A misplaced decimal point turns .002 into .020.
LARGE_CORRECTION_MM = 0.254
_ROUNDING_TOLERANCE_MM = 1e-6  # Rounding tolerance in mm.
# Largest deviation from half or twice the previous diameter, as a ratio to the change of the diameter.
_FACTOR_TOLERANCE = 0.1

TravelLimits = Mapping[str, tuple[float, float]]  # Travel of x and z in mm from home.


class SuspicionReason(StrEnum):
    """Reason why an offset change is suspicious, with the most serious reason first."""

    OUTSIDE_TRAVEL = "travel"  # The tip cannot reach part zero.
    WRONG_SIDE = "side"  # The tool would cut on the other side of the part.
    RADIUS_ENTERED = "radius"  # The entered diameter is half of the previous one.
    DOUBLE_DIAMETER = "double"  # The entered diameter is twice the previous one.
    LARGE_CHANGE = "large"  # The value differs much from the value in use.
    NEW_MASTER = "master"  # Other tools will follow this tool.


class SuspiciousChange(NamedTuple):
    """Suspicious change of one field of an offset, with the old and new values in mm.

    The old value is None if the field was not set.
    """

    kind: SuspicionReason
    row_number: int
    name: str
    old_value: FieldValue | None
    new_value: FieldValue


def find_travel_limits(machine: Machine | None) -> TravelLimits:
    """Return the travel limits of X and Z of a lathe in mm.

    The result is empty for a mill or without a machine. The tool length of a mill is not a machine position
    and is not compared with the travel.
    """
    if machine is None or machine.kind != "lathe":
        return {}
    return {
        a.name.lower(): a.travel_with_margin
        for a in machine.axes
        if a.name in {"X", "Z"} and a.travel is not None
    }


def find_suspicious_table_changes(
    kind: OffsetKind,
    table: Mapping[int, OffsetRow],
    changes: Mapping[int, Mapping[str, FieldValue]],
    travel: TravelLimits,
) -> tuple[SuspiciousChange, ...]:
    """Return the suspicious fields of several changes to an offset table.

    Rows with a value out of range are omitted, because the store rejects them.
    """
    new = {n: row for n, values in changes.items() if (row := _make_changed_row(kind, table.get(n), values))}
    found = [
        each
        for number, row in new.items()
        for each in find_suspicious_changes(number, table.get(number), row, travel)
    ]
    found += _check_new_master(table, new)
    return tuple(found)


def _make_changed_row(
    kind: OffsetKind, old: OffsetRow | None, values: Mapping[str, FieldValue]
) -> OffsetRow | None:
    """Return an offset row with changed values.

    Returns None if rows of this kind are not checked or a value is out of range.
    """
    fields = FIELDS_BY_KIND[kind]
    if not all(name in fields and fields[name].is_valid_value(value) for name, value in values.items()):
        return None
    if kind is OffsetKind.TOOL:
        return replace_fields(old if isinstance(old, ToolOffsetRow) else ToolOffsetRow(), values)
    if kind is OffsetKind.SECONDARY:
        return replace_fields(old if isinstance(old, SecondaryOffsetRow) else SecondaryOffsetRow(), values)
    if kind is OffsetKind.MILL_TOOL:
        return replace_fields(old if isinstance(old, MillToolRow) else MillToolRow(), values)
    return None


def find_suspicious_changes(
    number: int, old: OffsetRow | None, new: OffsetRow, travel: TravelLimits
) -> tuple[SuspiciousChange, ...]:
    """Return the suspicious fields of a change from ``old`` to ``new``, the most serious reason first."""
    found: list[SuspiciousChange] = []
    if isinstance(new, ToolOffsetRow):
        found = list(_of_tool(number, old if isinstance(old, ToolOffsetRow) else None, new, travel))
    elif isinstance(new, SecondaryOffsetRow):
        before = old if isinstance(old, SecondaryOffsetRow) else SecondaryOffsetRow()
        found = list(_check_corrections(number, before, new, ("x", "z"), doubled="x"))
    elif isinstance(new, MillToolRow):
        found = list(_of_mill(number, old if isinstance(old, MillToolRow) else MillToolRow(), new))
    return sort_by_seriousness(found)


def sort_by_seriousness(changes: Iterable[SuspiciousChange]) -> tuple[SuspiciousChange, ...]:
    """Return suspicious changes in the order of ``SuspicionReason``, the most serious first."""
    order = list(SuspicionReason)
    return tuple(sorted(changes, key=lambda each: order.index(each.kind)))


def _of_tool(
    number: int, old: ToolOffsetRow | None, new: ToolOffsetRow, travel: TravelLimits
) -> Iterator[SuspiciousChange]:
    yield from _beyond(number, old, new, travel)
    if old is None:
        yield from _check_corrections(number, ToolOffsetRow(), new, ("wear_x", "wear_z"), doubled="wear_x")
        return
    if old.x * new.x < -_ROUNDING_TOLERANCE_MM:
        yield SuspiciousChange(SuspicionReason.WRONG_SIDE, number, "x", old.x, new.x)
    for at, name in enumerate("xz"):
        before, after = getattr(old, name), getattr(new, name)
        # A touch-off includes the wear in the new geometry, so the tip moves by the difference of the sums.
        if (
            before != after
            and abs(new.offset[at] - old.offset[at]) > LARGE_CHANGE_MM + _ROUNDING_TOLERANCE_MM
        ):
            yield SuspiciousChange(SuspicionReason.LARGE_CHANGE, number, name, before, after)
    worn = tuple(f"wear_{name}" for name in "xz" if getattr(old, name) == getattr(new, name))
    yield from _check_corrections(number, old, new, worn, doubled="wear_x")


def _of_mill(number: int, old: MillToolRow, new: MillToolRow) -> Iterator[SuspiciousChange]:
    measured = tuple(name for name in ("length", "radius", "corner") if getattr(old, name))  # 0: not entered.
    yield from _moved(number, old, new, measured, LARGE_CHANGE_MM)
    yield from _check_corrections(number, old, new, ("dl", "dr", "dr2"), doubled="")


def _beyond(
    number: int, old: ToolOffsetRow | None, new: ToolOffsetRow, travel: TravelLimits
) -> Iterator[SuspiciousChange]:
    for at, name in enumerate("xz"):
        low, high = travel.get(name, (new.offset[at], new.offset[at]))
        moved = old is None or old.offset[at] != new.offset[at]
        if moved and not low <= new.offset[at] <= high:
            before = getattr(old, name) if old is not None else None
            yield SuspiciousChange(SuspicionReason.OUTSIDE_TRAVEL, number, name, before, getattr(new, name))


def _check_corrections(
    number: int, old: OffsetRow, new: OffsetRow, names: tuple[str, ...], doubled: str
) -> Iterator[SuspiciousChange]:
    """Yield the suspicious fields of a wear or secondary offset correction.

    ``doubled`` is the name of the field that the operator enters as a diameter.
    """
    for name in names:
        limit = LARGE_CORRECTION_MM / (2.0 if name == doubled else 1.0)
        yield from _moved(number, old, new, (name,), limit)


def _moved(
    number: int, old: OffsetRow, new: OffsetRow, names: tuple[str, ...], limit: float
) -> Iterator[SuspiciousChange]:
    for name in names:
        before, after = getattr(old, name), getattr(new, name)
        if abs(after - before) > limit + _ROUNDING_TOLERANCE_MM:
            yield SuspiciousChange(SuspicionReason.LARGE_CHANGE, number, name, before, after)


def _check_new_master(
    table: Mapping[int, OffsetRow], new: Mapping[int, OffsetRow]
) -> Iterator[SuspiciousChange]:
    """Yield a ``SuspiciousChange`` for each tool that would become the master of existing tools.

    The existing tools would then follow the touch-offs of this tool.
    """
    for number, row in new.items():
        old = table.get(number)
        was = isinstance(old, ToolOffsetRow) and old.master
        if isinstance(row, ToolOffsetRow) and row.master and not was and find_following_tools(table, number):
            yield SuspiciousChange(SuspicionReason.NEW_MASTER, number, "master", False, True)


def find_factor_suspicion(old_tip_x_mm: float, new_tip_x_mm: float) -> SuspicionReason | None:
    """Return the reason if an entered diameter is about half or twice the previous one, or else None.

    The operator then probably entered a radius or doubled a diameter. Both positions are X of the tip
    relative to part zero, as a radius in mm.
    """
    tolerance = _FACTOR_TOLERANCE * abs(new_tip_x_mm - old_tip_x_mm)
    if tolerance <= _ROUNDING_TOLERANCE_MM:
        return None
    if abs(2.0 * new_tip_x_mm - old_tip_x_mm) <= tolerance:
        return SuspicionReason.RADIUS_ENTERED
    if abs(new_tip_x_mm - 2.0 * old_tip_x_mm) <= tolerance:
        return SuspicionReason.DOUBLE_DIAMETER
    return None


# --- several tools ---------------------------------------------------------------------------------------


def apply_touch_off(
    tools: Mapping[int, ToolOffsetRow], tool_number: int, touch: TouchPosition
) -> ToolOffsetRow:
    """Return the row of a tool as the store will save it after a touch-off."""
    geometry = {name: value for name, value in (("x", touch.x), ("z", touch.z)) if value is not None}
    values: dict[str, FieldValue] = {**geometry, **{f"wear_{name}": 0.0 for name in geometry}}
    return replace_fields(tools.get(tool_number, ToolOffsetRow()), values)


def find_following_tools(tools: Iterable[int], master: int) -> tuple[int, ...]:
    """Return the numbers of the tools that move with the master tool when it is touched off."""
    return tuple(number for number in sorted(tools) if number != master)


def find_suspicious_follower_changes(
    tools: Mapping[int, ToolOffsetRow], master: int, new: ToolOffsetRow, travel: TravelLimits
) -> tuple[SuspiciousChange, ...]:
    """Return a suspicious change for each tool that would leave the travel with the master tool."""
    old = tools[master]
    x, z = (after - before for before, after in zip(old.offset, new.offset, strict=True))
    found: list[SuspiciousChange] = []
    for number in find_following_tools(tools, master):
        row = tools[number]
        found += _beyond(number, row, replace_fields(row, {"x": row.x + x, "z": row.z + z}), travel)
    return tuple(found)


def describe_suspicious_changes(
    suspicions: tuple[SuspiciousChange, ...],
    describe_field: Callable[[SuspiciousChange], str],
    describe_reason: Callable[[SuspiciousChange], str],
) -> str:
    """Return one text that describes all suspicious changes.

    Each field appears once, with its most serious reason.
    """
    fields: dict[tuple[int, str], SuspiciousChange] = {}
    for each in suspicions:
        fields.setdefault((each.row_number, each.name), each)
    return ", ".join(f"{describe_field(each)} ({describe_reason(each)})" for each in fields.values())


CORRECTION_FIELDS = {
    OffsetKind.TOOL: frozenset({"wear_x", "wear_z", "remark"}),
    OffsetKind.MILL_TOOL: frozenset({"dl", "dr", "dr2"}),
}
"""Fields that count as corrections, by kind of tool table.

All fields of a secondary offset are corrections.
"""

_RIGHTS_BY_KIND = {
    OffsetKind.TOOL: ProtectedChange.TOOLS,
    OffsetKind.SECONDARY: ProtectedChange.WEAR,
    OffsetKind.ZERO: ProtectedChange.ZEROS,
    OffsetKind.SHAPE: ProtectedChange.SHAPES,
    OffsetKind.MILL_TOOL: ProtectedChange.TOOLS,
    OffsetKind.PRESET: ProtectedChange.PRESETS,
}


def find_required_access_right(kind: OffsetKind, fields: Collection[str] = ()) -> ProtectedChange:
    """Return the access right that is required to change fields of an offset table.

    Without ``fields``, this is the right to clear the table or undo a change.
    """
    only = CORRECTION_FIELDS.get(kind, frozenset())
    return ProtectedChange.WEAR if fields and only.issuperset(fields) else _RIGHTS_BY_KIND[kind]
