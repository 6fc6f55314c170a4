"""A line that takes 150 ms for an answer: the executor blames neither the inverter nor its silence for it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.executor.snapshot import MachineState
from tests.drivers.contract.control import Control
from tests.drivers.contract.inverters import DeltaVfdB

SLOW = 0.15  # s an answer
LOOK = 5 * SLOW  # s: a look at a Delta is five registers
CHANGES = "G90G94F300\n" + "".join(
    f"M03S{rpm}\nG04F{wait}\n" for wait in (1.1, 1.4, 1.7) for rpm in (3000, 400, 2500, 900)
)


@pytest.fixture
def slow() -> Iterator[Control]:
    """The executor on a lathe whose Delta answers late."""
    rig = DeltaVfdB()
    rig.wire.delay = SLOW
    control = Control(rig)
    control.run(3.0)
    yield control
    rig.close()


@pytest.mark.parametrize("late", [0.0, 0.2, 0.4, 0.6, 0.8])
def test_changing_speeds_on_a_slow_line_cause_no_fault(slow: Control, late: float) -> None:
    slow.run(late)  # the commands come at any moment of an exchange
    slow.start(CHANGES + "M05\nG04F2\nM04S2000\nG04F2\nM05\nG04F4\nM30\n")
    slow.until(MachineState.IDLE, MachineState.FAULT, limit=90.0)
    assert [alarm.code for alarm in slow.shot.alarms] == []
    assert slow.world.rpm() == 0.0


def test_slow_line_is_neither_silent_nor_unknown(slow: Control) -> None:
    spindle, unknown = slow.rig.ports.spindle, slow.rig.ports.unknown
    for n in range(40):  # each stop breaks a look off
        spindle.set_speed(0.0 if n % 2 else 1500.0)
        for _ in range(45):
            slow.rig.tick()
            assert (spindle.read_fault(), unknown()) == ("", frozenset())


def test_ignored_stop_on_a_slow_line_is_reported(slow: Control) -> None:
    slow.start("G90G94F300\nM03S2000\nG04F5\nM05\nG04F9\nM30\n")
    slow.run(4.0)
    slow.world.spindle_ignores_stop()
    slow.until_true(lambda shot: shot.rpm_command == 0.0)
    took = slow.until(MachineState.FAULT, limit=6.0)
    assert slow.shot.alarms[0].code == "ignores-stop"
    assert took < 1.0 + 3 * LOOK


def test_a_slow_line_that_falls_silent_is_reported_in_two_seconds(slow: Control) -> None:
    slow.start("G90G94F300\nM03S2000\nG04F9\nM30\n")
    slow.run(4.0)
    slow.rig.acts()["silence"]()
    assert slow.until(MachineState.FAULT, limit=3.0) <= 2.2
    assert slow.shot.alarms[0].code == "inverter-silent"
