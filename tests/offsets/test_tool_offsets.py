"""F8: a cell is chosen, typed into and saved; what is refused, and when."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.desk.state.desk_machine import DeskMachine
from app.offsets.tool_offsets import ToolOffsetTable
from core.executor.snapshot import MachineState
from core.store.store_rows import ToolOffsetRow
from tests.offsets.conftest import LIMIT, Room, room_on
from tests.texts import text

INCH = 25.4


def set_tools(room: Room) -> None:
    """T1 and T2 stand in the table."""
    room.store.offsets.tool_offsets.change_row(
        1, "touched off", {"x": -12.7, "z": -76.2, "nose_radius": 0.381}
    )
    room.store.offsets.tool_offsets.change_row(2, "touched off", {"x": 25.4, "z": -50.8}).result(LIMIT)
    room.desk.offset_book.read_store()  # as a desk that is opened now reads them


def at(room: Room, number: int, name: str) -> ToolOffsetTable:
    """F8 with the cursor on a cell."""
    grid = room.grid()
    grid.update(room.now[0])
    names = ("x", "z", "nose_radius", "quadrant", "wear_x", "wear_z", "master", "remark")
    grid.select_cell(number, names.index(name))
    return grid


def write(grid: ToolOffsetTable, text: str) -> None:
    for key in text:
        assert grid.handle_key(key)


@pytest.mark.parametrize(
    ("diameter", "name", "typed", "mm"),
    [
        (False, "x", "-.51", -0.51 * INCH),
        (True, "x", "-.98", -0.49 * INCH),
        (True, "wear_x", "-.001", -0.0005 * INCH),
        (False, "wear_x", "-.001", -0.0005 * INCH),
        (True, "wear_z", "-.001", -0.001 * INCH),
        (True, "nose_radius", ".0156", 0.0156 * INCH),
        (False, "z", "-3-.01", -3.01 * INCH),
    ],
)
def test_length_is_read_in_displayed_units(
    room: Room, diameter: bool, name: str, typed: str, mm: float
) -> None:
    set_tools(room)
    room.at(diameter=diameter)
    grid = at(room, 1, name)
    room.enter(grid, typed)
    assert getattr(room.store.offsets.tool_offsets.read_rows()[1], name) == pytest.approx(mm, abs=1e-12)
    assert room.desk.prompt_notice == "T1 SAVED"


def test_f2_adds_to_current_value(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "wear_x")
    for _ in range(10):
        write(grid, ".0001")
        grid.add_entered_value()
        room.settle(grid)
    assert room.store.offsets.tool_offsets.read_rows()[1].wear_x == 0.0005 * INCH
    assert room.store.offsets.read_history()[0].why == "WEAR X + .0001"
    grid.add_entered_value()
    assert room.desk.prompt_notice == text("offsets.add-first")


def test_quadrant_remark_and_total_offset_are_stored(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "quadrant")
    room.enter(grid, "3")
    grid.select_cell(1, 7)
    assert grid.handle_key("Enter")
    write(grid, "Hard END, .4 R")
    assert grid.handle_key("Enter")
    room.settle(grid)
    grid.select_cell(1, 5)
    room.enter(grid, "-.002")
    row = room.store.offsets.tool_offsets.read_rows()[1]
    assert row == pytest.approx(ToolOffsetRow(-12.7, -76.2, 0.381, 0.0, -0.0508, 3)[:6] + row[6:])
    assert row.remark == "Hard END, .4 R"
    assert row.offset == pytest.approx((-12.7, -76.2508))


def test_remark_accepts_letters_only_when_open(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "remark")
    assert not grid.accepts_key("H")
    assert not grid.handle_key("H")
    grid.handle_key("Enter")
    assert grid.accepts_key("H")
    assert grid.handle_key("H")
    assert grid.handle_escape()
    assert not grid.accepts_key("H")
    assert room.store.offsets.tool_offsets.read_rows()[1].remark == ""


def test_a_tool_that_was_never_set_needs_x_and_z_together(room: Room) -> None:
    grid = at(room, 7, "x")
    room.enter(grid, "1")
    assert room.store.offsets.tool_offsets.read_rows() == {}
    assert room.desk.prompt_notice == text("offsets.half-set", axis="Z", number=7)
    assert grid.name == "z"
    room.enter(grid, "-2")
    assert room.store.offsets.tool_offsets.read_rows() == {7: ToolOffsetRow(INCH, -2 * INCH)}


def test_incomplete_tool_is_discarded_when_left(room: Room) -> None:
    grid = at(room, 7, "z")
    room.enter(grid, "1")
    grid.handle_key("Down")
    assert room.desk.prompt_notice == text("offsets.not-set", number=7)
    assert grid.format_cell(7, "z") == ""
    assert room.store.offsets.tool_offsets.read_rows() == {}


@pytest.mark.parametrize("name", ["nose_radius", "wear_x", "quadrant"])
def test_other_fields_of_unset_tool_are_rejected(room: Room, name: str) -> None:
    grid = at(room, 7, name)
    room.enter(grid, "0")
    assert room.desk.prompt_notice == text("offsets.never-set", number=7)
    assert room.store.offsets.tool_offsets.read_rows() == {}


def test_tools_are_shown_relative_to_selected_master(room: Room) -> None:
    set_tools(room)
    grid = at(room, 2, "master")
    grid.toggle_relative_display()
    assert room.desk.prompt_notice == text("offsets.no-master")
    before = {n: row.offset for n, row in room.store.offsets.tool_offsets.read_rows().items()}
    room.enter(grid, "", asked=True)
    assert room.desk.offset_book.master_tool_number == 2
    assert {n: row.offset for n, row in room.store.offsets.tool_offsets.read_rows().items()} == before
    grid.toggle_relative_display()
    # T1 - T2: X (-.5 - 1) in, Z (-3 - -2) in
    assert (grid.format_cell(1, "x"), grid.format_cell(1, "z")) == ("−1.50000", "−1.00000")
    assert grid.format_cell(2, "x") == "+1.00000"
    room.enter(grid, "", asked=True)
    assert room.desk.offset_book.master_tool_number == 0
    grid.select_cell(1, 0)
    room.enter(grid, "1")
    assert room.desk.prompt_notice == text("offsets.shown-from-master")  # from the master they are only shown
    assert room.store.offsets.tool_offsets.read_rows()[1].x == -12.7


def test_cursor_does_not_leave_unfinished_entry(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "x")
    write(grid, "1")
    grid.handle_key("Down")
    assert (grid.tool_number, grid.text) == (1, "1")
    assert room.desk.prompt_notice == text("offsets.set-it")
    assert grid.change_description == "−0.50000  →  +1.00000"
    assert grid.handle_escape()
    grid.select_row(5)
    assert grid.tool_number == 6
    assert not grid.handle_escape()


GEOMETRY = ("x", "z", "nose_radius", "quadrant", "master")


@pytest.mark.parametrize(
    "state",
    [
        MachineState.RUN,
        MachineState.WAIT,
        MachineState.HOLD,
        MachineState.SINGLE_BLOCK_STOP,
        MachineState.STOPPING,
    ],
)
@pytest.mark.parametrize("name", GEOMETRY)
def test_geometry_change_is_rejected_during_cycle(room: Room, state: MachineState, name: str) -> None:
    set_tools(room)
    before = room.store.offsets.tool_offsets.read_rows()
    room.at(state)
    grid = at(room, 1, name)
    room.enter(grid, "1" if name != "master" else "")
    assert "PROGRAM RUNNING" in room.desk.prompt_notice
    assert "PROGRAM RUNNING" in grid.prompt_text(room.now[0])
    grid.handle_escape()
    grid.handle_undo()
    assert not room.desk.confirmation_key
    assert "PROGRAM RUNNING" in room.desk.prompt_notice
    room.settle(grid)
    assert room.store.offsets.tool_offsets.read_rows() == before


@pytest.mark.parametrize("name", GEOMETRY)
@pytest.mark.parametrize("state", [MachineState.RUN, MachineState.HOLD, MachineState.PROGRAM_STOP])
def test_while_a_part_runs_only_wear_may_change(room: Room, state: MachineState, name: str) -> None:
    set_tools(room)
    room.at(state)
    grid = at(room, 1, name)
    room.enter(grid, "1" if name != "master" else "")
    assert room.desk.prompt_notice == text("offsets.only-wear")
    grid.handle_escape()
    grid.select_cell(1, 4)
    room.enter(grid, "-.001")
    assert room.desk.prompt_notice == f"T1 SAVED{text('offsets.next-start')}"
    assert room.store.offsets.tool_offsets.read_rows()[1].wear_x == pytest.approx(-0.0127)


def test_start_during_entry_rejects_its_completion(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "x")
    write(grid, "1")
    room.at(MachineState.RUN)
    room.enter(grid, "")
    assert "PROGRAM RUNNING" in room.desk.prompt_notice
    assert room.store.offsets.tool_offsets.read_rows()[1].x == -12.7


def test_unit_change_cancels_entry(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "x")
    write(grid, "1")
    room.at(metric=True)
    grid.update(room.now[0])
    assert grid.text == ""
    assert room.desk.prompt_notice == text("offsets.units-changed")


def test_diameter_mode_change_does_not_cancel_wear_entry(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "wear_x")
    room.at(MachineState.RUN)
    grid.update(room.now[0])
    write(grid, "-.001")
    room.at(MachineState.RUN, diameter=True)
    room.enter(grid, "")
    assert room.store.offsets.tool_offsets.read_rows()[1].wear_x == pytest.approx(-0.0127)


def would_become(field: str, value: str, low: str, high: str) -> str:
    """Return the notice about a value that is out of range, in inches."""
    why = text("offsets.would-become", field=field, value=value, unit="in", low=low, high=high)
    return text("offsets.refused", why=why)


@pytest.mark.parametrize(
    ("name", "typed", "why"),
    [
        ("x", "51", would_become("X", "+51.00000", "-50", "50")),
        ("x", "0,5", "REJECTED: , in 0,5 is not a number"),
        ("nose_radius", "-.1", would_become("nose radius", "−0.10000", "0", "2")),
        ("wear_x", ".21", would_become("wear X", "+0.21000", "-0.2", "0.2")),
        (
            "quadrant",
            "10",
            text("offsets.refused", why=text("offsets.takes", field="tip quadrant", range="0…9")),
        ),
        (
            "quadrant",
            "2.5",
            text("offsets.refused", why=text("offsets.takes", field="tip quadrant", range="0…9")),
        ),
    ],
)
def test_invalid_value_is_rejected_and_remains_for_editing(
    room: Room, name: str, typed: str, why: str
) -> None:
    set_tools(room)
    before = room.store.offsets.tool_offsets.read_rows()
    grid = at(room, 1, name)
    write(grid, typed) if "," not in typed else setattr(grid, "text", typed)
    grid.handle_key("Enter")
    assert room.desk.prompt_notice.startswith(why)
    assert grid.text == typed
    room.settle(grid)
    assert room.store.offsets.tool_offsets.read_rows() == before


def test_undo_restores_values_and_history_lists_changes(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "wear_x")
    room.enter(grid, "-.001")
    grid.handle_undo()
    room.confirm()
    room.settle(grid)
    assert room.store.offsets.tool_offsets.read_rows()[1].wear_x == 0.0
    assert room.desk.prompt_notice == "T1 UNDONE"
    grid.offset_history.toggle_change_list()
    assert grid.offset_history.listed_changes is not None
    at_, which, change, why = grid.offset_history.format_change(grid.offset_history.listed_changes[1])
    assert (which, why) == ("T1", "WEAR X -.001")
    assert change == "WEAR X +0.00000 → −0.00100"
    assert at_.startswith("20")
    assert grid.handle_escape()


def test_undo_of_incomplete_tool_does_not_undo_older_change(room: Room) -> None:
    set_tools(room)
    before = room.store.offsets.tool_offsets.read_rows()
    grid = at(room, 5, "x")
    room.enter(grid, "1")
    assert grid.tool_fields.incomplete_tool.tool_number == 5
    grid.handle_undo()
    assert not room.desk.confirmation_key
    room.settle(grid)
    assert (grid.tool_fields.incomplete_tool.tool_number, room.store.offsets.tool_offsets.read_rows()) == (
        0,
        before,
    )
    assert "UNDONE" not in room.desk.prompt_notice


def test_c_and_letter_keys_are_not_handled(room: Room) -> None:
    grid = room.grid()
    assert not grid.handle_key("C")
    assert not grid.handle_key("H")


def test_d_key_is_ignored_in_language_without_edges(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "z")
    assert not grid.handle_key("D")
    assert grid.row_numbers[:2] == (1, 2)
    assert "edge" not in grid.footer_text


@pytest.fixture
def with_edges(tmp_path: Path) -> Iterator[Room]:
    """At a lathe whose programs are SINUMERIK's."""
    with room_on(tmp_path, DeskMachine(machine=load_shipped_machine("sinumerik-modulo"))) as made:
        yield made


def test_d_opens_another_cutting_edge(with_edges: Room) -> None:
    room = with_edges
    set_tools(room)
    grid = at(room, 1, "z")
    assert grid.handle_key("d")
    assert (grid.tool_number, grid.name, grid.row_numbers[:3]) == (200_001, "x", (1, 200_001, 2))
    room.enter(grid, ".5")
    room.enter(grid, "-3.2")
    assert room.store.offsets.tool_offsets.read_rows()[200_001] == pytest.approx(
        ToolOffsetRow(0.5 * INCH, -3.2 * INCH)
    )
    assert room.desk.prompt_notice == "T1 D2 SAVED"
    assert grid.handle_key("Down")
    assert grid.tool_number == 2
    assert grid.handle_key("Up")
    assert grid.question_text.startswith("T1 D2 ")


def test_unedited_cutting_edge_is_discarded(with_edges: Room) -> None:
    room = with_edges
    set_tools(room)
    grid = at(room, 1, "x")
    grid.handle_key("D")
    grid.handle_key("Down")
    assert (grid.tool_number, grid.row_numbers[:2]) == (2, (1, 2))


def test_unset_tool_has_no_other_edge(with_edges: Room) -> None:
    room = with_edges
    set_tools(room)
    grid = at(room, 5, "x")
    assert grid.handle_key("D")
    assert grid.tool_number == 5
    assert "T5 IS NOT SET" in room.desk.prompt_notice
