"""Presses that waited behind a stall: what starts something is dropped and named, everything else is done."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

import pytest

from app.desk.late_presses import (
    HARMLESS_COMMANDS,
    REPORT_INTERVAL_S,
    STARTING_COMMANDS,
    BlockedLateAction,
    LatePressFilter,
    find_starting_action,
    get_starting_action_name,
)
from app.desk.posted_values import ARRIVAL_TIMEOUT_S, PostedValues
from app.desk.station_controls import StationControls, StationPanel
from core.executor import commands
from core.executor.commands import MOTION_COMMAND_TYPES as STARTS_OF_CONTROL
from core.executor.commands import Command
from core.executor.hand_motion.drive_test import DriveTestMotion
from core.executor.snapshot import MachineState, Snapshot


def every_command() -> set[type[Command]]:
    named = vars(commands).values()
    return {each for each in named if isinstance(each, type) and issubclass(each, Command)} - {Command}


def test_every_command_is_classified_as_starting_or_harmless() -> None:
    assert STARTING_COMMANDS.keys() | HARMLESS_COMMANDS == every_command()
    assert not STARTING_COMMANDS.keys() & HARMLESS_COMMANDS
    assert set(STARTS_OF_CONTROL) <= STARTING_COMMANDS.keys()


def test_every_starting_action_has_a_unique_name() -> None:
    assert len({get_starting_action_name(each) for each in BlockedLateAction}) == len(BlockedLateAction)


@dataclass
class Bench:
    """Late presses with a clock that is moved by hand; ``posted`` came through."""

    now: float = 100.0
    shown: Snapshot = field(default_factory=lambda: Snapshot(state=MachineState.IDLE))
    posted: list[Command] = field(default_factory=list)
    told: list[tuple[str, ...]] = field(default_factory=list)
    answers: int = 0
    late: LatePressFilter = field(init=False)

    def __post_init__(self) -> None:
        def answered() -> None:
            self.answers += 1

        self.late = LatePressFilter(lambda: self.shown, lambda: self.now, self.told.append, answered)

    def post(self, command: Command) -> None:
        self.late.guard_post_command(self.posted.append)(command)


STARTING = (
    (commands.CycleStart(), BlockedLateAction.CYCLE),
    (commands.EnableDrives(), BlockedLateAction.DRIVES),
    (commands.Jog("X", 1.0, 0.2), BlockedLateAction.JOG),
    (commands.JogByStep("X", 1.0, 1.0), BlockedLateAction.JOG),
    (commands.TouchOffTool("X", 1, 0.2, 1), BlockedLateAction.TOUCH_OFF),
    (commands.SelectHandwheel("X", 0.1, 0.2), BlockedLateAction.HANDWHEEL),
    (commands.RunDriveTest(cast("DriveTestMotion", None), 0.2), BlockedLateAction.DRIVE_TEST),
    (commands.HomeAxes("X"), BlockedLateAction.HOME),
    (commands.ForceOutput("collet", True), BlockedLateAction.OUTPUT),
    (commands.ForceOutput("collet", False), BlockedLateAction.OUTPUT),
    (commands.ForceOutput("coolant", True), BlockedLateAction.OUTPUT),
    (commands.ConfirmStart("yesterday"), BlockedLateAction.START_AT_LINE_1),
)
NOT_STARTING = (
    commands.FeedHold(),
    commands.Reset(),  # without an alarm it stops
    commands.StopSpindle(),
    commands.StopJog(),
    commands.DeselectHandwheel(),
    commands.ConfirmStart(""),
    commands.ForceOutput("coolant", False),
    commands.SetSwitch("single_block", True),
    commands.SetSwitch("optional_stop", False),
    commands.SetFeedOverride(0.5),
)


@pytest.mark.parametrize(("command", "starting"), STARTING)
def test_a_late_press_starts_nothing(command: Command, starting: BlockedLateAction) -> None:
    bench = Bench()
    bench.late.is_press_late = True
    bench.post(command)
    assert bench.posted == []
    assert bench.told == [(get_starting_action_name(starting),)]


@pytest.mark.parametrize(("command", "starting"), STARTING)
def test_press_in_time_starts_the_action(command: Command, starting: BlockedLateAction) -> None:
    bench = Bench()
    bench.post(command)
    assert bench.posted == [command]
    assert bench.told == []
    assert find_starting_action(command, bench.shown) is starting


@pytest.mark.parametrize("command", NOT_STARTING)
def test_late_command_that_starts_nothing_is_posted(command: Command) -> None:
    bench = Bench()
    bench.late.is_press_late = True
    bench.post(command)
    assert bench.posted == [command]
    assert bench.told == []


def test_a_late_reset_acknowledges_no_alarm() -> None:
    bench = Bench(shown=Snapshot(state=MachineState.FAULT))
    bench.late.is_press_late = True
    bench.post(commands.Reset())
    assert bench.posted == []


def test_late_override_from_zero_is_not_posted() -> None:
    bench = Bench(shown=Snapshot(state=MachineState.RUN, feed_override=0.0))
    bench.late.is_press_late = True
    bench.post(commands.SetFeedOverride(0.1))
    assert bench.posted == []


def test_one_message_names_all_discarded_late_presses() -> None:
    bench = Bench()
    bench.late.is_press_late = True
    for command in (commands.EnableDrives(), commands.CycleStart(), commands.CycleStart()):
        bench.post(command)
    assert bench.told[-1] == (
        get_starting_action_name(BlockedLateAction.DRIVES),
        get_starting_action_name(BlockedLateAction.CYCLE),
    )
    bench.now += REPORT_INTERVAL_S + 0.1
    bench.post(commands.HomeAxes(""))
    assert bench.told[-1] == (get_starting_action_name(BlockedLateAction.HOME),)


def test_only_a_discarded_confirmation_is_recorded_as_a_late_answer() -> None:
    bench = Bench()
    bench.late.is_press_late = True
    assert bench.late.refuse_late_press(BlockedLateAction.CYCLE)
    assert bench.answers == 0
    assert bench.late.refuse_late_press(BlockedLateAction.YES)
    assert bench.answers == 1


def test_jog_renewal_is_exempt_from_the_late_press_check() -> None:
    bench = Bench()
    bench.late.is_press_late = True
    with bench.late.suspend_check():
        bench.post(commands.Jog("X", 1.0, 0.2))
    assert len(bench.posted) == 1
    bench.post(commands.Jog("X", 1.0, 0.2))
    assert len(bench.posted) == 1


# --- the simulated station ----------------------------------------------------------------------------------


class Station:
    """Notes every button by its name."""

    def __init__(self, note: Callable[[str], None]) -> None:
        self._note = note

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *values: self._note(" ".join((name, *map(str, values))))


def hands_on(bench: Bench, pressed: list[str]) -> StationControls:
    station = cast("StationPanel", Station(pressed.append))
    hands = StationControls(station, lambda: bench.now, lambda _: None, lambda: None, lambda: None)
    hands.set_late_press_filter(bench.late)
    return hands


def test_late_palm_press_is_ignored_even_if_it_remains_down() -> None:
    bench, pressed = Bench(), list[str]()
    hands = hands_on(bench, pressed)
    bench.late.is_press_late = True
    hands.palm("left", is_down=True)
    bench.late.is_press_late = False
    hands.palm("right", is_down=True)
    assert pressed == ["press_right"]


def test_late_tap_does_not_latch_a_palm_button() -> None:
    bench, pressed = Bench(), list[str]()
    hands = hands_on(bench, pressed)
    bench.late.is_press_late = True
    hands.latch("left")
    bench.late.is_press_late = False
    hands.latch("right")
    assert pressed == []


@pytest.mark.parametrize(("auto", "done"), [(True, []), (False, ["set_spindle_auto False"])])
def test_a_late_press_turns_the_spindle_switch_off_only(auto: bool, done: list[str]) -> None:
    bench, pressed = Bench(), list[str]()
    hands = hands_on(bench, pressed)
    bench.late.is_press_late = True
    hands.set_spindle_auto(auto)
    assert pressed == done


def test_late_press_can_press_estop_but_not_release_it() -> None:
    bench, pressed = Bench(), list[str]()
    hands = hands_on(bench, pressed)
    bench.late.is_press_late = True
    hands.estop(is_pressed=True)
    hands.estop(is_pressed=False)
    assert pressed == ["press_estop"]
    assert hands.is_estop_pressed


@pytest.mark.parametrize("which", ["spindle_pot", "feed_pot"])
def test_late_pot_change_from_zero_is_ignored_and_others_apply(which: str) -> None:
    bench = Bench()
    pot = getattr(hands_on(bench, []), which)
    bench.late.is_press_late = True
    pot.set(0.8)
    pot.set(0.0)
    pot.set(0.1)
    assert pot.wanted == 0.0
    bench.late.is_press_late = False
    pot.set(0.1)
    assert pot.wanted == 0.1


# --- two presses before the next snapshot -------------------------------------------------------------------


def test_switch_pressed_twice_before_the_update_returns_to_its_state() -> None:
    now = [5.0]
    posted = PostedValues(lambda: now[0])
    assert posted.toggle_value("single_block", False)
    assert not posted.toggle_value("single_block", False)
    now[0] += ARRIVAL_TIMEOUT_S + 0.01
    assert posted.toggle_value("single_block", False)


def test_override_changed_twice_before_the_update_moves_two_steps() -> None:
    posted = PostedValues(lambda: 5.0)
    assert posted.change_value("feed", 1.0, lambda value: value - 0.25) == 0.75
    assert posted.change_value("feed", 1.0, lambda value: value - 0.25) == 0.5
    assert posted.change_value("other", 1.0, lambda value: value - 0.25) == 0.75
