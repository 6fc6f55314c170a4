"""The spindle's drive: power only while it turns, and never back by itself."""

from __future__ import annotations

import pytest

from core.faults import get_fault_code
from core.ports import DriverError
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine


def powered(bench: CanBench) -> bool:
    drive = bench.peers.plant.spindle_drive
    assert drive is not None
    return drive.power_states.is_powered


def test_spindle_is_enabled_by_a_speed_command_and_disabled_at_standstill(bench: CanBench) -> None:
    spindle = bench.machine.ports.spindle
    bench.run(0.2)
    assert not powered(bench)
    spindle.set_speed(300.0)
    bench.run(1.0)
    assert powered(bench)
    spindle.set_speed(0.0)
    bench.run(0.1)
    assert powered(bench)  # it brakes
    bench.run(1.0)
    assert spindle.speed() == 0.0
    assert not powered(bench)


def test_speed_command_during_estop_fails_and_does_not_start_on_release(bench: CanBench) -> None:
    spindle = bench.machine.ports.spindle
    bench.peers.machine.press_estop()
    spindle.set_speed(500.0)
    bench.run(1.5)
    assert get_fault_code(spindle.read_fault(), "driver") == "spindle"
    assert spindle.read_fault().startswith("spindle: ")
    bench.peers.machine.release_estop()
    bench.run(2.0)
    assert bench.peers.machine.get_spindle_rpm() == 0.0
    with raises_code(DriverError, "spindle-off", "spindle: "):
        spindle.set_speed(500.0)


def test_blocked_spindle_motor_is_reported_and_spindle_coasts_down(bench: CanBench) -> None:
    spindle = bench.machine.ports.spindle
    spindle.set_speed(500.0)
    bench.run(1.0)
    bench.peers.machine.spindle_fault("blocked")
    bench.until(lambda: spindle.read_fault() != "", 0.1)
    assert get_fault_code(spindle.read_fault(), "driver") == "spindle"
    assert "EMCY 7120" in spindle.read_fault()
    bench.run(3.0)
    assert not powered(bench)
    bench.peers.machine.spindle_fault("")
    bench.machine.axes.clear_fault()
    bench.run(1.0)
    assert spindle.read_fault() == ""
    assert spindle.speed() == 0.0
    spindle.set_speed(200.0)
    bench.run(1.0)
    assert spindle.speed() == pytest.approx(200.0, abs=1.0)


def test_spindle_speed_is_limited_to_the_maximum_of_the_machine(bench: CanBench) -> None:
    bench.machine.ports.spindle.set_speed(-99999.0)
    bench.run(4.0)
    assert bench.machine.ports.spindle.speed() == -3500.0


def test_spindle_angle_is_available_only_with_counts_per_revolution() -> None:
    plain = CanBench()
    assert plain.machine.ports.spindle.read_angle() is None
    plain.close()
    bench = CanBench(can_machine(("spindle = { id = 3 }", "spindle = { id = 3, counts_per_rev = 4096 }")))
    spindle = bench.machine.ports.spindle
    spindle.set_speed(600.0)
    bench.run(3.0)
    angle = spindle.read_angle()
    assert angle is not None
    assert angle[1] == pytest.approx(bench.peers.machine.spindle_turns(), abs=0.2)  # a round of the bus
    bench.close()


def test_spindle_angle_continues_when_the_drive_counter_wraps() -> None:
    bench = CanBench(can_machine(("spindle = { id = 3 }", "spindle = { id = 3, counts_per_rev = 4096 }")))
    spindle, drive = bench.machine.ports.spindle, bench.machine.spindle
    assert drive is not None
    turns = []
    for position in (2**31 - 4096, -(2**31), -(2**31) + 4096, 2**31 - 4096):
        drive.drive.position = position
        angle = spindle.read_angle()
        assert angle is not None
        turns.append(angle[1])
    assert [now - turns[0] for now in turns] == [0.0, 1.0, 2.0, 0.0]
    bench.close()


def test_spindle_on_an_inverter_has_no_canopen_drive() -> None:
    inverter = 'vfd = { family = "delta-vfdb", port = "/dev/null", hz_per_rpm = 0.01667 }'
    bench = CanBench(
        can_machine(('driver = "cia402"', f'driver = "vfd"\n{inverter}'), ("spindle = { id = 3 }", ""))
    )
    spindle = bench.machine.ports.spindle
    with raises_code(DriverError, "spindle-off") as told:
        spindle.set_speed(100.0)
    assert told.value.reason == "no-drive"
    spindle.set_speed(0.0)
    assert spindle.speed() == 0.0
    bench.close()
