"""Every state of the executor in the words of MTConnect, with the reason for each."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.shopfloor.machine_reading import ExecutionTracker, find_controller_mode
from core.alarms import CATALOG
from core.executor.snapshot import MachineState, Snapshot, StartAction
from tests.interrupted import broken_off
from tests.texts import text

RUN, IDLE = (
    Snapshot(state=MachineState.RUN, program="a.nc"),
    Snapshot(state=MachineState.IDLE, program="a.nc"),
)


@pytest.mark.parametrize(
    ("state", "waits", "told", "why"),
    [
        (MachineState.ESTOP, "", "STOPPED", "nothing goes on from an E-stop"),
        (MachineState.FAULT, "", "STOPPED", "an alarm has ended the program"),
        (MachineState.DISABLED, "", "STOPPED", "without power it is not ready"),
        (MachineState.IDLE, "", "READY", "the palms would start it"),
        (MachineState.RUN, "", "ACTIVE", "it executes"),
        (MachineState.STOPPING, "", "FEED_HOLD", "motion is commanded to stop"),
        (MachineState.HOLD, "", "FEED_HOLD", "somebody pressed it"),
        (
            MachineState.HOLD,
            CATALOG["low-queue"].text.upper(),
            "INTERRUPTED",
            "nobody pressed it, and somebody has to start it again",
        ),
        (MachineState.SINGLE_BLOCK_STOP, "", "INTERRUPTED", "each block wants a press"),
        (MachineState.WAIT, "DWELL", "ACTIVE", "a dwell is a block like any other"),
        (MachineState.WAIT, text("executor.at-speed"), "ACTIVE", "the spindle runs up"),
        (MachineState.WAIT, text("executor.spindle-stop-wait"), "ACTIVE", "the spindle runs down"),
        (
            MachineState.WAIT,
            text("executor.c-axis"),
            "ACTIVE",
            "the drive changes from turning to positioning",
        ),
        (MachineState.WAIT, text("executor.proof-wait"), "ACTIVE", "the control thinks"),
        (MachineState.WAIT, "PLC-1", "WAIT", "an input by its terminal"),
        (MachineState.WAIT, "COLLET", "WAIT", "a device moves the material"),
        (MachineState.WAIT, "TB2-5", "WAIT", "bar feed or loader have to answer"),
        (MachineState.WAIT, text("executor.feed-override-0"), "FEED_HOLD", "the pot holds the slides"),
        (
            MachineState.WAIT,
            text("executor.spindle-switch-off"),
            "INTERRUPTED",
            "the switch has to be turned",
        ),
        (MachineState.WAIT, text("executor.spindle-override-0"), "INTERRUPTED", "the pot has to be turned"),
        (MachineState.PROGRAM_STOP, "", "PROGRAM_STOPPED", "M00"),
        (MachineState.JOG, "", "READY", "no program is under way"),
        (MachineState.HOMING, "", "READY", "no program is under way"),
    ],
)
def test_execution_value_follows_machine_state(state: MachineState, waits: str, told: str, why: str) -> None:
    execution = ExecutionTracker(frozenset({"TB2-5", "1", "PLC-1"}))
    assert execution.update(Snapshot(state=state, waiting_for=waits)) == told, why


@pytest.mark.parametrize("state", MachineState)
def test_every_machine_state_has_an_execution_value(state: MachineState) -> None:
    assert ExecutionTracker().update(Snapshot(state=state)).isupper()


def test_optional_stop_is_distinguished_from_program_stop() -> None:
    assert (
        ExecutionTracker().update(Snapshot(state=MachineState.PROGRAM_STOP, is_optional_stop=True))
        == "OPTIONAL_STOP"
    )


def told(*snapshots: Snapshot) -> list[str]:
    execution = ExecutionTracker()
    return [execution.update(each) for each in snapshots]


def test_ended_program_is_completed_until_next_change() -> None:
    done = replace(IDLE, ends=1)
    assert told(IDLE, RUN, done, done) == ["READY", "ACTIVE", "PROGRAM_COMPLETED", "PROGRAM_COMPLETED"]
    assert told(RUN, done, replace(done, state=MachineState.RUN))[-1] == "ACTIVE"
    for after in (
        replace(done, program="b.nc"),  # another program on the desk
        replace(done, lines=1),  # a line of MDI has run
    ):
        assert told(RUN, done, after)[-1] == "READY"
    jogged = replace(done, state=MachineState.JOG)
    assert told(RUN, done, jogged, done)[1:] == ["PROGRAM_COMPLETED", "READY", "READY"]
    off = replace(done, state=MachineState.DISABLED)
    assert told(RUN, done, off, done)[1:] == ["PROGRAM_COMPLETED", "STOPPED", "READY"]


def test_program_shorter_than_poll_interval_is_detected_by_its_end() -> None:
    assert told(IDLE, replace(IDLE, ends=1)) == ["READY", "PROGRAM_COMPLETED"]


def test_programs_ended_before_first_poll_are_ignored() -> None:
    assert told(replace(IDLE, ends=7)) == ["READY"]


def test_a_repeated_cycle_stays_active() -> None:
    assert told(RUN, replace(RUN, ends=1), replace(RUN, ends=2)) == ["ACTIVE"] * 3


def test_canceled_program_is_stopped_and_not_completed() -> None:
    given_up = replace(IDLE, interrupted=broken_off(program="a.nc"))
    assert told(RUN, given_up, replace(RUN, interrupted=None)) == ["ACTIVE", "STOPPED", "ACTIVE"]


@pytest.mark.parametrize(
    ("snapshot", "mode"),
    [
        (RUN, "AUTOMATIC"),
        (replace(RUN, single_block=True), "SEMI_AUTOMATIC"),
        (replace(RUN, starts=StartAction.MDI_LINE), "MANUAL_DATA_INPUT"),
        (replace(RUN, starts=StartAction.MDI_LINE, single_block=True), "MANUAL_DATA_INPUT"),
        (replace(RUN, starts=StartAction.RESTART), "AUTOMATIC"),
        (replace(IDLE, state=MachineState.JOG, single_block=True), "MANUAL"),
        (replace(IDLE, state=MachineState.HOMING), "MANUAL"),
        (replace(IDLE, state=MachineState.ESTOP), "AUTOMATIC"),
    ],
)
def test_controller_mode_follows_machine_state(snapshot: Snapshot, mode: str) -> None:
    assert find_controller_mode(snapshot) == mode


def test_end_between_two_polls_is_reported_before_drives_off() -> None:
    """A run without a screen switches everything off as soon as its program has ended."""
    execution, off = ExecutionTracker(), Snapshot(state=MachineState.DISABLED, program="a.nc", ends=1)
    execution.update(RUN)
    assert [execution.update(off), execution.update(off)] == ["PROGRAM_COMPLETED", "STOPPED"]


def test_drives_off_during_program_is_not_a_program_end() -> None:
    execution = ExecutionTracker()
    execution.update(RUN)
    assert execution.update(Snapshot(state=MachineState.DISABLED, program="a.nc")) == "STOPPED"
