"""What every driver does and refuses, as far as a controller that plans by itself can."""

from __future__ import annotations

import numpy as np
import pytest

from core.block_ports import LineOperation
from core.ports import DriverError, MotionSegments, StopMode
from tests.coded import raises_code
from tests.drivers.grblhal.bench import GrblBench, quirky
from tests.texts import text


def powered() -> GrblBench:
    bench = GrblBench()
    bench.machine.axes.enable(True)
    bench.alone(0.3)
    return bench


def test_setpoints_are_refused() -> None:
    bench = powered()
    still = np.zeros((1, 3))
    with raises_code(DriverError, "driver") as told:
        bench.machine.axes.splice(MotionSegments(np.zeros(1), np.zeros(1), still, still, still))
    assert told.value.reason == "blocks-only"


def test_block_arrives_exactly_at_its_target() -> None:
    bench = powered()
    ticket = bench.machine.block_controller.submit_block(LineOperation(3.14159, -2.71828, 20.0))
    assert ticket == 1
    assert not bench.machine.block_controller.state().is_at_rest
    bench.alone(1.0)
    assert bench.machine.block_controller.state().last_completed_ticket == 1
    assert bench.machine.axes.sample().actual[:2] == (3.14159, -2.71828)


def test_position_at_rest_is_the_block_end_despite_coarse_steps() -> None:
    """100 steps in a millimetre: reports are up to 5 µm off; the next block begins where this one ended."""
    bench = GrblBench(quirks=quirky(settings={100: 100.0, 102: 100.0}))
    bench.machine.axes.enable(True)
    bench.alone(0.3)
    bench.machine.block_controller.submit_block(LineOperation(3.1451, -2.7151, 20.0))
    bench.alone(1.0)
    assert bench.machine.controller.position["X"] == pytest.approx(3.15)
    assert bench.machine.axes.sample().actual[:2] == (3.1451, -2.7151)


@pytest.mark.parametrize("how", [StopMode.OFF, StopMode.RAMP_OFF, StopMode.RAMP_HOLD])
def test_stop_brakes_and_discards_the_queued_blocks(how: StopMode) -> None:
    bench = powered()
    bench.machine.block_controller.submit_block(LineOperation(50.0, 0.0, 40.0))
    bench.alone(0.5)
    x = bench.peer.motion.position[0]
    bench.machine.axes.stop(how)
    bench.alone(1.5)
    assert bench.peer.motion.position[0] - x < 1.0
    assert not bench.peer.motion.block_queue
    assert bench.machine.axes.sample().enabled is (how is StopMode.RAMP_HOLD)
    assert not bench.machine.axes.sample().moving
    assert bench.machine.block_controller.state().start_refusal_reason == ""


def test_the_spindle_turns_and_stops() -> None:
    bench = powered()
    bench.machine.spindle.set_speed(-600.0)
    bench.alone(1.5)
    assert bench.machine.spindle.speed() == pytest.approx(-600.0, abs=1.0)
    assert "M4S600" in bench.peer.program.executed_lines
    bench.machine.spindle.set_speed(0.0)
    bench.alone(1.5)
    assert bench.machine.spindle.speed() == 0.0
    assert bench.machine.spindle.read_fault() == ""


def test_reversing_spindle_reports_new_direction_only_after_slowing_down() -> None:
    """Its encoder tells no direction: 600 rpm of before are none the other way, at which one may cut."""
    bench = powered()
    bench.machine.spindle.set_speed(600.0)
    bench.alone(1.5)
    bench.machine.spindle.set_speed(-600.0)
    for _ in range(300):
        bench.alone(0.01)
        real, told = bench.peer.spindle.speed, bench.machine.spindle.speed()
        assert told > -450.0 or real < 0.0
    assert bench.machine.spindle.speed() == pytest.approx(-600.0, abs=1.0)


def test_spindle_speed_changes_by_override_while_axes_move() -> None:
    bench = powered()
    bench.machine.spindle.set_speed(1000.0)
    bench.alone(1.5)
    bench.machine.block_controller.submit_block(LineOperation(20.0, 0.0, 10.0))
    bench.alone(0.3)
    bench.wire.sent.clear()
    bench.machine.spindle.set_speed(870.0)
    bench.alone(0.8)
    assert bench.peer.spindle_percent == 87
    assert bench.wire.lines() == []
    bench.alone(2.0)  # at rest it is said as a speed, and the override goes back
    assert (bench.peer.programmed_rpm, bench.peer.spindle_percent) == (870.0, 100)


def test_outputs_are_switched_and_fall_to_their_safe_state() -> None:
    bench = powered()
    io = bench.machine.io
    io.write("coolant", True)
    io.write("collet", True)
    bench.alone(0.1)
    assert bench.peer.output_states["flood"]
    io.switch_to_safe_state()
    bench.alone(0.1)
    assert not bench.peer.output_states["flood"]
    assert bench.peer.output_states["out.0"]  # "keep"
    with raises_code(DriverError, "output", "'laser'"):
        io.write("laser", True)


def test_output_change_blocked_by_an_alarm_is_sent_after_reset() -> None:
    bench = powered()
    bench.machine.io.write("catcher", True)
    bench.alone(0.1)
    bench.peer.raise_alarm(1)
    bench.alone(0.3)
    bench.machine.io.switch_to_safe_state()
    assert bench.peer.output_states["out.1"]
    bench.machine.axes.clear_fault()
    bench.alone(1.5)
    assert not bench.peer.output_states["out.1"]
    assert not all(bench.machine.axes.sample().homed)  # a hard limit: nobody knows where it stands


def test_a_block_is_refused_while_the_modes_are_verified() -> None:
    bench = powered()
    bench.machine.block_controller.abort_blocks()
    with raises_code(DriverError, "controller-refuses", text("drivers.grblhal-verifies")):
        bench.machine.block_controller.submit_block(LineOperation(1.0, 0.0, 1.0))
