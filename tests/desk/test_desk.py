"""What an operator may do in which state, and what the control answers when he may not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.desk.desk import CONTROL_SILENT_TITLE, Desk
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadingPhase, LoadingSteps, ProgramLoader
from app.desk.state.desk_control import DeskControl
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import (
    CONFIRM_CANCEL,
    CONTROL_SILENT,
    ONE_HAND_HINT,
    ONE_PALM_PRESSED,
    RESTART_CONTROL,
    RESTORE_IN_PROGRESS,
)
from app.desk.status.state_prompt import find_remaining_time_s, make_page_prompt
from core.executor.commands import CycleStart, EnableDrives, FeedHold, Reset, SetFeedOverride, SetSwitch
from core.executor.snapshot import Alarm, LogEvent, MachineState
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.texts import fragment, shows, text


@pytest.fixture
def machine() -> FakeMachine:
    return FakeMachine()


@pytest.fixture
def desk(machine: FakeMachine) -> Iterator[Desk]:
    desk = desk_on(machine)
    yield desk
    desk.close()


def at(machine: FakeMachine, state: MachineState) -> None:
    """Put the machine into a state, whatever was before."""
    machine.now = replace(machine.now, state=state)


@pytest.mark.parametrize("name", ["single_block", "optional_stop", "cycle_repeat"])
def test_switch_toggles_on_and_off(desk: Desk, machine: FakeMachine, name: str) -> None:
    desk.toggle_switch(name)
    desk.toggle_switch(name)
    assert machine.posted == [SetSwitch(name, True), SetSwitch(name, False)]


def test_unknown_switch_raises_an_error(desk: Desk) -> None:
    with pytest.raises(ValueError, match="block_delete"):
        desk.toggle_switch("block_delete")


@pytest.mark.parametrize(
    "state",
    [MachineState.RUN, MachineState.HOLD, MachineState.WAIT, MachineState.PROGRAM_STOP, MachineState.JOG],
)
def test_program_is_not_loaded_while_another_one_is_active(
    desk: Desk, machine: FakeMachine, state: MachineState
) -> None:
    at(machine, state)
    assert desk.program_choice.can_choose_program() is False
    by_hand = state is MachineState.JOG
    assert shows(
        desk.prompt_notice, "screen.axes-move-no-program" if by_hand else "screen.program-runs-no-other"
    )


def test_an_unknown_program_is_not_loaded(desk: Desk) -> None:
    assert desk.program_choice.load_by_name("nosuch") is False
    assert desk.program_loader.loaded_program.phase is LoadingPhase.EMPTY


def test_block_delete_needs_a_loaded_program_at_rest(desk: Desk, machine: FakeMachine) -> None:
    desk.program_choice.toggle_block_delete()
    assert shows(desk.prompt_notice, "screen.choose-program-for-block-delete")
    assert desk.program_choice.load_by_name("grooves")
    at(machine, MachineState.HOLD)
    desk.program_choice.toggle_block_delete()
    assert shows(desk.prompt_notice, "desk.block-delete-between-cycles")
    assert desk.program_loader.loaded_program.is_block_delete_on is False
    at(machine, MachineState.IDLE)
    desk.program_choice.toggle_block_delete()
    assert desk.program_loader.loaded_program.is_block_delete_on is True


@pytest.mark.parametrize("state", list(MachineState))
def test_feed_hold_is_posted_in_every_state(desk: Desk, machine: FakeMachine, state: MachineState) -> None:
    at(machine, state)
    desk.start_feed_hold()
    assert FeedHold() in machine.posted


@pytest.mark.parametrize("state", [MachineState.RUN, MachineState.WAIT, MachineState.STOPPING])
def test_reset_of_a_moving_machine_is_refused(desk: Desk, machine: FakeMachine, state: MachineState) -> None:
    at(machine, state)
    desk.reset_control()
    assert Reset() not in machine.posted
    assert shows(desk.prompt_notice, "screen.feed-hold-first")


def test_confirmation_after_a_state_change_is_ignored(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.HOLD)
    desk.reset_control()
    desk.prompt_line._since = float("-inf")
    at(machine, MachineState.RUN)  # the palms at the machine were quicker
    desk.confirm_question_if_unchanged()
    assert machine.posted == []


def test_reset_in_feed_hold_needs_one_confirmation(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.HOLD)
    desk.reset_control()
    assert desk.prompt_notice == CONFIRM_CANCEL
    assert machine.posted == []
    desk.handle_escape()
    desk.reset_control()
    desk.reset_control()
    assert machine.posted == []
    desk.confirm_question_if_unchanged()  # at once: nobody has read it
    assert machine.posted == []
    assert not desk.confirmation_key
    desk.reset_control()
    desk.prompt_line._since = float("-inf")
    desk.confirm_question_if_unchanged()
    assert machine.posted == [Reset()]


def test_another_key_cancels_the_question(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.HOLD)
    desk.reset_control()
    desk.toggle_switch("single_block")
    desk.reset_control()
    assert Reset() not in machine.posted


def test_reset_acknowledges_an_alarm_without_confirmation(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.FAULT)
    desk.reset_control()
    assert machine.posted == [Reset()]


@pytest.mark.parametrize(
    ("state", "answer"),
    [
        (MachineState.ESTOP, fragment("screen.e-stop-pressed")),
        (MachineState.FAULT, text("desk.acknowledge-first")),
        (MachineState.IDLE, text("desk.drives-are-on")),
        (MachineState.RUN, text("desk.drives-are-on")),
    ],
)
def test_drives_on_is_refused_unless_they_are_off(
    desk: Desk, machine: FakeMachine, state: MachineState, answer: str
) -> None:
    at(machine, state)
    desk.enable_drives()
    assert machine.posted == []
    assert answer in desk.prompt_notice


def test_drives_on_is_posted_with_drives_off(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.DISABLED)
    desk.enable_drives()
    assert machine.posted == [EnableDrives()]


def test_escape_posts_feed_hold_for_moving_machine(desk: Desk, machine: FakeMachine) -> None:
    desk.handle_escape()
    assert machine.posted == []
    at(machine, MachineState.RUN)
    desk.handle_escape()
    assert machine.posted == [FeedHold()]


def test_single_palm_press_does_not_start_and_is_reported(desk: Desk, machine: FakeMachine) -> None:
    desk.station_controls.palm("left", is_down=True)
    desk.station_controls.palm("left", is_down=False)
    assert CycleStart() not in machine.posted
    assert desk.prompt_notice == ONE_PALM_PRESSED


def test_single_palm_press_on_simulated_machine_explains_one_hand_start(machine: FakeMachine) -> None:
    """A finger at a touch panel has pressed one, and knew of no other way."""
    desk = desk_on(machine, one_hand=True)
    desk.station_controls.palm("left", is_down=True)
    desk.station_controls.palm("left", is_down=False)
    assert CycleStart() not in machine.posted
    assert desk.prompt_notice == ONE_HAND_HINT


def test_prompt_explains_how_on_screen_palm_buttons_start(machine: FakeMachine) -> None:
    desk = desk_on(machine, one_hand=True)
    assert desk.start_instruction == text("screen.both-palms")
    desk.apply_setting("latched", True)
    assert desk.start_instruction == text("screen.one-palm")
    desk = desk_on(machine, one_hand=False)  # something real moves: the choice counts for nothing
    desk.apply_setting("latched", True)
    assert desk.start_instruction == text("screen.both-palms")


def test_auto_repeat_of_a_pressed_palm_button_is_one_press(desk: Desk, machine: FakeMachine) -> None:
    desk.station_controls.palm("left", is_down=True)
    desk.station_controls.palm("left", is_down=True)
    desk.station_controls.palm("left", is_down=False)
    assert machine.palms == set()


def test_losing_window_focus_releases_the_palm_buttons(desk: Desk, machine: FakeMachine) -> None:
    desk.station_controls.palm("left", is_down=True)
    desk.station_controls.release_all_buttons()
    assert machine.palms == set()
    desk.station_controls.palm("right", is_down=True)
    assert CycleStart() not in machine.posted


def test_refused_start_shows_its_reason_each_time(desk: Desk, machine: FakeMachine) -> None:
    for _ in range(2):
        desk.station_controls.palm("left", is_down=True)
        desk.station_controls.palm("right", is_down=True)
        desk.station_controls.release_all_buttons()
        desk.update()
        assert desk.prompt_notice == text("screen.no-start", why="NO PROVED PROGRAM")
        desk.clear_prompt_line()


def test_refusal_of_the_executor_is_shown(desk: Desk, machine: FakeMachine) -> None:
    desk.hear(LogEvent(1.0, "refused", text("desk.slides-at-rest")))
    desk.hear(LogEvent(1.1, "state", "READY"))
    desk.update()
    assert desk.prompt_notice == text("screen.refused", why=text("desk.slides-at-rest"))


def test_message_remains_after_state_change_and_does_not_hide_the_prompt(
    desk: Desk, machine: FakeMachine
) -> None:
    desk.say("AN ANSWER")
    at(machine, MachineState.DISABLED)
    snapshot, _view, loaded = desk.update()
    assert make_page_prompt(desk, snapshot, loaded) == text("screen.drives-off")
    assert desk.prompt_line.message == "AN ANSWER"


def test_n_key_only_cancels_the_question(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.HOLD)
    desk.reset_control()
    assert desk.confirmation_key == "Y"
    posted = len(machine.posted)
    desk.reject_question()
    assert desk.confirmation_key == ""
    assert len(machine.posted) == posted


def test_override_key_turns_the_pot_of_the_simulated_station(machine: FakeMachine) -> None:
    ticks = iter(range(1000))
    desk = desk_on(machine)
    desk.station_controls.clock = lambda: next(ticks) / 10
    desk.station_keys.step_feed_override(-3)
    for _ in range(10):
        desk.update()
    assert machine.now.feed_override == pytest.approx(0.7)
    assert not any(isinstance(command, SetFeedOverride) for command in machine.posted)
    desk.close()


def test_without_a_station_the_override_is_posted(machine: FakeMachine, tmp_path: Path) -> None:
    desk = Desk(
        DeskControl(machine.post, machine.snapshot),
        ProgramLoader(_no_workshop(), machine.post),
        ProgramFolders((tmp_path,)),
    )
    desk.station_keys.step_feed_override(-20)
    assert machine.posted == [SetFeedOverride(0.0)]
    desk.station_controls.palm("left", is_down=True)
    desk.station_controls.estop(is_pressed=True)
    assert machine.palms == set()
    assert machine.now.state is MachineState.IDLE
    desk.close()


def test_one_button_starts_cycle_only_if_machine_file_allows_it(machine: FakeMachine) -> None:
    two, one = desk_on(machine), desk_on(machine, two_hand=False)
    two.station_keys.press_start()
    assert machine.posted == []
    one.station_keys.press_start()
    assert machine.posted == [CycleStart()]
    for desk in (one, two):
        desk.close()


def test_alarm_log_retains_a_cleared_alarm_and_lists_it_once(desk: Desk, machine: FakeMachine) -> None:
    machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "", "", line=4))
    desk.update()
    machine.now = replace(machine.now, alarms=())
    desk.update()
    assert [(entry.local_time, entry.alarm.number) for entry in desk.alarm_log.entries] == [("09:41:07", 102)]


def test_silent_control_is_reported_and_its_values_are_not_shown_as_valid(
    desk: Desk, machine: FakeMachine
) -> None:
    seconds = [100.0]
    desk.station_controls.clock = lambda: seconds[0]
    at(machine, MachineState.RUN)
    assert desk.update()[1].state_tone is StatusTone.RUN
    machine.alive = False
    for _ in range(20):
        seconds[0] += 0.1
        snapshot, view, loaded = desk.update()
    assert (view.state_text, view.state_tone) == (CONTROL_SILENT_TITLE, StatusTone.ALARM)
    assert make_page_prompt(desk, snapshot, loaded) == CONTROL_SILENT
    machine.alive = True
    assert desk.update()[1].state_tone is StatusTone.RUN


def test_reset_only_restarts_a_silent_control(machine: FakeMachine, desk: Desk) -> None:
    restarts = list[int]()
    desk.desk_control.restart_control = lambda: restarts.append(1)
    seconds = [100.0]
    desk.station_controls.clock = lambda: seconds[0]
    at(machine, MachineState.RUN)
    desk.update()
    desk.reset_control()
    assert restarts == []  # it responds
    machine.alive = False
    desk.update()
    seconds[0] += 1.1
    snapshot, _, loaded = desk.update()
    assert make_page_prompt(desk, snapshot, loaded) == RESTART_CONTROL
    posted = list(machine.posted)
    desk.reset_control()
    assert restarts == [1]
    assert machine.posted == posted


def test_reset_is_posted_if_a_silent_control_cannot_be_restarted(machine: FakeMachine, desk: Desk) -> None:
    seconds = [100.0]
    desk.station_controls.clock = lambda: seconds[0]
    at(machine, MachineState.FAULT)
    desk.update()
    machine.alive = False
    desk.update()
    seconds[0] += 1.1
    snapshot, _, loaded = desk.update()
    assert make_page_prompt(desk, snapshot, loaded) == CONTROL_SILENT
    desk.reset_control()
    assert machine.posted[-1] == Reset()


def test_suspended_screen_does_not_report_a_silent_control(desk: Desk) -> None:
    seconds = [100.0]
    desk.station_controls.clock = lambda: seconds[0]
    desk.update()
    seconds[0] += 60.0
    assert desk.update()[1].state_text == MachineState.IDLE.value


def test_time_left_is_infinite_at_zero_override(desk: Desk, machine: FakeMachine) -> None:
    snapshot, _view, loaded = desk.update()
    assert find_remaining_time_s(snapshot, loaded) == float("inf")


def _no_workshop() -> LoadingSteps:
    def refuse(*_given: object) -> None:
        raise AssertionError("nothing is loaded here")

    return LoadingSteps(refuse, refuse, refuse, refuse)  # type: ignore[arg-type]


def test_store_failure_during_a_run_is_reported_once(desk: Desk, machine: FakeMachine) -> None:
    trouble = ""
    desk.storage_state.set_store_readers(lambda: trouble)
    at(machine, MachineState.HOLD)
    desk.update()
    assert not shows(desk.prompt_notice, "screen.not-kept")
    trouble = "turndesk.db: the disk is full"
    desk.update()
    assert desk.prompt_notice == text("screen.not-kept", why="turndesk.db: the disk is full")
    desk.clear_prompt_line()
    desk.update()
    assert desk.prompt_notice == ""


class _PageReady:
    """A page such as MDI or SEARCHTO, with something that the palms would start."""

    is_open = True

    def barred(self) -> str:
        return ""

    def close(self) -> None:
        """Nothing is open."""


def test_starts_are_barred_on_all_pages_while_a_backup_is_restored(desk: Desk, machine: FakeMachine) -> None:
    at(machine, MachineState.IDLE)
    desk.page_registry.add_start_handler(_PageReady())
    assert desk.barred() == ""
    desk.storage_state.begin_restore()
    assert desk.barred() == RESTORE_IN_PROGRESS


class _Model:
    closed = 0

    def close(self) -> None:
        """With the desk."""
        self.closed += 1


class _Other(_Model):
    pass


def test_lazily_attached_model_is_created_once_on_first_use(desk: Desk) -> None:
    made: list[_Model] = []

    def make() -> _Model:
        made.append(_Model())
        return made[-1]

    desk.page_registry.attach_lazy_model(f"{__name__}._Model", make)
    assert (desk.page_registry.find_model(_Other), made) == (None, [])
    assert desk.page_registry.find_model(_Model) is desk.page_registry.find_model(_Model) is made[0]
    desk.close()
    assert (len(made), made[0].closed) == (1, 1)


def test_closing_does_not_create_an_unused_lazy_model(desk: Desk) -> None:
    def make() -> _Model:
        raise AssertionError("made although nobody asked")

    desk.page_registry.attach_lazy_model(f"{__name__}._Model", make)
    desk.close()
