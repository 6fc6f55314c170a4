"""Every way to stop brakes first: a reset in motion loses the position, a stop tears the slides."""

from __future__ import annotations

import pytest

from core.block_ports import LineOperation, ThreadOperation
from core.faults import get_fault_code
from core.ports import StopMode
from tests.drivers.grblhal.bench import GrblBench, quirky

HOLD, CANCEL, RESET, STOP, PAUSE = 0x82, 0x85, 0x18, 0x19, 0x9E


def powered(**quirks: object) -> GrblBench:
    bench = GrblBench(quirks=quirky(**quirks))
    bench.machine.axes.enable(True)
    bench.alone(0.3)
    return bench


def ends_well(bench: GrblBench) -> None:
    """At rest, nothing queued, the position kept, modes verified."""
    bench.alone(2.5)
    assert bench.peer.abrupt_stop_count == 0
    assert bench.peer.alarm_number == 0
    assert not bench.peer.motion.block_queue
    assert bench.machine.controller.is_position_reliable
    assert bench.machine.block_controller.state().start_refusal_reason == ""
    assert bench.peer.program.modes.plane == "G18"


def thread(bench: GrblBench, z: float) -> None:
    """A pass of 1 mm a turn, as soon as the overrides are known to be at 100 %."""
    op = ThreadOperation(0.0, 0.0, 0.0, z, 1.0)
    for _ in range(50):
        if bench.machine.block_controller.submit_block(op) is not None:
            return
        bench.alone(0.1)
    raise AssertionError("never taken")


def test_block_is_braked_before_the_reset_that_discards_the_queue() -> None:
    bench = powered()
    for i in range(1, 4):
        bench.machine.block_controller.submit_block(LineOperation(50.0 * i, 0.0, 40.0))
    bench.alone(0.5)
    bench.wire.sent.clear()
    bench.machine.axes.stop(StopMode.RAMP_OFF)
    ends_well(bench)
    sent = bytes(bench.wire.sent)
    assert sent.index(HOLD) < sent.index(RESET)
    assert STOP not in sent


def test_jog_is_canceled_before_the_reset() -> None:
    bench = powered()
    bench.machine.block_controller.start_jog("X", 40.0, 0.3, None)
    bench.alone(0.2)
    assert bench.peer.motion.is_moving
    bench.wire.sent.clear()
    bench.machine.axes.stop(StopMode.RAMP_OFF)
    ends_well(bench)
    sent = bytes(bench.wire.sent)
    assert sent.index(CANCEL) < sent.index(RESET)


def test_stop_during_a_hold_starts_no_motion() -> None:
    bench = powered()
    bench.machine.block_controller.submit_block(LineOperation(50.0, 0.0, 40.0))
    bench.alone(0.5)
    bench.machine.block_controller.stop_on_path()
    bench.alone(0.5)
    at = bench.peer.motion.position
    bench.machine.axes.stop(StopMode.RAMP_OFF)
    ends_well(bench)
    assert bench.peer.motion.position == at


@pytest.mark.parametrize("mute", [True, False])
def test_thread_waiting_for_its_index_is_canceled_with_position_retained(mute: bool) -> None:
    """At 30 rpm the second index comes after 2 to 4 s. In that wait the firmware answers nothing.

    Where its wire is read meanwhile 0x19 ends the wait. Where it is not, as in the simulator, hold and stop
    come when the pass has just begun to move: within its first hundredth of a millimetre.
    """
    bench = powered(mute=mute)
    bench.machine.spindle.set_speed(30.0)
    bench.alone(1.0)
    thread(bench, -20.0)
    bench.alone(1.0)
    assert bench.peer.is_waiting_for_index
    assert not bench.machine.controller.fault
    bench.machine.axes.stop(StopMode.RAMP_OFF)
    bench.alone(7.0)
    assert bench.peer.motion.position[1] == pytest.approx(0.0, abs=0.01)
    bench.peer.abrupt_stop_count = 0
    ends_well(bench)


def test_slow_index_is_not_reported_as_silence() -> None:
    bench = powered()
    bench.machine.spindle.set_speed(25.0)
    bench.alone(1.0)
    thread(bench, -2.0)
    bench.alone(12.0)
    assert bench.machine.controller.fault == ""
    assert bench.peer.motion.position[1] == -2.0


def test_spindle_is_stopped_by_its_toggle_in_a_hold_and_stays_off() -> None:
    bench = powered()
    bench.machine.spindle.set_speed(600.0)
    bench.alone(1.0)
    bench.machine.block_controller.submit_block(LineOperation(50.0, 0.0, 10.0))
    bench.alone(0.5)
    bench.machine.block_controller.stop_on_path()
    bench.alone(0.5)
    bench.machine.spindle.set_speed(0.0)
    bench.alone(1.5)
    assert bytes(bench.wire.sent).count(PAUSE) == 1
    assert bench.machine.spindle.speed() == 0.0
    bench.machine.block_controller.resume()
    bench.alone(0.5)
    assert bench.peer.motion.is_moving
    assert bench.peer.commanded_rpm == 0.0
    bench.alone(6.0)
    assert "M5" in bench.peer.program.executed_lines


def test_spindle_that_does_not_stop_in_a_hold_is_reported() -> None:
    bench = powered(toggle_broken=True)
    bench.machine.spindle.set_speed(600.0)
    bench.alone(1.0)
    bench.machine.block_controller.submit_block(LineOperation(50.0, 0.0, 10.0))
    bench.alone(0.5)
    bench.machine.block_controller.stop_on_path()
    bench.alone(0.5)
    bench.machine.spindle.set_speed(0.0)
    bench.alone(1.5)
    assert get_fault_code(bench.machine.controller.fault, "driver") == "ignores-stop"


def test_outputs_are_switched_after_the_end_of_a_jog() -> None:
    """Sent at once they would be refused, and the refusal would stick."""
    bench = powered()
    bench.machine.spindle.set_speed(600.0)
    bench.machine.io.write("coolant", True)
    bench.alone(1.0)
    bench.machine.block_controller.start_jog("X", 40.0, 0.3, None)
    bench.alone(0.1)
    bench.machine.io.write("coolant", False)
    bench.machine.spindle.set_speed(0.0)
    bench.alone(1.5)
    assert bench.machine.controller.fault == ""
    assert bench.peer.programmed_rpm == 0.0
    assert bench.peer.output_states["flood"] is False


def test_full_buffer_never_prevents_the_resume_command() -> None:
    """Hundreds of short blocks, a hold in their middle, and on: with too little free nothing is heard."""
    bench = powered()
    sent = 0
    for _ in range(400):
        ticket = bench.machine.block_controller.submit_block(
            LineOperation(0.05 * (sent + 1), 0.00001 * (sent + 1), 5.0)
        )
        sent += ticket is not None
        bench.alone(0.0)
    assert sent >= 40
    bench.alone(0.2)
    bench.machine.block_controller.stop_on_path()
    bench.alone(0.3)
    while (
        bench.machine.block_controller.submit_block(
            LineOperation(0.05 * (sent + 1), 0.00001 * (sent + 1), 5.0)
        )
        is not None
    ):
        sent += 1
    bench.machine.block_controller.resume()
    bench.alone(0.5)
    assert bench.peer.state_name == "Run"
    assert bench.machine.controller.fault == ""


def test_reset_that_is_not_confirmed_is_a_fault_after_a_timeout() -> None:
    bench = powered()
    bench.machine.block_controller.submit_block(LineOperation(50.0, 0.0, 40.0))
    bench.alone(0.5)
    bench.peer.behavior.sends_nothing = True
    bench.machine.axes.stop(StopMode.RAMP_OFF)
    bench.alone(2.0)
    bench.peer.behavior.sends_nothing = False
    bench.alone(0.5)
    assert get_fault_code(bench.machine.controller.fault, "driver") == "controller-silent"
    assert "reset" in bench.machine.controller.fault
    assert bench.machine.block_controller.state().is_at_rest
