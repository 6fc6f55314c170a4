"""The firmware's wait for the spindle inside M3 ($340, $394): no false alarm, and a stop ends it at once.

The simulated firmware waits as ``spindle_control.c`` of 2026-08 does.
"""

from __future__ import annotations

import pytest

from core.executor.commands import Reset
from core.executor.snapshot import MachineState
from core.faults import get_fault_code
from drivers.grblhal.grblhal_state import MAX_FIRMWARE_WAIT_S, get_firmware_wait_s
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.simulators.plant_config import SimSpindle
from drivers.simulators.spindle_motor import SpindleMotor
from drivers.wakeups import ManualClock
from tests.drivers.grblhal.bench import GrblBench, grbl_machine, quirky

TOLERANCE, ON, OFF, COOLANT = 340, 394, 539, 673
PART = "G90G94F300\nM03S3000\nM08\nX.5Z.2\nG04F1\nM05\nM09\nM30\n"


def slow_bench(settings: dict[int, float], *, encoder: bool = True) -> GrblBench:
    """A spindle that takes 6 s to 3 000 rpm, on a machine that allows 9 s."""
    machine = grbl_machine(("timeout_s = 5", "timeout_s = 9"))
    bench = GrblBench(machine, quirky(settings=settings, encoder=encoder))
    bench.peer.spindle = SpindleMotor(SimSpindle(acceleration_rpm_per_s=500.0))
    return bench


def waiting(bench: GrblBench) -> GrblBench:
    """In M3, whose answer is awaited, for 3 s."""
    bench.start(PART)
    bench.until_true(lambda _: bench.peer.program.active_wait is not None, 10.0)
    bench.run(3.0)
    assert bench.peer.program.active_wait is not None, bench.alarms()
    return bench


@pytest.mark.parametrize("encoder", [True, False])
@pytest.mark.parametrize("settings", [{TOLERANCE: 5.0}, {TOLERANCE: 5.0, ON: 9.0}, {ON: 8.0}])
def test_slow_spindle_followed_by_coolant_raises_no_alarm(settings: dict[int, float], encoder: bool) -> None:
    bench = slow_bench(settings, encoder=encoder)
    waiting(bench)
    bench.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert (bench.state, bench.alarms()) == (MachineState.IDLE, "")
    assert bench.peer.program.executed_lines.count("M8") == 1
    assert not bench.said("alarm")


def test_coolant_during_its_switch_on_delay_is_not_reported_as_off() -> None:
    bench = slow_bench({COOLANT: 5.0})
    bench.start(PART)
    bench.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert (bench.state, bench.alarms()) == (MachineState.IDLE, "")


def test_coolant_that_turns_off_after_the_wait_is_reported() -> None:
    bench = slow_bench({TOLERANCE: 5.0})
    waiting(bench)
    bench.until_true(lambda _: bench.peer.output_states.get("flood", False), 20.0)
    bench.peer.output_states["flood"] = False
    bench.until_true(lambda shot: shot.stop is not None, 5.0)
    assert bench.shot.stop is not None
    assert bench.shot.stop.code == "switched-off"


def test_spindle_that_remains_too_slow_raises_the_firmware_alarm() -> None:
    bench = slow_bench({TOLERANCE: 5.0, ON: 4.0})
    bench.start(PART)
    bench.until(MachineState.FAULT, limit=10.0)
    assert bench.peer.alarm_number == 14
    (alarm,) = bench.shot.alarms
    assert alarm.code == "controller-alarm"
    bench.run(0.5)
    assert bench.peer.commanded_rpm == 0.0


def test_reset_during_the_spindle_wait_stops_the_spindle_immediately() -> None:
    bench = waiting(slow_bench({TOLERANCE: 5.0}))
    bench.post(Reset())
    bench.run(1.0)
    assert bench.peer.commanded_rpm == 0.0
    assert bench.peer.program.active_wait is None
    assert not bench.peer.output_states.get("flood", False)


@pytest.mark.parametrize("held", [False, True])
def test_a_spindle_stop_does_not_wait_for_the_speed(held: bool) -> None:
    """Neither M5 nor the toggle of a hold reaches firmware that waits."""
    bench = slow_bench({TOLERANCE: 5.0})
    bench.ready()
    bench.machine.spindle.set_speed(3000.0)
    bench.alone(2.0)
    assert bench.peer.program.active_wait is not None
    if held:
        bench.machine.block_controller.stop_on_path()
        bench.alone(0.3)
    bench.machine.spindle.set_speed(0.0)
    bench.alone(1.0)
    assert bench.peer.commanded_rpm == 0.0
    assert bench.machine.controller.fault == ""


def test_lost_reply_to_m3_is_missed_after_the_longest_wait() -> None:
    bench = slow_bench({ON: 4.0})
    bench.ready()
    bench.peer.behavior.garbled_replies.append(b"")
    bench.machine.spindle.set_speed(3000.0)
    bench.alone(5.5)
    assert bench.machine.controller.fault == ""
    bench.alone(2.0)
    assert get_fault_code(bench.machine.controller.fault, "driver") == "controller-silent"


@pytest.mark.parametrize(
    ("line", "settings", "seconds"),
    [
        ("M3S500", {}, 0.0),
        ("M3S500", {TOLERANCE: "5.0", ON: "0.0"}, MAX_FIRMWARE_WAIT_S),
        ("M03S500", {TOLERANCE: "5.0", ON: "4.0"}, 4.0),
        ("M4S500", {TOLERANCE: "0.0", ON: "4.0"}, 4.0),
        ("M4S500", {392: "3.0"}, 3.0),  # firmware without $394
        ("M5", {ON: "4.0", OFF: "2.0"}, 2.0),
        ("M8", {COOLANT: "1.5", ON: "4.0"}, 1.5),
        ("M30", {ON: "4.0", TOLERANCE: "5.0"}, 0.0),
        ("N2G1X1", {ON: "4.0", TOLERANCE: "5.0"}, 0.0),
    ],
)
def test_the_longest_wait_follows_the_settings(line: str, settings: dict[int, str], seconds: float) -> None:
    assert get_firmware_wait_s(line, settings) == seconds


def test_firmware_reports_during_the_spindle_wait_but_reads_no_line() -> None:
    """As the firmware's simulator did with $394=3: Idle, the programmed speed, M8 unread."""
    clock = ManualClock()
    firmware = GrblFirmware(clock, quirky(settings={ON: 3.0}))
    firmware.receive_bytes(b"M3S500\nM8\n")
    clock.advance(1.0)
    firmware.receive_bytes(b"\x87")
    told = firmware.pop_output().decode()
    assert "ok" not in told
    assert told.startswith("<Idle|")
    assert ",500," in told
    assert "|A:S|" in told
    clock.advance(2.5)
    assert firmware.pop_output().decode().split() == ["ok", "ok"]
    assert firmware.output_states["flood"]
