"""Every state of the executor in the words of MTConnect, with the reason for each."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.shopfloor.floor_reading import Execution, mode_of
from core.alarms import CATALOGUE
from core.executor.snapshot import Snapshot, Starts, State
from tests.interrupted import broken_off
from tests.texts import text

RUN, IDLE = Snapshot(state=State.RUN, program="a.nc"), Snapshot(state=State.IDLE, program="a.nc")


@pytest.mark.parametrize(
    ("state", "waits", "told", "why"),
    [
        (State.ESTOP, "", "STOPPED", "nothing goes on from an E-stop"),
        (State.FAULT, "", "STOPPED", "an alarm has ended the program"),
        (State.DISABLED, "", "STOPPED", "without power it is not ready"),
        (State.IDLE, "", "READY", "the palms would start it"),
        (State.RUN, "", "ACTIVE", "it executes"),
        (State.HOLDING, "", "FEED_HOLD", "motion is commanded to stop"),
        (State.HOLD, "", "FEED_HOLD", "somebody pressed it"),
        (
            State.HOLD,
            CATALOGUE["low-queue"].text.upper(),
            "INTERRUPTED",
            "nobody pressed it, and somebody has to start it again",
        ),
        (State.BLOCK_END, "", "INTERRUPTED", "each block wants a press"),
        (State.WAIT, "DWELL", "ACTIVE", "a dwell is a block like any other"),
        (State.WAIT, text("executor.at-speed"), "ACTIVE", "the spindle runs up"),
        (State.WAIT, text("executor.spindle-stop-wait"), "ACTIVE", "the spindle runs down"),
        (State.WAIT, text("executor.c-axis"), "ACTIVE", "the drive changes from turning to positioning"),
        (State.WAIT, text("executor.proof-wait"), "ACTIVE", "the control thinks"),
        (State.WAIT, "PLC-1", "WAIT", "an input by its terminal"),
        (State.WAIT, "COLLET", "WAIT", "a device moves the material"),
        (State.WAIT, "TB2-5", "WAIT", "bar feed or loader have to answer"),
        (State.WAIT, text("executor.feed-override-0"), "FEED_HOLD", "the pot holds the slides"),
        (State.WAIT, text("executor.spindle-switch-off"), "INTERRUPTED", "the switch has to be turned"),
        (State.WAIT, text("executor.spindle-override-0"), "INTERRUPTED", "the pot has to be turned"),
        (State.PROGRAM_STOP, "", "PROGRAM_STOPPED", "M00"),
        (State.JOG, "", "READY", "no program is under way"),
        (State.HOME, "", "READY", "no program is under way"),
    ],
)
def test_states(state: State, waits: str, told: str, why: str) -> None:
    execution = Execution(frozenset({"TB2-5", "1", "PLC-1"}))
    assert execution.look(Snapshot(state=state, waiting_for=waits)) == told, why


@pytest.mark.parametrize("state", State)
def test_no_state_is_without_a_word(state: State) -> None:
    assert Execution().look(Snapshot(state=state)).isupper()


def test_an_optional_stop_is_told_from_a_program_stop() -> None:
    assert Execution().look(Snapshot(state=State.PROGRAM_STOP, optionally_stopped=True)) == "OPTIONAL_STOP"


def told(*snapshots: Snapshot) -> list[str]:
    execution = Execution()
    return [execution.look(each) for each in snapshots]


def test_a_program_that_has_ended_is_completed_until_something_else_happens() -> None:
    done = replace(IDLE, ends=1)
    assert told(IDLE, RUN, done, done) == ["READY", "ACTIVE", "PROGRAM_COMPLETED", "PROGRAM_COMPLETED"]
    assert told(RUN, done, replace(done, state=State.RUN))[-1] == "ACTIVE"
    for after in (
        replace(done, program="b.nc"),  # another program on the desk
        replace(done, lines=1),  # a line of MDI has run
    ):
        assert told(RUN, done, after)[-1] == "READY"
    jogged = replace(done, state=State.JOG)
    assert told(RUN, done, jogged, done)[1:] == ["PROGRAM_COMPLETED", "READY", "READY"]
    off = replace(done, state=State.DISABLED)
    assert told(RUN, done, off, done)[1:] == ["PROGRAM_COMPLETED", "STOPPED", "READY"]


def test_a_program_shorter_than_a_look_is_seen_by_its_end() -> None:
    assert told(IDLE, replace(IDLE, ends=1)) == ["READY", "PROGRAM_COMPLETED"]


def test_programs_of_before_the_first_look_are_nobodys() -> None:
    assert told(replace(IDLE, ends=7)) == ["READY"]


def test_a_repeated_cycle_stays_active() -> None:
    assert told(RUN, replace(RUN, ends=1), replace(RUN, ends=2)) == ["ACTIVE"] * 3


def test_a_program_that_was_given_up_is_stopped_and_not_completed() -> None:
    given_up = replace(IDLE, interrupted=broken_off(program="a.nc"))
    assert told(RUN, given_up, replace(RUN, interrupted=None)) == ["ACTIVE", "STOPPED", "ACTIVE"]


@pytest.mark.parametrize(
    ("snapshot", "mode"),
    [
        (RUN, "AUTOMATIC"),
        (replace(RUN, single_block=True), "SEMI_AUTOMATIC"),
        (replace(RUN, starts=Starts.LINE), "MANUAL_DATA_INPUT"),
        (replace(RUN, starts=Starts.LINE, single_block=True), "MANUAL_DATA_INPUT"),
        (replace(RUN, starts=Starts.RESTART), "AUTOMATIC"),
        (replace(IDLE, state=State.JOG, single_block=True), "MANUAL"),
        (replace(IDLE, state=State.HOME), "MANUAL"),
        (replace(IDLE, state=State.ESTOP), "AUTOMATIC"),
    ],
)
def test_modes(snapshot: Snapshot, mode: str) -> None:
    assert mode_of(snapshot) == mode


def test_an_end_between_two_looks_is_told_before_the_drives_are_off() -> None:
    """A run without a screen switches everything off as soon as its program has ended."""
    execution, off = Execution(), Snapshot(state=State.DISABLED, program="a.nc", ends=1)
    execution.look(RUN)
    assert [execution.look(off), execution.look(off)] == ["PROGRAM_COMPLETED", "STOPPED"]


def test_drives_off_in_the_middle_is_no_end() -> None:
    execution = Execution()
    execution.look(RUN)
    assert execution.look(Snapshot(state=State.DISABLED, program="a.nc")) == "STOPPED"
