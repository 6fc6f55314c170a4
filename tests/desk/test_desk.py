"""What an operator may do in which state, and what the control answers when he may not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.desk.desk import SILENT, Desk
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadingSteps, Phase, ProgramLoader
from app.desk.state.desk_control import DeskControl
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import (
    CONTROL_SILENT,
    GIVE_UP,
    ONE_HAND,
    ONE_PALM,
    RESTART_CONTROL,
    RESTORING,
)
from app.desk.status.standing_prompt import prompt, time_left
from core.executor.commands import CycleStart, EnableDrives, FeedHold, FeedOverride, Reset, SetSwitch
from core.executor.snapshot import Alarm, Event, State
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


def at(machine: FakeMachine, state: State) -> None:
    """Put the machine into a state, whatever was before."""
    machine.now = replace(machine.now, state=state)


@pytest.mark.parametrize("name", ["single_block", "optional_stop", "cycle_repeat"])
def test_switches_turn_over(desk: Desk, machine: FakeMachine, name: str) -> None:
    desk.switch(name)
    desk.switch(name)
    assert machine.posted == [SetSwitch(name, True), SetSwitch(name, False)]


def test_an_unknown_switch_is_a_mistake(desk: Desk) -> None:
    with pytest.raises(ValueError, match="block_delete"):
        desk.switch("block_delete")


@pytest.mark.parametrize("state", [State.RUN, State.HOLD, State.WAIT, State.PROGRAM_STOP, State.JOG])
def test_no_other_program_while_one_is_under_way(desk: Desk, machine: FakeMachine, state: State) -> None:
    at(machine, state)
    assert desk.programs.can_choose() is False
    by_hand = state is State.JOG
    assert shows(desk.notice, "screen.axes-move-no-program" if by_hand else "screen.program-runs-no-other")


def test_an_unknown_program_is_not_loaded(desk: Desk) -> None:
    assert desk.programs.choose("nosuch") is False
    assert desk.session.now.phase is Phase.EMPTY


def test_block_delete_needs_a_program_and_rest(desk: Desk, machine: FakeMachine) -> None:
    desk.programs.switch_block_delete()
    assert shows(desk.notice, "screen.choose-program-for-block-delete")
    assert desk.programs.choose("grooves")
    at(machine, State.HOLD)
    desk.programs.switch_block_delete()
    assert shows(desk.notice, "desk.block-delete-between-cycles")
    assert desk.session.now.block_delete is False
    at(machine, State.IDLE)
    desk.programs.switch_block_delete()
    assert desk.session.now.block_delete is True


@pytest.mark.parametrize("state", list(State))
def test_feed_hold_is_always_posted(desk: Desk, machine: FakeMachine, state: State) -> None:
    at(machine, state)
    desk.feed_hold()
    assert FeedHold() in machine.posted


@pytest.mark.parametrize("state", [State.RUN, State.WAIT, State.HOLDING])
def test_reset_of_a_moving_machine_is_refused(desk: Desk, machine: FakeMachine, state: State) -> None:
    at(machine, state)
    desk.reset()
    assert Reset() not in machine.posted
    assert shows(desk.notice, "screen.feed-hold-first")


def test_an_answer_to_a_question_of_another_state_is_none(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.HOLD)
    desk.reset()
    desk.answers._since = float("-inf")
    at(machine, State.RUN)  # the palms at the machine were quicker
    desk.answer()
    assert machine.posted == []


def test_giving_a_program_up_is_asked_once(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.HOLD)
    desk.reset()
    assert desk.notice == GIVE_UP
    assert machine.posted == []
    desk.escape()
    desk.reset()
    desk.reset()
    assert machine.posted == []
    desk.answer()  # at once: nobody has read it
    assert machine.posted == []
    assert not desk.asked
    desk.reset()
    desk.answers._since = float("-inf")
    desk.answer()
    assert machine.posted == [Reset()]


def test_another_key_takes_the_question_back(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.HOLD)
    desk.reset()
    desk.switch("single_block")
    desk.reset()
    assert Reset() not in machine.posted


def test_an_alarm_is_acknowledged_at_once(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.FAULT)
    desk.reset()
    assert machine.posted == [Reset()]


@pytest.mark.parametrize(
    ("state", "answer"),
    [
        (State.ESTOP, fragment("screen.e-stop-pressed")),
        (State.FAULT, text("desk.acknowledge-first")),
        (State.IDLE, text("desk.drives-are-on")),
        (State.RUN, text("desk.drives-are-on")),
    ],
)
def test_drives_on_is_refused_unless_they_are_off(
    desk: Desk, machine: FakeMachine, state: State, answer: str
) -> None:
    at(machine, state)
    desk.enable()
    assert machine.posted == []
    assert answer in desk.notice


def test_drives_on(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.DISABLED)
    desk.enable()
    assert machine.posted == [EnableDrives()]


def test_escape_holds_what_moves(desk: Desk, machine: FakeMachine) -> None:
    desk.escape()
    assert machine.posted == []
    at(machine, State.RUN)
    desk.escape()
    assert machine.posted == [FeedHold()]


def test_one_palm_does_not_start_and_is_told(desk: Desk, machine: FakeMachine) -> None:
    desk.hands.palm("left", down=True)
    desk.hands.palm("left", down=False)
    assert CycleStart() not in machine.posted
    assert desk.notice == ONE_PALM


def test_one_palm_of_a_simulated_machine_says_how_one_hand_starts(machine: FakeMachine) -> None:
    """A finger at a touch panel has pressed one, and knew of no other way."""
    desk = desk_on(machine, one_hand=True)
    desk.hands.palm("left", down=True)
    desk.hands.palm("left", down=False)
    assert CycleStart() not in machine.posted
    assert desk.notice == ONE_HAND


def test_the_prompt_says_how_the_palms_on_the_glass_start(machine: FakeMachine) -> None:
    desk = desk_on(machine, one_hand=True)
    assert desk.start_words == text("screen.both-palms")
    desk.choose_setting("latched", True)
    assert desk.start_words == text("screen.one-palm")
    desk = desk_on(machine, one_hand=False)  # something real moves: the choice counts for nothing
    desk.choose_setting("latched", True)
    assert desk.start_words == text("screen.both-palms")


def test_a_held_palm_that_repeats_is_pressed_once(desk: Desk, machine: FakeMachine) -> None:
    desk.hands.palm("left", down=True)
    desk.hands.palm("left", down=True)
    desk.hands.palm("left", down=False)
    assert machine.palms == set()


def test_losing_the_window_lets_the_palms_go(desk: Desk, machine: FakeMachine) -> None:
    desk.hands.palm("left", down=True)
    desk.hands.let_go()
    assert machine.palms == set()
    desk.hands.palm("right", down=True)
    assert CycleStart() not in machine.posted


def test_a_refused_start_says_why_each_time(desk: Desk, machine: FakeMachine) -> None:
    for _ in range(2):
        desk.hands.palm("left", down=True)
        desk.hands.palm("right", down=True)
        desk.hands.let_go()
        desk.look()
        assert desk.notice == text("screen.no-start", why="NO PROVED PROGRAM")
        desk.clear()


def test_what_the_executor_refuses_is_said(desk: Desk, machine: FakeMachine) -> None:
    desk.hear(Event(1.0, "refused", text("desk.slides-at-rest")))
    desk.hear(Event(1.1, "state", "READY"))
    desk.look()
    assert desk.notice == text("screen.refused", why=text("desk.slides-at-rest"))


def test_an_answer_outlives_the_state_and_never_covers_it(desk: Desk, machine: FakeMachine) -> None:
    desk.say("AN ANSWER")
    at(machine, State.DISABLED)
    snapshot, _view, loaded = desk.look()
    assert prompt(desk, snapshot, loaded) == text("screen.drives-off")
    assert desk.answers.answer == "AN ANSWER"


def test_n_takes_a_question_back_and_does_nothing_else(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.HOLD)
    desk.reset()
    assert desk.asked == "Y"
    posted = len(machine.posted)
    desk.no()
    assert desk.asked == ""
    assert len(machine.posted) == posted


def test_the_override_key_turns_the_stations_pot(machine: FakeMachine) -> None:
    ticks = iter(range(1000))
    desk = desk_on(machine)
    desk.hands.clock = lambda: next(ticks) / 10
    desk.station.step_override(-3)
    for _ in range(10):
        desk.look()
    assert machine.now.feed_override == pytest.approx(0.7)
    assert not any(isinstance(command, FeedOverride) for command in machine.posted)
    desk.close()


def test_without_a_station_the_override_is_posted(machine: FakeMachine, tmp_path: Path) -> None:
    desk = Desk(
        DeskControl(machine.post, machine.snapshot),
        ProgramLoader(_no_workshop(), machine.post),
        ProgramFolders((tmp_path,)),
    )
    desk.station.step_override(-20)
    assert machine.posted == [FeedOverride(0.0)]
    desk.hands.palm("left", down=True)
    desk.hands.estop(pressed=True)
    assert machine.palms == set()
    assert machine.now.state is State.IDLE
    desk.close()


def test_one_button_starts_only_where_the_machine_file_says_one(machine: FakeMachine) -> None:
    two, one = desk_on(machine), desk_on(machine, two_hand=False)
    two.station.press_start()
    assert machine.posted == []
    one.station.press_start()
    assert machine.posted == [CycleStart()]
    for desk in (one, two):
        desk.close()


def test_the_log_keeps_an_alarm_that_is_over_and_counts_it_once(desk: Desk, machine: FakeMachine) -> None:
    machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "", "", line=4))
    desk.look()
    machine.now = replace(machine.now, alarms=())
    desk.look()
    assert [(entry.at, entry.alarm.number) for entry in desk.log.entries] == [("09:41:07", 102)]


def test_a_control_that_has_died_is_told_and_its_figures_are_not_believed(
    desk: Desk, machine: FakeMachine
) -> None:
    seconds = [100.0]
    desk.hands.clock = lambda: seconds[0]
    at(machine, State.RUN)
    assert desk.look()[1].tone is Tone.RUN
    machine.alive = False
    for _ in range(20):
        seconds[0] += 0.1
        snapshot, view, loaded = desk.look()
    assert (view.state, view.tone) == (SILENT, Tone.ALARM)
    assert prompt(desk, snapshot, loaded) == CONTROL_SILENT
    machine.alive = True
    assert desk.look()[1].tone is Tone.RUN


def test_reset_restarts_a_silent_control_and_nothing_else(machine: FakeMachine, desk: Desk) -> None:
    restarts = list[int]()
    desk.control.restart = lambda: restarts.append(1)
    seconds = [100.0]
    desk.hands.clock = lambda: seconds[0]
    at(machine, State.RUN)
    desk.look()
    desk.reset()
    assert restarts == []  # it responds
    machine.alive = False
    desk.look()
    seconds[0] += 1.1
    snapshot, _, loaded = desk.look()
    assert prompt(desk, snapshot, loaded) == RESTART_CONTROL
    posted = list(machine.posted)
    desk.reset()
    assert restarts == [1]
    assert machine.posted == posted


def test_reset_of_a_silent_control_that_cannot_be_restarted_is_the_usual_one(
    machine: FakeMachine, desk: Desk
) -> None:
    seconds = [100.0]
    desk.hands.clock = lambda: seconds[0]
    at(machine, State.FAULT)
    desk.look()
    machine.alive = False
    desk.look()
    seconds[0] += 1.1
    snapshot, _, loaded = desk.look()
    assert prompt(desk, snapshot, loaded) == CONTROL_SILENT
    desk.reset()
    assert machine.posted[-1] == Reset()


def test_a_screen_that_was_away_does_not_blame_the_control(desk: Desk) -> None:
    seconds = [100.0]
    desk.hands.clock = lambda: seconds[0]
    desk.look()
    seconds[0] += 60.0
    assert desk.look()[1].state == State.IDLE.value


def test_time_left_stands_still_at_override_zero(desk: Desk, machine: FakeMachine) -> None:
    snapshot, _view, loaded = desk.look()
    assert time_left(snapshot, loaded) == float("inf")


def _no_workshop() -> LoadingSteps:
    def refuse(*_given: object) -> None:
        raise AssertionError("nothing is loaded here")

    return LoadingSteps(refuse, refuse, refuse, refuse)  # type: ignore[arg-type]


def test_a_store_that_fails_in_the_middle_of_a_run_is_told_once(desk: Desk, machine: FakeMachine) -> None:
    trouble = ""
    desk.storage.follow_store(lambda: trouble)
    at(machine, State.HOLD)
    desk.look()
    assert not shows(desk.notice, "screen.not-kept")
    trouble = "turndesk.db: the disk is full"
    desk.look()
    assert desk.notice == text("screen.not-kept", why="turndesk.db: the disk is full")
    desk.clear()
    desk.look()
    assert desk.notice == ""


class _PageReady:
    """A page such as MDI or SEARCHTO, with something that the palms would start."""

    open = True

    def barred(self) -> str:
        return ""

    def close(self) -> None:
        """Nothing is open."""


def test_nothing_starts_from_any_page_while_a_backup_is_restored(desk: Desk, machine: FakeMachine) -> None:
    at(machine, State.IDLE)
    desk.pages.add_start(_PageReady())
    assert desk.barred() == ""
    desk.storage.begin_restore()
    assert desk.barred() == RESTORING


class _Model:
    closed = 0

    def close(self) -> None:
        """With the desk."""
        self.closed += 1


class _Other(_Model):
    pass


def test_what_is_attached_for_later_is_made_once_when_it_is_asked_for(desk: Desk) -> None:
    made: list[_Model] = []

    def make() -> _Model:
        made.append(_Model())
        return made[-1]

    desk.pages.attach_later(f"{__name__}._Model", make)
    assert (desk.pages.find(_Other), made) == (None, [])
    assert desk.pages.find(_Model) is desk.pages.find(_Model) is made[0]
    desk.close()
    assert (len(made), made[0].closed) == (1, 1)


def test_what_nobody_asked_for_is_not_made_by_closing(desk: Desk) -> None:
    def make() -> _Model:
        raise AssertionError("made although nobody asked")

    desk.pages.attach_later(f"{__name__}._Model", make)
    desk.close()
