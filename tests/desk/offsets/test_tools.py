"""F8: every value becomes what is typed, X as Ø or R; refused while a program is under way."""

from __future__ import annotations

import pytest

from app.desk.offsets.desk import TOOLS_REFUSED
from app.desk.offsets.dialogue import Step
from core.executor.snapshot import State
from tests.desk.offsets.conftest import Room


@pytest.mark.parametrize(
    ("diameter", "x", "asked"), [(False, 1.25, "X RADIUS?"), (True, 0.625, "X DIAMETER?")]
)
def test_x_is_read_as_the_control_shows_it(room: Room, diameter: bool, x: float, asked: str) -> None:
    room.at(diameter=diameter)
    page = room.page(tools=True)
    room.enter(page, "5")
    assert page.dialogue.question == asked
    room.enter(page, "1.25", "-3", ".0156")
    assert room.store.tools()[5] == pytest.approx((x * 25.4, -3 * 25.4, 0.0156 * 25.4))
    assert page.old_to_new.startswith("T5   not set  →  X" + ("Ø +1.25000" if diameter else " +1.25000"))


def test_values_become_what_is_typed_and_return_keeps(room: Room) -> None:
    page = room.page(tools=True)
    room.enter(page, "1", "1", "2", ".1")
    room.enter(page, "1", "", "2.5", "")
    assert room.store.tools()[1] == pytest.approx((25.4, 2.5 * 25.4, 0.1 * 25.4))
    assert page.old_to_new.count("Z +2.00000") == 1
    page.undo()
    room.settle(page)
    assert room.store.tools()[1].z == pytest.approx(50.8)


def test_half_of_a_tool_that_was_never_set_is_refused(room: Room) -> None:
    page = room.page(tools=True)
    room.enter(page, "7", "")
    assert room.desk.notice == "REFUSED: this tool was never set; type X"
    room.enter(page, "1", "")
    assert room.desk.notice == "REFUSED: this tool was never set; type Z"
    assert room.store.tools() == {}


@pytest.mark.parametrize("state", [State.RUN, State.WAIT, State.HOLD, State.PROGRAM_STOP, State.BLOCK_END])
def test_nothing_changes_while_a_program_is_under_way(room: Room, state: State) -> None:
    page = room.page(tools=True)
    room.enter(page, "1", "1", "2", "")
    room.at(state)
    assert page.prompt(room.now[0]) == TOOLS_REFUSED
    room.enter(page, "1")
    assert room.desk.notice == TOOLS_REFUSED
    assert page.dialogue.step is Step.NUMBER
    room.desk.clear()
    page.undo()
    assert room.desk.notice == TOOLS_REFUSED
    room.settle(page)
    assert room.store.tools()[1] == pytest.approx((25.4, 50.8, 0.0))


def test_a_start_in_the_middle_of_an_entry_refuses_its_end(room: Room) -> None:
    page = room.page(tools=True)
    room.enter(page, "1", "1", "2")
    room.at(State.RUN)
    room.enter(page, "")
    assert room.desk.notice == TOOLS_REFUSED
    assert room.store.tools() == {}


@pytest.mark.parametrize("answers", [("33",), ("1", "51"), ("1", "1", "-51"), ("1", "1", "1", "2.1")])
def test_what_is_out_of_range_is_refused(room: Room, answers: tuple[str, ...]) -> None:
    page = room.page(tools=True)
    room.enter(page, *answers)
    assert room.desk.notice.startswith("REFUSED: T")
    assert room.store.tools() == {}


def test_c_is_no_clear_here(room: Room) -> None:
    assert not room.page(tools=True).typed("C")
