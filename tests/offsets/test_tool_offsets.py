"""F8: a cell is chosen, typed into and saved; what is refused, and when."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.machine.machine_files import shipped_machine
from app.desk.state.desk_machine import DeskMachine
from app.offsets.tool_offsets import ToolOffsets
from core.executor.snapshot import State
from core.store.store_rows import ToolRow
from tests.offsets.conftest import LIMIT, Room, room_on
from tests.texts import text

INCH = 25.4


def set_tools(room: Room) -> None:
    """T1 and T2 stand in the table."""
    room.store.offsets.tools.change_row(1, "touched off", {"x": -12.7, "z": -76.2, "nose_radius": 0.381})
    room.store.offsets.tools.change_row(2, "touched off", {"x": 25.4, "z": -50.8}).result(LIMIT)
    room.desk.book.read()  # as a desk that is opened now reads them


def at(room: Room, number: int, name: str) -> ToolOffsets:
    """F8 with the cursor on a cell."""
    grid = room.grid()
    grid.look(room.now[0])
    names = ("x", "z", "nose_radius", "quadrant", "wear_x", "wear_z", "master", "remark")
    grid.choose(number, names.index(name))
    return grid


def write(grid: ToolOffsets, text: str) -> None:
    for key in text:
        assert grid.typed(key)


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
def test_a_length_is_read_as_the_control_shows_it(
    room: Room, diameter: bool, name: str, typed: str, mm: float
) -> None:
    set_tools(room)
    room.at(diameter=diameter)
    grid = at(room, 1, name)
    room.enter(grid, typed)
    assert getattr(room.store.offsets.tools.read_rows()[1], name) == pytest.approx(mm, abs=1e-12)
    assert room.desk.notice == "T1 SAVED"


def test_f2_adds_to_what_is_there(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "wear_x")
    for _ in range(10):
        write(grid, ".0001")
        grid.add()
        room.settle(grid)
    assert room.store.offsets.tools.read_rows()[1].wear_x == 0.0005 * INCH
    assert room.store.offsets.read_history()[0].why == "WEAR X + .0001"
    grid.add()
    assert room.desk.notice == text("offsets.add-first")


def test_quadrant_remark_and_the_sum_that_the_control_gets(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "quadrant")
    room.enter(grid, "3")
    grid.choose(1, 7)
    assert grid.typed("Enter")
    write(grid, "Hard END, .4 R")
    assert grid.typed("Enter")
    room.settle(grid)
    grid.choose(1, 5)
    room.enter(grid, "-.002")
    row = room.store.offsets.tools.read_rows()[1]
    assert row == pytest.approx(ToolRow(-12.7, -76.2, 0.381, 0.0, -0.0508, 3)[:6] + row[6:])
    assert row.remark == "Hard END, .4 R"
    assert row.offset == pytest.approx((-12.7, -76.2508))


def test_a_remark_takes_letters_only_once_it_is_open(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "remark")
    assert not grid.takes("H")
    assert not grid.typed("H")
    grid.typed("Enter")
    assert grid.takes("H")
    assert grid.typed("H")
    assert grid.escape()
    assert not grid.takes("H")
    assert room.store.offsets.tools.read_rows()[1].remark == ""


def test_a_tool_that_was_never_set_needs_x_and_z_together(room: Room) -> None:
    grid = at(room, 7, "x")
    room.enter(grid, "1")
    assert room.store.offsets.tools.read_rows() == {}
    assert room.desk.notice == text("offsets.half-set", axis="Z", number=7)
    assert grid.name == "z"
    room.enter(grid, "-2")
    assert room.store.offsets.tools.read_rows() == {7: ToolRow(INCH, -2 * INCH)}


def test_half_a_tool_is_forgotten_when_it_is_left(room: Room) -> None:
    grid = at(room, 7, "z")
    room.enter(grid, "1")
    grid.typed("Down")
    assert room.desk.notice == text("offsets.not-set", number=7)
    assert grid.cell(7, "z") == ""
    assert room.store.offsets.tools.read_rows() == {}


@pytest.mark.parametrize("name", ["nose_radius", "wear_x", "quadrant"])
def test_no_other_field_of_a_tool_that_was_never_set(room: Room, name: str) -> None:
    grid = at(room, 7, name)
    room.enter(grid, "0")
    assert room.desk.notice == text("offsets.never-set", number=7)
    assert room.store.offsets.tools.read_rows() == {}


def test_the_master_is_chosen_and_the_others_are_shown_from_it(room: Room) -> None:
    set_tools(room)
    grid = at(room, 2, "master")
    grid.turn_relative()
    assert room.desk.notice == text("offsets.no-master")
    before = {n: row.offset for n, row in room.store.offsets.tools.read_rows().items()}
    room.enter(grid, "", asked=True)
    assert room.desk.book.master == 2
    assert {n: row.offset for n, row in room.store.offsets.tools.read_rows().items()} == before
    grid.turn_relative()
    # T1 - T2: X (-.5 - 1) in, Z (-3 - -2) in
    assert (grid.cell(1, "x"), grid.cell(1, "z")) == ("−1.50000", "−1.00000")
    assert grid.cell(2, "x") == "+1.00000"
    room.enter(grid, "", asked=True)
    assert room.desk.book.master == 0
    grid.choose(1, 0)
    room.enter(grid, "1")
    assert room.desk.notice == text("offsets.shown-from-master")  # from the master they are only shown
    assert room.store.offsets.tools.read_rows()[1].x == -12.7


def test_the_cursor_does_not_leave_what_is_typed(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "x")
    write(grid, "1")
    grid.typed("Down")
    assert (grid.number, grid.text) == (1, "1")
    assert room.desk.notice == text("offsets.set-it")
    assert grid.old_to_new == "−0.50000  →  +1.00000"
    assert grid.escape()
    grid.typed("Page down")
    assert grid.number == 6
    assert not grid.escape()


GEOMETRY = ("x", "z", "nose_radius", "quadrant", "master")


@pytest.mark.parametrize("state", [State.RUN, State.WAIT, State.HOLD, State.BLOCK_END, State.HOLDING])
@pytest.mark.parametrize("name", GEOMETRY)
def test_no_geometry_changes_while_a_cycle_is_under_way(room: Room, state: State, name: str) -> None:
    set_tools(room)
    before = room.store.offsets.tools.read_rows()
    room.at(state)
    grid = at(room, 1, name)
    room.enter(grid, "1" if name != "master" else "")
    assert "PROGRAM RUNNING" in room.desk.notice
    assert "PROGRAM RUNNING" in grid.prompt(room.now[0])
    grid.escape()
    grid.undo()
    assert not room.desk.asked
    assert "PROGRAM RUNNING" in room.desk.notice
    room.settle(grid)
    assert room.store.offsets.tools.read_rows() == before


@pytest.mark.parametrize("name", GEOMETRY)
@pytest.mark.parametrize("state", [State.RUN, State.HOLD, State.PROGRAM_STOP])
def test_while_a_part_runs_only_wear_may_change(room: Room, state: State, name: str) -> None:
    set_tools(room)
    room.at(state)
    grid = at(room, 1, name)
    room.enter(grid, "1" if name != "master" else "")
    assert room.desk.notice == text("offsets.only-wear")
    grid.escape()
    grid.choose(1, 4)
    room.enter(grid, "-.001")
    assert room.desk.notice == f"T1 SAVED{text('offsets.next-start')}"
    assert room.store.offsets.tools.read_rows()[1].wear_x == pytest.approx(-0.0127)


def test_a_start_in_the_middle_of_an_entry_refuses_its_end(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "x")
    write(grid, "1")
    room.at(State.RUN)
    room.enter(grid, "")
    assert "PROGRAM RUNNING" in room.desk.notice
    assert room.store.offsets.tools.read_rows()[1].x == -12.7


def test_another_unit_in_the_middle_gives_the_entry_up(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "x")
    write(grid, "1")
    room.at(metric=True)
    grid.look(room.now[0])
    assert grid.text == ""
    assert room.desk.notice == text("offsets.units-changed")


def test_a_part_that_switches_to_diameters_leaves_an_entry_of_wear_alone(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "wear_x")
    room.at(State.RUN)
    grid.look(room.now[0])
    write(grid, "-.001")
    room.at(State.RUN, diameter=True)
    room.enter(grid, "")
    assert room.store.offsets.tools.read_rows()[1].wear_x == pytest.approx(-0.0127)


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
def test_what_is_no_value_is_refused_and_stays_to_be_mended(
    room: Room, name: str, typed: str, why: str
) -> None:
    set_tools(room)
    before = room.store.offsets.tools.read_rows()
    grid = at(room, 1, name)
    write(grid, typed) if "," not in typed else setattr(grid, "text", typed)
    grid.typed("Enter")
    assert room.desk.notice.startswith(why)
    assert grid.text == typed
    room.settle(grid)
    assert room.store.offsets.tools.read_rows() == before


def test_undo_and_history(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "wear_x")
    room.enter(grid, "-.001")
    grid.undo()
    room.confirm()
    room.settle(grid)
    assert room.store.offsets.tools.read_rows()[1].wear_x == 0.0
    assert room.desk.notice == "T1 UNDONE"
    grid.history.toggle()
    assert grid.history.listed is not None
    at_, which, change, why = grid.history.in_words(grid.history.listed[1])
    assert (which, why) == ("T1", "WEAR X -.001")
    assert change == "WEAR X +0.00000 → −0.00100"
    assert at_.startswith("20")
    assert grid.escape()


def test_undo_of_half_a_tool_takes_that_back_and_no_older_change(room: Room) -> None:
    set_tools(room)
    before = room.store.offsets.tools.read_rows()
    grid = at(room, 5, "x")
    room.enter(grid, "1")
    assert grid.fields.new.number == 5
    grid.undo()
    assert not room.desk.asked
    room.settle(grid)
    assert (grid.fields.new.number, room.store.offsets.tools.read_rows()) == (0, before)
    assert "UNDONE" not in room.desk.notice


def test_c_and_letters_are_not_taken(room: Room) -> None:
    grid = room.grid()
    assert not grid.typed("C")
    assert not grid.typed("H")


def test_d_is_no_key_where_the_language_has_no_edges(room: Room) -> None:
    set_tools(room)
    grid = at(room, 1, "z")
    assert not grid.typed("D")
    assert grid.rows[:2] == (1, 2)
    assert "edge" not in grid.foot


@pytest.fixture
def with_edges(tmp_path: Path) -> Iterator[Room]:
    """At a lathe whose programs are SINUMERIK's."""
    with room_on(tmp_path, DeskMachine(model=shipped_machine("sinumerik-modulo"))) as made:
        yield made


def test_d_opens_another_cutting_edge(with_edges: Room) -> None:
    room = with_edges
    set_tools(room)
    grid = at(room, 1, "z")
    assert grid.typed("d")
    assert (grid.number, grid.name, grid.rows[:3]) == (200_001, "x", (1, 200_001, 2))
    room.enter(grid, ".5")
    room.enter(grid, "-3.2")
    assert room.store.offsets.tools.read_rows()[200_001] == pytest.approx(ToolRow(0.5 * INCH, -3.2 * INCH))
    assert room.desk.notice == "T1 D2 SAVED"
    assert grid.typed("Down")
    assert grid.number == 2
    assert grid.typed("Up")
    assert grid.question.startswith("T1 D2 ")


def test_an_edge_that_nobody_has_typed_goes_again(with_edges: Room) -> None:
    room = with_edges
    set_tools(room)
    grid = at(room, 1, "x")
    grid.typed("D")
    grid.typed("Down")
    assert (grid.number, grid.rows[:2]) == (2, (1, 2))


def test_no_edge_of_a_tool_that_was_never_set(with_edges: Room) -> None:
    room = with_edges
    set_tools(room)
    grid = at(room, 5, "x")
    assert grid.typed("D")
    assert grid.number == 5
    assert "T5 IS NOT SET" in room.desk.notice
