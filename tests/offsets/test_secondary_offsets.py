"""F9 in the control's words: what each answer does, what is refused, what is remembered."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.offsets.offset_book import OffsetBook
from app.offsets.offset_values import UnitMode, format_offset
from app.offsets.secondary_offsets import SecondaryOffsetStep
from core.executor.snapshot import MachineState
from core.store.store_rows import OffsetKind, SecondaryOffsetRow
from tests.offsets.conftest import LIMIT, Room, room_on
from tests.texts import text


def test_questions_are_asked_in_order(room: Room) -> None:
    page = room.page()
    asked = []
    for key in ("1", "", "", ""):
        asked.append(page.question_text)
        room.enter(page, key)
    assert asked == ["Offset Number?", "X DIAMETER CORRECTION?", "Z CORRECTION?", "R?"]
    assert page.entry_step is SecondaryOffsetStep.NUMBER


def test_x_is_halved_and_added_z_added_r_replaced(room: Room) -> None:
    page = room.page()
    room.enter(page, "3", "-.001", ".002", ".0156")
    room.enter(page, "3", "-.001", ".002", ".0312")
    x, z, r = (value / 25.4 for value in room.store.offsets.secondary_offsets.read_rows()[3])
    assert (x, z, r) == pytest.approx((-0.001, 0.004, 0.0312), abs=1e-12)
    assert (
        format_offset(room.store.offsets.secondary_offsets.read_rows()[3], UnitMode())
        == "X −0.00100  Z +0.00400  R 0.03120"
    )


def test_empty_offset_row_is_formatted_as_on_original_control() -> None:
    assert format_offset(SecondaryOffsetRow(), UnitMode()) == "X +0.00000  Z +0.00000  R 0.00000"
    assert (
        format_offset(SecondaryOffsetRow(0.0, -0.01, 0.4), UnitMode(is_metric=True))
        == "X +0.0000  Z −0.0100  R 0.4000"
    )


def test_ten_small_corrections_equal_one_large_one(room: Room) -> None:
    page = room.page()
    for _ in range(10):
        room.enter(page, "1", ".0001", "", "")
    assert room.store.offsets.secondary_offsets.read_rows()[1].x == 0.0005 * 25.4


def test_return_without_value_leaves_offset_unchanged(room: Room) -> None:
    page = room.page()
    room.enter(page, "2", ".1", ".2", ".3", asked=True)
    room.enter(page, "2", "", ".01", "")
    assert room.store.offsets.secondary_offsets.read_rows()[2] == pytest.approx(
        (0.05 * 25.4, 0.21 * 25.4, 0.3 * 25.4)
    )
    room.enter(page, "2", "", "", "")
    assert room.desk.prompt_notice == text("offsets.as-it-was", number=2)
    assert len(room.store.offsets.read_history()) == 2


def test_entry_evaluates_arithmetic_and_shows_old_and_new_values(room: Room) -> None:
    page = room.page()
    room.enter(page, "1")
    for key in ".5-.002":
        page.handle_key(key)
    assert page.change_description.endswith("→  X +0.24900  Z +0.00000  R 0.00000")
    page.handle_key("+")  # half a sum: the last figure that was one
    assert page.preview_row == (0.0, 0.0, 0.0)
    page.handle_key("Back")
    room.enter(page, "", "", "", asked=True)
    assert room.store.offsets.secondary_offsets.read_rows()[1].x == pytest.approx(0.249 * 25.4)
    assert room.desk.prompt_notice == "D1 SAVED"
    assert page.change_description == "D1   not set  →  X +0.24900  Z +0.00000  R 0.00000"


def would_become(name: str, value: str, low: str, high: str) -> str:
    """Return the text about a correction that is out of range, in inches."""
    return text("offsets.would-become", field=name, value=value, unit="in", low=low, high=high)


@pytest.mark.parametrize(
    ("answers", "why"),
    [
        (("0",), "D0 does not exist; offsets are D1…32"),
        (("33",), "D33 does not exist; offsets are D1…32"),
        (("1.5",), "D1.5 does not exist; offsets are D1…32"),
        (("",), text("offsets.nothing-entered")),
        (("1", ".5-"), ".5- is incomplete; expected a number at the end"),
        (("1", "0,5"), ", in 0,5 is not a number; use a decimal point instead of a comma"),
        (("1", "1/0"), text("offsets.divides-by-zero", text="1/0")),
        (("1", "21"), would_become("D1 X", "10.50000", "-10", "10")),
        (("1", "", "-10.1"), would_become("D1 Z", "−10.10000", "-10", "10")),
        (("1", "", "", "-.01"), would_become("D1 R", "−0.01000", "0", "2")),
    ],
)
def test_rejected_value_shows_reason_and_asks_again(room: Room, answers: tuple[str, ...], why: str) -> None:
    page = room.page()
    room.enter(page, *answers)
    assert room.desk.prompt_notice == text("offsets.refused", why=why)
    assert page.text == answers[-1]
    assert room.store.offsets.secondary_offsets.read_rows() == {}


def test_entry_is_metric_when_control_is_metric(room: Room) -> None:
    room.at(metric=True)
    page = room.page()
    room.enter(page, "1", ".02", "-.5", ".4", asked=True)
    assert room.store.offsets.secondary_offsets.read_rows()[1] == (0.01, -0.5, 0.4)
    assert room.store.offsets.read_history()[0].why == "MM X .02 Z -.5 R .4"


def test_unit_change_cancels_entry(room: Room) -> None:
    page = room.page()
    room.enter(page, "1", ".02")
    room.at(metric=True)
    page.update(room.now[0])
    assert page.entry_step is SecondaryOffsetStep.NUMBER
    assert "NOTHING SAVED" in room.desk.prompt_notice
    assert room.store.offsets.secondary_offsets.read_rows() == {}


def test_escape_returns_one_step_at_a_time(room: Room) -> None:
    page = room.page()
    room.enter(page, "4", ".1")
    assert page.handle_escape()
    assert room.desk.prompt_notice == text("offsets.as-it-was", number=4)
    assert page.question_text == "Offset Number?"
    assert not page.handle_escape()
    assert room.store.offsets.secondary_offsets.read_rows() == {}


def test_clear_asks_for_confirmation(room: Room) -> None:
    page = room.page()
    room.enter(page, "1", ".1", "", "", asked=True)
    room.enter(page, "9", "", ".1", "", asked=True)
    assert page.handle_key("C")
    assert room.desk.prompt_notice == text("offsets.clear-all")
    assert page.handle_escape()
    page.handle_key("c")
    page.handle_key("7")  # any other key takes the question back
    page.handle_key("Back")
    page.handle_key("C")
    room.settle(page)
    assert len(room.store.offsets.secondary_offsets.read_rows()) == 2
    page.handle_key("C")
    room.settle(page)
    assert len(room.store.offsets.secondary_offsets.read_rows()) == 2
    room.desk.prompt_line._since = float("-inf")
    room.desk.confirm_question_if_unchanged()
    room.settle(page)
    assert room.store.offsets.secondary_offsets.read_rows() == {}
    assert page.change_description == text("offsets.count-changed", count=2, keys="F5")
    page.handle_undo()
    room.confirm()
    room.settle(page)
    assert sorted(room.store.offsets.secondary_offsets.read_rows()) == [1, 9]


def test_clear_is_rejected_during_entry(room: Room) -> None:
    page = room.page()
    room.enter(page, "1", ".1", "", "", asked=True)
    room.enter(page, "1")
    page.handle_key("C")
    page.handle_key("C")
    room.settle(page)
    assert room.store.offsets.secondary_offsets.read_rows()
    assert room.desk.prompt_notice == text("offsets.only-at-number")


def test_undo_affects_only_secondary_offsets(room: Room) -> None:
    page = room.page()
    room.enter(page, "1", ".1", "", "", asked=True)
    room.store.offsets.tool_offsets.change_row(1, "touched off", {"x": 5.0}).result(LIMIT)
    page.handle_undo()
    room.confirm()
    room.settle(page)
    assert room.store.offsets.secondary_offsets.read_rows() == {}
    assert room.store.offsets.tool_offsets.read_rows()[1].x == 5.0
    assert room.desk.prompt_notice == "D1 UNDONE"
    page.handle_undo()
    assert not room.desk.confirmation_key
    assert room.desk.prompt_notice == text("offsets.no-change-to-undo", row=text("offsets.this-table"))


def test_undo_after_number_is_for_that_offset_and_cancels_typed_value(room: Room) -> None:
    page = room.page()
    room.enter(page, "1", ".1", "", "", asked=True)
    room.enter(page, "2", ".2", "", "", asked=True)
    room.enter(page, "1", ".3")
    page.handle_undo()
    assert not room.desk.confirmation_key
    assert room.desk.prompt_notice == text("offsets.as-it-was", number=1)
    room.enter(page, "1")
    page.handle_undo()
    room.confirm()
    room.settle(page)
    assert set(room.store.offsets.secondary_offsets.read_rows()) == {2}
    assert room.desk.prompt_notice == "D1 UNDONE"
    assert page.entry_step is SecondaryOffsetStep.NUMBER


def test_history_lists_time_old_and_new_values_and_reason(room: Room) -> None:
    page = room.page()
    room.enter(page, "1", ".5-.002", "", "", asked=True)
    page.offset_history.toggle_change_list()
    assert page.offset_history.listed_changes is not None
    at, which, change, why = page.offset_history.format_change(page.offset_history.listed_changes[0])
    assert at.startswith("20")
    assert (which, why) == ("D1", "X .5-.002")
    assert change == "not set  →  X +0.24900  Z +0.00000  R 0.00000"
    assert page.handle_escape()
    assert page.offset_history.listed_changes is None


def test_offset_change_reloads_program(room: Room) -> None:
    room.desk.program_loader.start_loading(Path("part.nc"), block_delete=True)
    room.desk.program_loader.wait_until_loaded(LIMIT)
    page = room.page()
    room.enter(page, "1", ".1", "", "", asked=True)
    room.desk.program_loader.wait_until_loaded(LIMIT)
    assert room.loads == ["part.nc", "part.nc"]
    assert room.desk.program_loader.loaded_program.is_block_delete_on


UNDER_WAY = [
    MachineState.RUN,
    MachineState.WAIT,
    MachineState.HOLD,
    MachineState.STOPPING,
    MachineState.SINGLE_BLOCK_STOP,
    MachineState.PROGRAM_STOP,
]


@pytest.mark.parametrize("state", UNDER_WAY)
@pytest.mark.parametrize(("repeat", "when"), [(True, "next-part"), (False, "next-start")])
def test_correction_during_run_applies_to_next_part(
    room: Room, state: MachineState, repeat: bool, when: str
) -> None:
    page = room.page()
    room.at(state)
    room.now[0] = replace(room.now[0], cycle_repeat=repeat)
    assert text(f"offsets.prompt-{when}") in page.prompt_text(room.now[0])
    room.enter(page, "1", ".1", "", "", asked=True)
    assert room.desk.prompt_notice == f"D1 SAVED{text(f'offsets.{when}')}"
    assert room.store.offsets.secondary_offsets.read_rows()[1].x == pytest.approx(0.05 * 25.4)
    page.handle_undo()
    room.confirm()
    room.settle(page)
    assert room.desk.prompt_notice == f"D1 UNDONE{text(f'offsets.{when}')}"


@pytest.mark.parametrize("state", UNDER_WAY)
def test_clear_all_is_rejected_while_program_runs(room: Room, state: MachineState) -> None:
    page = room.page()
    room.enter(page, "1", ".1", "", "", asked=True)
    room.at(state)
    page.handle_key("C")
    page.handle_key("C")
    assert room.desk.prompt_notice == text("offsets.only-wear")
    room.settle(page)
    assert room.store.offsets.secondary_offsets.read_rows()[1].x == pytest.approx(0.05 * 25.4)


@pytest.mark.parametrize("state", [MachineState.JOG, MachineState.HOMING])
def test_correction_is_rejected_while_axes_are_jogged(room: Room, state: MachineState) -> None:
    page = room.page()
    room.at(state)
    room.enter(page, "1")
    assert room.desk.prompt_notice == text("offsets.moving")


def test_diameter_mode_change_of_next_part_does_not_cancel_entry(room: Room) -> None:
    """Every part begins with G73 and goes over to its G72; the correction is a diameter all the same."""
    page = room.page()
    room.at(MachineState.RUN, diameter=True)
    room.enter(page, "3", "-.0002")
    room.at(MachineState.RUN, diameter=False)
    room.enter(page, "", "")
    assert room.store.offsets.secondary_offsets.read_rows()[3].x == pytest.approx(-0.0001 * 25.4)


def test_unit_change_of_next_part_cancels_entry(room: Room) -> None:
    page = room.page()
    room.at(MachineState.RUN)
    room.enter(page, "3", "-.0002")
    room.at(MachineState.RUN, metric=True)
    room.settle(page)
    assert room.desk.prompt_notice == text("offsets.unit-changed")
    assert 3 not in room.store.offsets.secondary_offsets.read_rows()


def test_correction_at_program_stop_applies_after_job_ends(room: Room) -> None:
    room.desk.program_loader.start_loading(Path("part.nc"))
    room.desk.program_loader.wait_until_loaded(LIMIT)
    page = room.page()
    room.at(MachineState.PROGRAM_STOP)
    assert text("offsets.prompt-next-start") in page.prompt_text(room.now[0])
    room.enter(page, "1", ".1", "", "", asked=True)
    assert room.desk.prompt_notice == f"D1 SAVED{text('offsets.next-start')}"
    room.at(MachineState.RUN)
    room.desk.update()
    assert room.loads == ["part.nc"]
    room.at(MachineState.IDLE)
    room.desk.update()
    room.desk.program_loader.wait_until_loaded(LIMIT)
    assert room.loads == ["part.nc", "part.nc"]


@pytest.fixture
def read_only(tmp_path: Path) -> Iterator[Room]:
    book = OffsetBook(lock_reason="READ ONLY", secondary_offsets={1: SecondaryOffsetRow(0.0, 0.1, 0.0)})
    with room_on(tmp_path, book=book) as made:
        yield made


def test_offsets_of_a_file_are_read_only(read_only: Room) -> None:
    room = read_only
    page = room.page()
    room.enter(page, "1")
    assert room.desk.prompt_notice == "READ ONLY"
    page.handle_key("C")
    page.handle_undo()
    assert not room.desk.confirmation_key
    assert room.desk.prompt_notice == "READ ONLY"
    assert page.stored_row is None
    assert page.offset_book.secondary_offsets.get(1) == (0.0, 0.1, 0.0)


def test_change_is_rejected_until_previous_one_is_saved(room: Room) -> None:
    book = OffsetBook(room.store)
    assert book.change_fields(OffsetKind.SECONDARY, 1, {"x": 0.1}, "one") == ""
    assert book.change_fields(OffsetKind.SECONDARY, 1, {"x": 0.2}, "two").startswith("STILL SAVING")
    assert book.undo_step(OffsetKind.SECONDARY, 1, 1).startswith("STILL SAVING")
    room.store.write(lambda _connection: None).result(LIMIT)
    assert book.poll_saving() == ""
    assert book.secondary_offsets.get(1) == (0.1, 0.0, 0.0)


def test_closed_store_is_reported(room: Room) -> None:
    book = OffsetBook(room.store)
    room.store.close()
    assert "closed" in book.change_fields(OffsetKind.SECONDARY, 1, {"x": 0.1}, "late")


def test_program_is_reloaded_when_page_is_left_before_save_completes(room: Room) -> None:
    room.desk.program_loader.start_loading(Path("part.nc"))
    room.desk.program_loader.wait_until_loaded(LIMIT)
    page = room.page()
    page.update(room.now[0])
    for key in ("1", "Enter", ".", "0", "1", "Enter", "Enter", "Enter"):
        page.handle_key(key)
    page.on_close()
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.update()
    room.desk.program_loader.wait_until_loaded(LIMIT)
    assert not room.desk.offset_book.is_saving
    assert room.loads == ["part.nc", "part.nc"]
