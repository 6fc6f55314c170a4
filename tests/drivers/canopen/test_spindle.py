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


def test_power_comes_with_the_command_and_goes_at_standstill(bench: CanBench) -> None:
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


def test_a_command_during_estop_is_an_alarm_and_not_a_start_at_its_release(bench: CanBench) -> None:
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


def test_a_blocked_motor_is_told_and_the_spindle_runs_down(bench: CanBench) -> None:
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


def test_speed_is_limited_to_the_machines(bench: CanBench) -> None:
    bench.machine.ports.spindle.set_speed(-99999.0)
    bench.run(4.0)
    assert bench.machine.ports.spindle.speed() == -3500.0


def test_an_angle_only_where_counts_a_turn_are_known() -> None:
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


def test_the_angle_goes_on_when_the_drives_counter_goes_round() -> None:
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


def test_without_a_drive_on_the_bus_there_is_nothing_to_turn() -> None:
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
