"""The interrupted job on the screen: words and figures, the answer with Y, and what it asks beforehand."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest

from app.desk.desk import Desk
from app.desk.programs.first_program import load_first_program
from app.desk.programs.program_loading import LoadedProgram
from app.desk.screen_settings import DisplayUnits
from app.desk.status import interrupted_notice
from app.desk.status.formats import format_wall_time
from app.programs.program_commands import RENAME
from app.programs.program_list_model import ProgramListModel
from core.executor.commands import ConfirmStart, LoadJob
from core.executor.snapshot import POWER_LOST_REASON, MachineState, Snapshot, StartAction
from core.language.source import Dialect, ProgramSource
from tests.interrupted import broken_off
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.texts import begins, shows, text

STOOD = Snapshot(
    state=MachineState.IDLE,
    program="PIN.NC",
    interrupted=broken_off(),
    actual=(9.525, -58.42, 0.0),
    homed=(True, True, True),
)


def figures(snapshot: Snapshot, units: DisplayUnits = DisplayUnits.PROGRAM) -> str:
    found = interrupted_notice.make_interrupted_notice(snapshot, LoadedProgram(), units)
    assert found is not None
    return found.values_text


def test_interrupted_row_shows_line_tool_part_time_and_cause() -> None:
    now = datetime.now().astimezone().replace(hour=12, minute=30).isoformat()  # today, where the desk stands
    found = interrupted_notice.make_interrupted_notice(
        replace(STOOD, interrupted=broken_off(at=now)), LoadedProgram(), DisplayUnits.PROGRAM
    )
    assert found is not None
    at = datetime.fromisoformat(now).astimezone().strftime("%H:%M")
    assert found.text == text(
        "desk.interrupted",
        program="PIN.NC",
        line=8,
        passed="",
        tool=3,
        part=5,
        at=at,
        why="E-STOP",
        changed="",
    )


def test_interruption_on_another_day_is_shown_with_its_date() -> None:
    assert format_wall_time("2026-05-04T09:30:00Z").startswith("2026-05-0")
    assert format_wall_time("half past nine") == "half past nine"


def test_interrupted_and_present_positions_are_shown() -> None:
    assert figures(STOOD) == text("desk.stands-at", stood="X R0.37500 Z −2.30000")
    moved = replace(STOOD, actual=(25.4, -58.42, 0.0))
    assert figures(moved) == text(
        "desk.stood-and-stands-at", stood="X R0.37500 Z −2.30000", now="X R1.00000 Z −2.30000"
    )
    dia = replace(STOOD, modal=STOOD.modal._replace(diameter=True))
    assert figures(dia) == text("desk.stands-at", stood="X Ø0.75000 Z −2.30000")
    assert figures(STOOD, DisplayUnits.METRIC) == text("desk.stands-at", stood="X R9.5250 Z −58.4200")


def test_position_is_marked_as_uncertain_after_a_power_failure() -> None:
    cut = replace(STOOD, interrupted=broken_off(why=POWER_LOST_REASON))
    assert figures(cut).startswith(
        text("desk.stands-at", stood="X R0.37500 Z −2.30000") + text("desk.not-certain")
    )
    assert not shows(figures(STOOD), "desk.not-certain")  # an E-stop is noted where the tool has come to rest


def test_unhomed_axis_has_a_lost_interrupted_position() -> None:
    lost = replace(STOOD, homed=(True, False, True), actual=(9.525, 0.0, 0.0))
    assert figures(lost) == (text("desk.stood-position-lost", stood="X R0.37500 Z −2.30000"))


@pytest.mark.parametrize(
    "other",
    [
        replace(STOOD, interrupted=None),
        replace(STOOD, program="OTHER.NC"),
        replace(STOOD, state=MachineState.DISABLED),
        replace(STOOD, starts=StartAction.MDI_LINE),
    ],
)
def test_interrupted_prompt_appears_only_if_next_start_runs_that_job(other: Snapshot) -> None:
    assert begins(
        interrupted_notice.make_interrupted_prompt(STOOD, LoadedProgram(), "PRESS"),
        "desk.was-interrupted",
        line=8,
    )
    assert begins(
        interrupted_notice.make_interrupted_prompt(replace(STOOD, confirmed=True), LoadedProgram(), "PRESS"),
        "desk.begins-at-line-1",
    )
    assert interrupted_notice.make_interrupted_prompt(other, LoadedProgram(), "PRESS") == ""


def test_searchto_is_not_offered_for_a_language_it_does_not_support() -> None:
    loaded = LoadedProgram(source=ProgramSource("PIN.NC", "G0 X10\n", Dialect.SINUMERIK))
    assert interrupted_notice.make_interrupted_prompt(STOOD, loaded, "PRESS") == (
        text("desk.was-interrupted-jog-clear", line=8)
    )


# --- the desk -----------------------------------------------------------------------------------------------


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    """PIN.NC is interrupted; OTHER.NC lies beside it."""
    for name in ("PIN.NC", "OTHER.NC"):
        (tmp_path / name).write_text("G90G94F300\nT1\nX2Z2\nM30\n")
    machine = FakeMachine()
    desk = desk_on(machine, tmp_path)
    assert desk.program_choice.load_by_name("PIN.NC")
    desk.program_loader.wait_until_loaded(20)
    now = machine.snapshot()
    machine.posted.clear()
    desk.desk_control.read_snapshot = lambda: replace(
        now, interrupted=broken_off(), state=MachineState.IDLE, program="PIN.NC"
    )
    return desk


def has_been_read(desk: Desk) -> None:
    """A question stands for a second."""
    desk.prompt_line._since -= 1.0


def posted(desk: Desk) -> list[object]:
    assert isinstance(desk.desk_control.station_panel, FakeMachine)
    return list(desk.desk_control.station_panel.posted)


def test_y_key_confirms_the_interrupted_job_shown(desk: Desk) -> None:
    desk.confirm_question()
    assert posted(desk) == [ConfirmStart(broken_off().at)]
    desk.close()


def test_y_key_is_rejected_on_a_page_without_cycle_start(desk: Desk) -> None:
    desk.window_state.set_page_properties(can_start=False)
    desk.confirm_question()
    assert posted(desk) == []
    assert begins(desk.prompt_notice, "desk.y-on-automatic")
    desk.close()


def test_loading_another_program_than_the_interrupted_needs_y(desk: Desk) -> None:
    loads = desk.program_loader.load_count
    assert desk.program_choice.load_by_name("OTHER.NC")
    assert desk.program_loader.load_count == loads
    assert desk.prompt_notice == text("desk.gives-job-up", tool=3, program="PIN.NC", line=8, name="OTHER.NC")
    assert desk.program_choice.load_by_name("OTHER.NC")  # the same again is no answer
    assert desk.program_loader.load_count == loads
    has_been_read(desk)
    desk.confirm_question()
    assert desk.program_loader.load_count == loads + 1
    assert desk.program_loader.wait_until_loaded(20).name == "OTHER.NC"
    assert [each for each in posted(desk) if isinstance(each, LoadJob)]
    desk.close()


def test_escape_cancels_the_question(desk: Desk) -> None:
    assert desk.program_choice.load_by_name("OTHER.NC")
    assert desk.handle_escape()
    desk.confirm_question()
    assert desk.program_loader.loaded_program.name == "PIN.NC"
    assert posted(desk) == [ConfirmStart(broken_off().at)]
    desk.close()


def test_message_does_not_replace_an_open_question(desk: Desk) -> None:
    assert desk.program_choice.load_by_name("OTHER.NC")
    has_been_read(desk)
    desk.say("NOT KEPT: the disk is full")
    assert (desk.prompt_line.message, bool(desk.prompt_line.question_text)) == (
        "NOT KEPT: the disk is full",
        True,
    )
    desk.confirm_question()
    assert desk.program_loader.wait_until_loaded(20).name == "OTHER.NC"
    desk.close()


@pytest.mark.parametrize("question", ["rename", "delete"])
def test_interrupted_program_cannot_be_renamed_or_deleted(desk: Desk, question: str, tmp_path: Path) -> None:
    files = desk.page_registry.find_model(ProgramListModel)
    assert files is not None
    files.on_open()
    files.worker.wait_for_results(60.0)
    files.poll()
    files.select_row([program.name for program in files.listed_programs].index("PIN.NC"))
    if question == "rename":
        files.program_commands.ask_for_name(RENAME)
    else:
        files.program_commands.confirm_delete()
    assert desk.prompt_notice == text("desk.finish-interrupted", name="PIN.NC")
    assert files.program_commands.question == ""
    assert (tmp_path / "PIN.NC").exists()
    desk.close()


def test_interrupted_program_is_reloaded_without_a_question(desk: Desk) -> None:
    loads = desk.program_loader.load_count
    assert desk.program_choice.load_by_name("PIN.NC")
    assert desk.program_loader.load_count == loads + 1
    desk.close()


def test_interrupted_program_is_loaded_instead_of_the_command_line_program(desk: Desk) -> None:
    load_first_program(desk, "OTHER.NC")
    assert desk.program_loader.wait_until_loaded(20).name == "PIN.NC"
    assert desk.prompt_notice == text("desk.not-loaded-interrupted", name="OTHER.NC")
    desk.close()


def test_missing_interrupted_program_is_reported_at_startup(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "PIN.NC").unlink()
    load_first_program(desk, None)
    assert desk.prompt_notice == text("desk.interrupted-not-in-folder", name="PIN.NC")
    desk.close()


def test_closing_with_unsaved_data_warns_first_and_closes_on_repeat(desk: Desk) -> None:
    closed: list[bool] = []
    assert desk.can_close(lambda: closed.append(True))
    desk.storage_state.set_store_readers(read_unsaved=lambda: "20 parts, 61 events")
    for _ in range(3):  # a key that repeats
        assert not desk.can_close(lambda: closed.append(True))
        assert "20 parts, 61 events" in desk.prompt_notice
    desk.confirm_question()
    assert closed == []  # nobody has read it yet
    assert not desk.can_close(lambda: closed.append(True))
    has_been_read(desk)
    desk.confirm_question()
    assert closed == [True]
    desk.close()
