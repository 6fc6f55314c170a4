"""The rule for suspicious changes of offsets: what is questioned, and what is not."""

from __future__ import annotations

import pytest

from app.desk.stored_shapes import is_quadrant_for_other_side
from app.offsets.change_rules import (
    SuspicionReason,
    find_factor_suspicion,
    find_suspicious_changes,
    find_suspicious_table_changes,
)
from core.store.store_rows import (
    MillToolRow,
    OffsetKind,
    OffsetRow,
    PresetRow,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
)
from tests.offsets.conftest import Room
from tests.texts import text

TRAVEL = {"x": (-100.0, 100.0), "z": (-150.0, 150.0)}
TOOL = ToolOffsetRow(10.0, -50.0, wear_x=0.05)


@pytest.mark.parametrize(
    ("old", "new", "doubts"),
    [
        (TOOL, TOOL._replace(x=10.5), []),
        (TOOL, TOOL._replace(x=10.51), [("x", SuspicionReason.LARGE_CHANGE)]),
        (TOOL, TOOL._replace(x=10.54, wear_x=0.0), []),  # a touch-off: the tip moves .49 mm
        (
            TOOL,
            TOOL._replace(x=-10.0),
            [("x", SuspicionReason.WRONG_SIDE), ("x", SuspicionReason.LARGE_CHANGE)],
        ),
        (
            TOOL,
            TOOL._replace(x=381.0),
            [("x", SuspicionReason.OUTSIDE_TRAVEL), ("x", SuspicionReason.LARGE_CHANGE)],
        ),
        (
            TOOL,
            TOOL._replace(z=-151.0),
            [("z", SuspicionReason.OUTSIDE_TRAVEL), ("z", SuspicionReason.LARGE_CHANGE)],
        ),
        (None, ToolOffsetRow(10.0, -151.0), [("z", SuspicionReason.OUTSIDE_TRAVEL)]),
        (None, ToolOffsetRow(10.0, -50.0), []),
        (TOOL, TOOL._replace(wear_x=0.177), []),  # .254 on the diameter
        (TOOL, TOOL._replace(wear_x=0.18), [("wear_x", SuspicionReason.LARGE_CHANGE)]),
        (TOOL, TOOL._replace(wear_z=0.254), []),
        (TOOL, TOOL._replace(wear_z=-0.26), [("wear_z", SuspicionReason.LARGE_CHANGE)]),
        (TOOL, TOOL._replace(remark="new", quadrant=3, nose_radius=0.8), []),
        (SecondaryOffsetRow(), SecondaryOffsetRow(0.13, 0.0, 0.4), [("x", SuspicionReason.LARGE_CHANGE)]),
        (None, SecondaryOffsetRow(0.0, 0.3), [("z", SuspicionReason.LARGE_CHANGE)]),
        (SecondaryOffsetRow(0.1, 0.1), SecondaryOffsetRow(0.2, 0.2), []),
        (MillToolRow("A", 80.0), MillToolRow("A", 80.6), [("length", SuspicionReason.LARGE_CHANGE)]),
        (MillToolRow("A", 80.0), MillToolRow("A", 80.0, 6.0), []),
        (
            MillToolRow("A", 80.0, 6.0),
            MillToolRow("A", -80.0, 6.0),
            [("length", SuspicionReason.LARGE_CHANGE)],
        ),
        (
            MillToolRow("A", 80.0, 6.0, 1.0),
            MillToolRow("A", 80.0, 5.0, 2.0),
            [("radius", SuspicionReason.LARGE_CHANGE), ("corner", SuspicionReason.LARGE_CHANGE)],
        ),
        (None, MillToolRow("A", 80.0, 6.0, dr=0.2), []),
        (None, MillToolRow("A", 80.0, 6.0, dr2=0.3), [("dr2", SuspicionReason.LARGE_CHANGE)]),
        (None, ToolOffsetRow(10.0, -50.0, wear_x=0.2), [("wear_x", SuspicionReason.LARGE_CHANGE)]),
        (MillToolRow("A", 80.0), MillToolRow("A", 80.0, dl=0.3), [("dl", SuspicionReason.LARGE_CHANGE)]),
    ],
)
def test_suspicious_offset_changes_are_found(
    old: OffsetRow | None, new: OffsetRow, doubts: list[tuple[str, SuspicionReason]]
) -> None:
    assert [(each.name, each.kind) for each in find_suspicious_changes(1, old, new, TRAVEL)] == doubts


def test_new_master_tool_is_suspicious_only_with_set_tools() -> None:
    master = {1: {"x": 1.0, "z": 1.0, "master": True}}
    assert (
        find_suspicious_table_changes(OffsetKind.TOOL, {}, {**master, 2: {"x": 1.0, "z": 1.0}}, TRAVEL) == ()
    )
    found = find_suspicious_table_changes(OffsetKind.TOOL, {2: TOOL}, master, TRAVEL)
    assert [(each.row_number, each.kind) for each in found] == [(1, SuspicionReason.NEW_MASTER)]
    assert (
        find_suspicious_table_changes(
            OffsetKind.TOOL, {1: ToolOffsetRow(1.0, 1.0, master=True), 2: TOOL}, master, TRAVEL
        )
        == ()
    )


def test_value_rejected_by_store_is_not_suspicious() -> None:
    assert find_suspicious_table_changes(OffsetKind.TOOL, {1: TOOL}, {1: {"x": 5000.0}}, TRAVEL) == ()
    assert find_suspicious_table_changes(OffsetKind.TOOL, {1: TOOL}, {1: {"colour": 1.0}}, TRAVEL) == ()


def test_datum_changes_are_not_suspicious() -> None:
    assert (
        find_suspicious_table_changes(OffsetKind.ZERO, {54: ZeroOffsetRow(1.0)}, {54: {"x": 900.0}}, TRAVEL)
        == ()
    )
    assert (
        find_suspicious_table_changes(OffsetKind.PRESET, {1: PresetRow(1.0)}, {1: {"x": 900.0}}, TRAVEL) == ()
    )


def test_tool_x_with_changed_sign_needs_confirmation_and_escape_cancels_it(room: Room) -> None:
    room.store.offsets.tool_offsets.change_row(1, "touched off", {"x": 12.7, "z": -76.2}).result(60)
    room.desk.offset_book.read_store()
    grid = room.grid()
    grid.update(room.now[0])
    grid.select_cell(1, 0)
    for key in "-.5":
        grid.handle_key(key)
    grid.handle_key("Enter")
    change = f"T1 X R +0.50000 → −0.50000 ({text('offsets.doubt-side')})"
    assert room.desk.prompt_notice == text("offsets.suspicious", changes=change)
    assert grid.handle_escape()
    room.settle(grid)
    assert room.store.offsets.tool_offsets.read_rows()[1].x == 12.7


def test_undo_affects_only_selected_row(room: Room) -> None:
    for number in (1, 2):
        room.store.offsets.tool_offsets.change_row(number, "touched off", {"x": 12.7, "z": -76.2})
    room.store.offsets.tool_offsets.change_row(1, "moved", {"x": 12.8})
    room.store.offsets.tool_offsets.change_row(2, "moved", {"x": 12.9}).result(60)
    room.desk.offset_book.read_store()
    grid = room.grid()
    grid.update(room.now[0])
    grid.select_cell(1, 0)
    grid.handle_undo()
    room.settle(grid)
    assert room.store.offsets.tool_offsets.read_rows()[1].x == 12.8
    assert room.desk.confirmation_key
    room.confirm()
    room.settle(grid)
    assert (
        room.store.offsets.tool_offsets.read_rows()[1].x,
        room.store.offsets.tool_offsets.read_rows()[2].x,
    ) == (
        12.7,
        12.9,
    )


def test_undo_of_a_row_without_a_change_asks_nothing(room: Room) -> None:
    grid = room.grid()
    grid.update(room.now[0])
    grid.select_cell(9, 0)
    grid.handle_undo()
    assert room.desk.prompt_notice == text("offsets.no-change-to-undo", row="T9")
    assert not room.desk.confirmation_key


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (12.5, 6.25, SuspicionReason.RADIUS_ENTERED),  # Ø 25 of a diameter of 50: the change is 6.25
        (12.5, 6.4, SuspicionReason.RADIUS_ENTERED),  # .3 from half; a tenth of the change is .61
        (12.5, 6.7, None),  # .9 from half; a tenth of the change is .58
        (-12.5, -6.25, SuspicionReason.RADIUS_ENTERED),
        (12.5, 25.0, SuspicionReason.DOUBLE_DIAMETER),
        (12.5, 26.5, None),  # 1.5 from twice; a tenth of the change is 1.4
        (1.0, 0.5, SuspicionReason.RADIUS_ENTERED),  # .5 mm is not a large change
        (12.5, 12.4, None),
        (12.5, 12.5, None),
        (0.0, 0.0, None),
        (0.0, 10.0, None),
        (12.5, 0.0, None),
        (12.5, -6.25, None),  # the other side has its own reason
    ],
)
def test_half_and_twice_the_old_diameter_are_suspicious(
    old: float, new: float, reason: SuspicionReason | None
) -> None:
    assert find_factor_suspicion(old, new) is reason


@pytest.mark.parametrize(
    ("row", "quadrant", "tip_x", "wrong"),
    [
        (ToolShapeRow("turning"), 3, 10.0, False),
        (ToolShapeRow("turning"), 2, 10.0, True),  # points away from the axis
        (ToolShapeRow("turning"), 2, -10.0, False),
        (ToolShapeRow("boring", diameter=12.0), 2, 10.0, False),
        (ToolShapeRow("boring", diameter=12.0), 3, 10.0, True),  # a bar that points to the axis
        (ToolShapeRow("boring", diameter=12.0), 3, -10.0, False),
        (ToolShapeRow("grooving"), 6, 10.0, True),
        (ToolShapeRow("turning"), 7, -10.0, False),  # points neither to the axis nor away from it
        (ToolShapeRow("turning"), 0, -10.0, False),
        (ToolShapeRow("drill", diameter=8.0), 8, -10.0, False),
    ],
)
def test_quadrant_of_a_stored_shape_must_fit_the_side(
    row: ToolShapeRow, quadrant: int, tip_x: float, wrong: bool
) -> None:
    assert is_quadrant_for_other_side(row, ToolOffsetRow(quadrant=quadrant), tip_x) is wrong
