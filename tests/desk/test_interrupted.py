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


def test_line_tool_part_time_and_cause_stand_in_one_row() -> None:
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


def test_yesterdays_job_has_its_date() -> None:
    assert format_wall_time("2026-05-04T09:30:00Z").startswith("2026-05-0")
    assert format_wall_time("half past nine") == "half past nine"


def test_where_it_stood_and_where_it_stands_now() -> None:
    assert figures(STOOD) == text("desk.stands-at", stood="X R0.37500 Z −2.30000")
    moved = replace(STOOD, actual=(25.4, -58.42, 0.0))
    assert figures(moved) == text(
        "desk.stood-and-stands-at", stood="X R0.37500 Z −2.30000", now="X R1.00000 Z −2.30000"
    )
    dia = replace(STOOD, modal=STOOD.modal._replace(diameter=True))
    assert figures(dia) == text("desk.stands-at", stood="X Ø0.75000 Z −2.30000")
    assert figures(STOOD, DisplayUnits.METRIC) == text("desk.stands-at", stood="X R9.5250 Z −58.4200")


def test_after_a_power_cut_it_says_what_nobody_knows() -> None:
    cut = replace(STOOD, interrupted=broken_off(why=POWER_LOST_REASON))
    assert figures(cut).startswith(
        text("desk.stands-at", stood="X R0.37500 Z −2.30000") + text("desk.not-certain")
    )
    assert not shows(figures(STOOD), "desk.not-certain")  # an E-stop is noted where the tool has come to rest


def test_without_a_home_nobody_knows_where_it_stands() -> None:
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
def test_where_the_next_start_begins_something_else_it_is_not_asked_for(other: Snapshot) -> None:
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


def test_where_searchto_does_not_read_the_language_it_is_not_offered() -> None:
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
    desk.prompt_answers._since -= 1.0


def posted(desk: Desk) -> list[object]:
    assert isinstance(desk.desk_control.station_panel, FakeMachine)
    return list(desk.desk_control.station_panel.posted)


def test_y_answers_for_the_job_that_is_shown(desk: Desk) -> None:
    desk.confirm_question()
    assert posted(desk) == [ConfirmStart(broken_off().at)]
    desk.close()


def test_y_means_nothing_where_no_cycle_is_started(desk: Desk) -> None:
    desk.window_state.set_page(can_start=False)
    desk.confirm_question()
    assert posted(desk) == []
    assert begins(desk.prompt_notice, "desk.y-on-automatic")
    desk.close()


def test_another_program_is_asked_for_and_loaded_by_y_alone(desk: Desk) -> None:
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


def test_another_key_takes_the_question_back(desk: Desk) -> None:
    assert desk.program_choice.load_by_name("OTHER.NC")
    assert desk.handle_escape()
    desk.confirm_question()
    assert desk.program_loader.loaded.name == "PIN.NC"
    assert posted(desk) == [ConfirmStart(broken_off().at)]
    desk.close()


def test_an_answer_covers_no_question(desk: Desk) -> None:
    assert desk.program_choice.load_by_name("OTHER.NC")
    has_been_read(desk)
    desk.say("NOT KEPT: the disk is full")
    assert (desk.prompt_answers.message, bool(desk.prompt_answers.question)) == (
        "NOT KEPT: the disk is full",
        True,
    )
    desk.confirm_question()
    assert desk.program_loader.wait_until_loaded(20).name == "OTHER.NC"
    desk.close()


@pytest.mark.parametrize("question", ["rename", "delete"])
def test_the_interrupted_program_keeps_its_name_and_its_file(
    desk: Desk, question: str, tmp_path: Path
) -> None:
    files = desk.page_registry.find_model(ProgramListModel)
    assert files is not None
    files.on_open()
    files.worker.wait_for_results(60.0)
    files.poll()
    files.select_row([program.name for program in files.listed_programs].index("PIN.NC"))
    if question == "rename":
        files.program_commands.ask_name(RENAME)
    else:
        files.program_commands.confirm_delete()
    assert desk.prompt_notice == text("desk.finish-interrupted", name="PIN.NC")
    assert files.program_commands.question == ""
    assert (tmp_path / "PIN.NC").exists()
    desk.close()


def test_the_same_program_is_read_again_without_a_question(desk: Desk) -> None:
    loads = desk.program_loader.load_count
    assert desk.program_choice.load_by_name("PIN.NC")
    assert desk.program_loader.load_count == loads + 1
    desk.close()


def test_at_the_start_the_interrupted_program_goes_before_the_one_of_the_command_line(desk: Desk) -> None:
    load_first_program(desk, "OTHER.NC")
    assert desk.program_loader.wait_until_loaded(20).name == "PIN.NC"
    assert desk.prompt_notice == text("desk.not-loaded-interrupted", name="OTHER.NC")
    desk.close()


def test_at_the_start_an_interrupted_program_that_is_not_there_is_told(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "PIN.NC").unlink()
    load_first_program(desk, None)
    assert desk.prompt_notice == text("desk.interrupted-not-in-folder", name="PIN.NC")
    desk.close()


def test_closing_with_something_unwritten_says_so_and_means_it_only_later(desk: Desk) -> None:
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
