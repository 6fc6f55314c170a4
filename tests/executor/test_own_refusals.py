"""Refusals and answers of the executor's single parts, asked by themselves."""

from __future__ import annotations

import dataclasses
import logging
import math
import re

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.hand_motion.drive_test import DriveTester, DriveTestMotion, Shape
from core.executor.hand_motion.jogging import Jogger
from core.executor.job import Job, Proof, check_block, find_outdated_setting, make_job
from core.executor.program_motion.path_section import PathSection
from core.executor.program_motion.spindle_angle import SpindleAnglePredictor
from core.executor.program_run import OffsetChangeRequest
from core.executor.raised_alarm import AlarmError, ErrorReporter
from core.executor.snapshot import MachineState
from core.executor.spindle_control import SpindleControl, SpindleRequest
from core.executor.start_conditions import describe_missing_function, find_state_inhibit_reason
from core.executor.station_signals import StationSignals
from core.faults import SPINDLE_TURNS
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.machine_requirements import ARC_MOTION, THREADING, MachineRequirement
from core.interpreter.shared.modal_state import ModalState
from core.language.source import ProgramSource
from core.motion.axis_limits import MotionLimits
from core.ports import DriverError
from tests.coded import raises_code
from tests.executor.made import Maker
from tests.executor.played_controller import PlayedController, context_of
from tests.texts import pattern, text

# --- before a start -----------------------------------------------------------------------------------------


def test_controller_that_cannot_start_reports_why() -> None:
    context = context_of(PlayedController(hindrance="its modes are being verified"))
    assert find_state_inhibit_reason(context, MachineState.IDLE) == "its modes are being verified"


def test_missing_controller_function_is_reported_with_its_line() -> None:
    context = context_of(PlayedController(capabilities=frozenset({ARC_MOTION})))
    proof = Proof(
        "", (), required_functions=(MachineRequirement(ARC_MOTION, 3), MachineRequirement(THREADING, 5))
    )
    assert re.fullmatch(
        pattern("executor.controller-cannot", line=5), describe_missing_function(context, proof)
    )


def test_missing_machine_function_is_reported_with_its_line() -> None:
    context = context_of(None)
    context.machine = dataclasses.replace(context.machine, missing_outputs=frozenset({"catcher"}))
    proof = Proof("", (), required_functions=(MachineRequirement("output catcher", 4),))
    assert re.fullmatch(
        pattern("executor.no-such-for-line", line=4), describe_missing_function(context, proof)
    )


def job_of(text: str, **changes: object) -> Job:
    return make_job(ProgramSource("PART", text), InterpreterSetup(**changes))  # type: ignore[arg-type]


def test_a_job_that_was_proved_with_another_unit_or_rapid_rate_is_outdated() -> None:
    job = job_of("G90G94\nX1\nM30\n", last_rapid=50.0)
    left = ModalState(rapid_rate=50.0)
    assert find_outdated_setting(job, left) == ""
    assert find_outdated_setting(job, ModalState(rapid_rate=50.0, metric=True)) == text(
        "executor.counts-in-mm"
    )
    assert find_outdated_setting(job, ModalState(rapid_rate=60.0)) == text("executor.other-rapid-rate")


def test_repeat_is_allowed_without_pending_offsets() -> None:
    assert OffsetChangeRequest(context_of(None)).find_repeat_refusal_reason(ModalState()) == ""


@pytest.mark.parametrize(
    ("held", "guard", "why"),
    [
        (True, False, text("executor.hold-pressed")),
        (False, True, text("executor.guard-open-held")),
        (False, False, ""),
    ],
)
def test_drive_test_is_rejected_in_feed_hold_or_with_guard_open(held: bool, guard: bool, why: str) -> None:
    context = context_of(None)
    context.station_signals = StationSignals(
        is_estop_pressed=False,
        is_start_requested=False,
        is_hold_requested=held,
        feed_override=1.0,
        spindle=1.0,
        is_spindle_in_auto=True,
        station_fault="",
    )
    context.spindle.is_guard_open = guard
    path = DriveTestMotion("X", Shape.STEP, 1.0)
    context.axis_sample = context.axis_sample._replace(demand=(50.0, -50.0, 0.0))
    assert DriveTester(context, Jogger(context)).find_refusal_reason(path, 0.5) == why


# --- inputs by name and terminal ----------------------------------------------------------------------------


def test_input_is_found_by_name_or_terminal_and_is_off_when_unknown() -> None:
    context = context_of(None)
    name, model = next((name, each) for name, each in context.machine.inputs.items() if each.terminal)
    context.inputs = {name: True}
    assert context.is_input_on(name)
    assert context.is_input_on(model.terminal)
    assert not context.is_input_on("TB99-9")
    context.inputs = {}
    assert not context.is_input_on(model.terminal)


# --- a block checked once more before it moves --------------------------------------------------------------


def test_feed_per_rev_with_stopped_spindle_is_rejected() -> None:
    (block,) = Maker().thread(0.0, -1.0, 0.5).blocks
    with raises_code(AlarmError, "spindle-still", text("executor.line-feeds-by-rev", line=1)):
        check_block(block, load_machine())


def test_c_move_while_c_turns_as_the_spindle_is_rejected() -> None:
    machine = dataclasses.replace(load_machine(), has_separate_c_drive=False)
    (block,) = Maker().feed(0.0, -1.0, 0.5).blocks
    block = dataclasses.replace(block, c=90.0, modal=ModalState(spindle=1), kind=BlockKind.ROTATE)
    with raises_code(AlarmError, "c-is-spindle", text("executor.line-moves-c", line=1)):
        check_block(block, machine)


def test_dropping_unknown_blocks_leaves_the_section_unchanged() -> None:
    section = PathSection(MotionLimits(), 3500.0)
    section.append_blocks(Maker().feed(0.0, -1.0, 5.0).feed(0.0, -2.0, 5.0).blocks)
    for n in (None, 7):
        section.discard_earlier_blocks(n)
        assert [block.n for block in section.list_following_blocks(0)] == [1, 2]


# --- the spindle --------------------------------------------------------------------------------------------


class PlayedLock:
    """The spindle's drive as C, half changed over as long as ``ready`` is not set."""

    def __init__(self) -> None:
        self.asked: list[tuple[bool, bool]] = []
        self.ready = False
        self.refusal: DriverError | None = None

    def set_c_mode(self, is_enabled: bool, should_orient: bool = False) -> None:
        if self.refusal is not None:
            raise self.refusal
        self.asked.append((is_enabled, should_orient))

    def is_c_ready(self) -> bool:
        return self.ready


def locked() -> tuple[SpindleControl, PlayedLock]:
    context, lock = context_of(None), PlayedLock()
    return SpindleControl(context.ports.spindle, context.machine.spindle, lock), lock


def test_spindle_switches_to_c_once_and_stop_releases_it() -> None:
    spindle, lock = locked()
    assert not spindle.engage_c_axis(should_orient=True)
    assert lock.asked == [(True, True)]
    lock.ready = True
    assert spindle.engage_c_axis(should_orient=True)
    assert spindle.is_c_axis_ready
    assert lock.asked == [(True, True)]
    spindle.cancel_orientation()
    assert lock.asked == [(True, True)]  # what is C already stays it
    spindle.stop()
    assert lock.asked[1:] == [(False, False)]


def test_drive_that_still_turns_is_asked_for_c_again() -> None:
    spindle, lock = locked()
    lock.refusal = DriverError("the spindle is turning", "c-coupling", reason=SPINDLE_TURNS)
    assert not spindle.engage_c_axis(should_orient=True)
    lock.refusal = None
    spindle.engage_c_axis(should_orient=True)
    assert lock.asked == [(True, True)]


def test_jog_of_c_names_whether_the_drive_rejects_c_or_switches_to_it() -> None:
    context = context_of(None)
    context.spindle, lock = locked()
    jogger = Jogger(context)
    lock.refusal = DriverError("the spindle is turning", "c-coupling", reason=SPINDLE_TURNS)
    assert jogger.request_c_axis_mode("C") == text("executor.c-still-turns")
    lock.refusal = None
    assert jogger.request_c_axis_mode("C") == text("executor.becomes-c")
    assert lock.asked == [(True, False)]
    lock.ready = True
    assert jogger.request_c_axis_mode("C") == ""


def test_drive_that_rejects_c_for_another_reason_is_an_error() -> None:
    spindle, lock = locked()
    lock.refusal = DriverError("the drives are off", "c-coupling", reason="drives-off")
    with raises_code(DriverError, "c-coupling", "the drives are off"):
        spindle.engage_c_axis(should_orient=True)


def test_hold_cancels_a_pending_change_to_c() -> None:
    spindle, lock = locked()
    spindle.engage_c_axis(should_orient=False)
    spindle.cancel_orientation()
    assert lock.asked == [(True, False), (False, False)]


def test_spindle_wait_reasons_are_reported_by_priority() -> None:
    spindle, _ = locked()
    assert (spindle.start_inhibit_reason, spindle.spindle_stopped_reason) == (
        "",
        text("executor.spindle-stopped"),
    )
    spindle.request_speed(SpindleRequest(600.0))
    assert spindle.spindle_stopped_reason == ""
    spindle.override = 0.0
    assert spindle.spindle_stopped_reason == text("executor.spindle-override-0")
    spindle.is_auto = False
    assert spindle.spindle_stopped_reason == text("executor.spindle-switch-off")
    spindle.is_guard_open = True
    assert spindle.spindle_stopped_reason == text("executor.guard-open")
    spindle.record_external_stop("THE FEEDER HAS SWITCHED OFF")
    assert spindle.waiting_start_rpm == 0.0  # at an override of 0
    spindle.permit_start()
    assert spindle.waiting_reason  # barred: nothing is permitted


def test_missing_or_stopped_encoder_does_not_predict_the_angle() -> None:
    angle = SpindleAnglePredictor()
    with raises_code(AlarmError, "thread-no-encoder", text("executor.counts-nothing")):
        angle.predict_turning_angle(1.0)
    assert math.isnan(angle.latest_revolutions)
    for k in range(10):
        angle.add_reading((0.01 * k, 2.5))
    with raises_code(AlarmError, "thread-no-encoder", text("executor.does-not-turn")):
        angle.predict_turning_angle(0.1)
    angle.add_reading((0.09, 9.0))  # not later than the last one
    assert angle.latest_revolutions == 2.5
    angle.add_reading(None)
    assert not angle.can_predict_angle


# --- what must not stop the rest ----------------------------------------------------------------------------


def test_failure_in_the_failure_handler_is_logged_as_second_error(caplog: pytest.LogCaptureFixture) -> None:
    def tell(_error: BaseException) -> None:
        raise OSError("the log is gone")

    with caplog.at_level(logging.ERROR), ErrorReporter(tell):
        raise ValueError("a failure that no other test has")
    assert [record.getMessage() for record in caplog.records] == [
        "the control has failed, 1",
        "and could not say so",
    ]
