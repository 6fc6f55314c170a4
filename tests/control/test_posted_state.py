"""What another control gets of the state that the screen has posted, and what it does not get."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.control.posted_state import PostedState
from core.executor.commands import (
    ChangeOffsets,
    Command,
    ConfirmStart,
    CycleStart,
    EnableDrives,
    HomeAxes,
    Jog,
    LoadJob,
    PrepareCycleStart,
    PreventNextPart,
    ReplaceStartClearances,
    ReportInterruptedJob,
    Reset,
    SetFeedOverride,
    SetPartCount,
    SetSpindleLimit,
    SetSwitch,
    SupplyJobProof,
    UseOffsetTables,
)
from core.executor.job import Proof
from core.executor.snapshot import MachineState, Snapshot, StartAction
from tests.control.bench import LONG, SHORT, job_of, one_button
from tests.interrupted import broken_off

LAST = Snapshot(state=MachineState.RUN, made=17)
FIRST, SECOND = job_of(SHORT, one_button()), job_of(LONG, one_button())


def after(*posted: Command, last: Snapshot = LAST) -> list[Command]:
    state = PostedState(None)
    for command in posted:
        state.record_command(command)
    return state.list_restore_commands(last)


def test_control_without_a_program_needs_no_commands() -> None:
    assert after() == []


def test_loaded_program_is_repeated_with_its_proof_and_part_count() -> None:
    proof = Proof(FIRST.digest, ())
    assert after(LoadJob(FIRST), SupplyJobProof(proof)) == [LoadJob(FIRST, proof), SetPartCount(17)]


def test_proof_of_another_program_is_not_repeated() -> None:
    old = Proof(FIRST.digest, ())
    assert after(LoadJob(FIRST, old), LoadJob(SECOND)) == [LoadJob(SECOND), SetPartCount(17)]
    assert after(LoadJob(SECOND), SupplyJobProof(old)) == [LoadJob(SECOND), SetPartCount(17)]


def test_changed_offsets_replace_the_job_of_the_program() -> None:
    proof = Proof(SECOND.digest, ())
    assert after(LoadJob(FIRST), ChangeOffsets(), ChangeOffsets(SECOND, proof)) == [
        LoadJob(SECOND, proof),
        SetPartCount(17),
    ]


@pytest.mark.parametrize("announced", [ChangeOffsets(), ChangeOffsets(failure_reason="no proof")])
def test_announced_offset_change_is_repeated_and_still_bars_the_start(announced: ChangeOffsets) -> None:
    assert after(LoadJob(FIRST), announced) == [LoadJob(FIRST), SetPartCount(17), announced]


@pytest.mark.parametrize(
    "command",
    [
        CycleStart(),
        EnableDrives(),
        HomeAxes(),
        Jog("X", 1.0, 0.3),
        Reset(),
        ConfirmStart("now"),
        ReplaceStartClearances(()),
        PrepareCycleStart(StartAction.PROGRAM),
    ],
)
def test_motion_and_start_commands_are_not_repeated(command: Command) -> None:
    assert after(command) == []


@pytest.mark.parametrize("starts", [StartAction.MDI_LINE, StartAction.RESTART])
def test_a_prepared_line_or_restart_must_be_prepared_again(starts: StartAction) -> None:
    prepared = PrepareCycleStart(starts, FIRST, Proof(FIRST.digest, ()))
    assert after(prepared) == [PrepareCycleStart(StartAction.MDI_LINE)]
    assert after(prepared, PrepareCycleStart(StartAction.PROGRAM)) == []


@pytest.mark.parametrize(
    ("first", "last"),
    [
        (SetSpindleLimit(3000.0), SetSpindleLimit(2000.0)),
        (SetFeedOverride(1.2), SetFeedOverride(0.5)),
        (PreventNextPart("tool 3"), PreventNextPart("")),
        (UseOffsetTables({}, {}), UseOffsetTables({}, {})),
    ],
)
def test_the_last_of_each_value_is_repeated(first: Command, last: Command) -> None:
    assert after(first, last) == [last]


def test_switches_are_as_last_shown_except_cycle_repeat() -> None:
    last = replace(LAST, single_block=True, optional_stop=True, no_count=True, cycle_repeat=True)
    assert after(SetSwitch("cycle_repeat", on=True), last=last) == [
        SetSwitch(name, on=True) for name in ("single_block", "optional_stop", "no_count")
    ]
    assert after(SetSwitch("single_block", on=True)) == []  # the operator has turned it off since


def test_interrupted_job_is_reported_again() -> None:
    state = PostedState(broken_off())
    assert state.list_restore_commands(LAST) == [ReportInterruptedJob(broken_off(), logged=True)]
    state.interrupted_job = None
    assert state.list_restore_commands(LAST) == []


def test_station_settings_are_repeated_without_momentary_presses() -> None:
    state = PostedState(None)
    for name, values in (
        ("press_estop", ()),
        ("press_left", ()),
        ("press_hold", ()),
        ("turn_handwheel", (5,)),
        ("set_feed_pot", (0.7,)),
        ("set_feed_pot", (0.5,)),
        ("set_spindle_auto", (False,)),
    ):
        state.record_station_action(name, values)
    assert state.list_restore_station_actions() == [
        ("press_estop", ()),
        ("set_feed_pot", (0.5,)),
        ("set_spindle_auto", (False,)),
    ]
    state.record_station_action("release_estop", ())
    assert state.list_restore_station_actions()[0] == ("release_estop", ())
