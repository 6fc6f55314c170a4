"""Home on controllers with and without switches: whose word counts, and what is told."""

from __future__ import annotations

import re

import pytest

from core.block_ports import LineOperation
from core.executor.commands import HomeAxes
from core.executor.snapshot import MachineState
from core.ports import DriverError
from tests.coded import raises_code
from tests.drivers.grblhal.bench import GrblBench, grbl_machine, quirky
from tests.drivers.grblhal.test_faults import UNHOMED
from tests.texts import text

HERE = tuple((old, new.replace("speed = 60", "speed = 60, method = 37")) for old, new in UNHOMED)


def test_home_at_the_present_position_needs_no_switch_and_no_motion() -> None:
    bench = GrblBench(grbl_machine(*HERE))
    assert not [told for told in bench.machine.ports.warnings if "$22" in told]
    bench.machine.axes.enable(True)
    bench.alone(0.3)
    bench.machine.block_controller.submit_block(LineOperation(3.0, -7.0, 40.0))
    bench.alone(1.0)
    assert not any(bench.machine.axes.sample().homed[:2])
    bench.ready()
    bench.post(HomeAxes())
    bench.until(MachineState.IDLE, limit=5.0)
    assert all(bench.shot.homed)
    assert bench.peer.motion.position == pytest.approx((3.0, -7.0))
    assert bench.shot.actual[:2] == pytest.approx((0.0, 0.0))
    assert not [line for line in bench.wire.lines() if line.startswith("$H")]
    bench.start("G90G94F300\nX.1Z.2\nM30\n")
    bench.until(MachineState.IDLE)
    assert bench.shot.actual[:2] == pytest.approx((2.54, 5.08))
    assert bench.peer.motion.position == pytest.approx((5.54, -1.92))


def test_controller_without_homing_is_reported_with_a_remedy() -> None:
    bench = GrblBench(grbl_machine(*UNHOMED))
    (told,) = [told for told in bench.machine.ports.warnings if "$22" in told]
    assert re.search(r"\bX\b.*\bZ\b", told)
    assert "method = 37" in told


def test_absolute_axis_is_accepted_as_homed_without_homing() -> None:
    bench = GrblBench()
    bench.ready()
    bench.post(HomeAxes())
    bench.until(MachineState.IDLE, limit=5.0)
    assert not bench.shot.alarms
    assert not [line for line in bench.wire.lines() if line.startswith("$H")]


def test_axis_homed_by_the_controller_is_homed_for_the_next_host() -> None:
    bench = GrblBench(grbl_machine(*UNHOMED), quirky(homing=3))
    bench.ready()
    bench.post(HomeAxes())
    bench.until(MachineState.IDLE, limit=10.0)
    bench.peer.motion.position = (5.0, -5.0)
    again = GrblBench.__new__(GrblBench)
    again.__dict__.update(bench.__dict__)
    machine = type(bench.machine)(bench.machine.controller.config, bench.clock, bench.wire)
    assert machine.axes.sample().homed[:2] == (True, True)


def test_single_axis_homing_homes_all_if_controller_homes_only_together() -> None:
    bench = GrblBench(grbl_machine(*UNHOMED), quirky(homing=1))
    bench.ready()
    bench.post(HomeAxes())
    bench.until(MachineState.IDLE, limit=10.0)
    assert all(bench.shot.homed)
    assert [line for line in bench.wire.lines() if line.startswith("$H")] == ["$H"]


def test_controller_that_requires_homing_is_locked_until_last_axis_is_home() -> None:
    bench = GrblBench(grbl_machine(*UNHOMED), quirky(homing=7))
    bench.machine.axes.enable(True)
    bench.alone(0.3)
    bench.machine.axes.home("Z")
    bench.alone(1.5)
    assert bench.machine.axes.sample().homed[:2] == (False, True)
    with raises_code(DriverError, "controller-refuses", text("drivers.grblhal-home-first")):
        bench.machine.block_controller.submit_block(LineOperation(1.0, 0.0, 10.0))
    bench.machine.axes.home("X")
    bench.alone(1.5)
    assert bench.machine.axes.sample().homed[:2] == (True, True)
    assert bench.machine.block_controller.submit_block(LineOperation(1.0, 0.0, 10.0)) is not None
