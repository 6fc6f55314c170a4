"""Every fault of every driver under the executor: what an operator sees, from the alarm to the next part."""

from __future__ import annotations

import math
import re

import pytest

from core.alarms.bus_alarms import CONNECTION_LOSS_CODES
from core.executor.commands import EnableDrives, Reset
from core.executor.snapshot import MachineState
from core.ports import UnknownPart
from tests.drivers.contract.conftest import Broken
from tests.drivers.contract.control import Control
from tests.drivers.contract.rig import STILL, Fault
from tests.texts import pattern, text

OVER = "G90G94F300\nM03S600\nM08\nX0Z0\nG01F300\n" + "X3Z-.2\nX0Z0\n" * 2 + "M30\n"
SHORT = "G90G94F300\nM03S600\nX.1\nG01F100X0\nM30\n"


def cutting(control: Control) -> None:
    """At 300 in/min, spindle and coolant on."""
    control.start(OVER)
    control.until_true(lambda shot: shot.velocity > 125.0)
    control.run(0.3)
    assert control.state is MachineState.RUN
    assert control.world.outputs()["coolant"]


def all_off(control: Control, outcome: Fault) -> None:
    """Spindle and coolant, as far as anything can still be said to them."""
    if outcome.spins:
        control.run(3.0)
        assert abs(control.world.rpm()) > 100.0
    else:
        control.until_true(lambda _: control.world.rpm() == 0.0, limit=4.0)
    assert control.world.outputs()["coolant"] is (outcome.flows != "")
    assert control.shot.rpm_command == 0.0
    if not outcome.unknown:  # of a wire that is gone the last that was known is told
        assert "coolant" not in control.shot.outputs
    codes = [alarm.code for alarm in control.shot.alarms]
    assert len(codes) == len(set(codes))  # each told once
    assert "internal" not in codes
    if codes[0] in CONNECTION_LOSS_CODES:  # one cause, one alarm, which asks for the E-stop
        assert len(codes) == 1
        assert control.shot.alarms[0].remedy.startswith(text("executor.press-estop"))


def test_fault_stops_all_and_only_the_operator_can_resume(broken: Broken) -> None:
    rig, fault = broken
    outcome = rig.faults[fault]
    control = Control(rig)
    cutting(control)
    struck = control.clock.now()
    rig.acts()[fault]()
    control.until(MachineState.FAULT, limit=outcome.told + 0.01)
    control.rest(max(outcome.rests + struck - control.clock.now(), 0.0))
    control.run(0.1)
    assert control.shot.unknown == outcome.unknown
    alarm = control.shot.alarms[0]
    assert alarm.code == outcome.code
    assert outcome.names in alarm.detail + alarm.remedy
    all_off(control, outcome)
    stood, powered = control.world.place(), rig.ports.axes.sample().enabled
    control.press()
    rig.mend()
    control.run(rig.heals)
    assert control.state is MachineState.FAULT
    control.post(Reset())
    # an inverter's fault leaves the drives their power: they hold the slides
    on = MachineState.IDLE if powered else MachineState.DISABLED
    control.until(on, limit=2.0)
    control.until_true(lambda shot: control.world.rpm() == 0.0 and not shot.unknown, limit=2.0)
    control.run(0.5)
    assert math.dist(control.world.place(), stood) < STILL
    assert control.shot.alarms == ()
    parts = control.shot.parts
    control.start(SHORT)
    if outcome.homeless:
        assert re.fullmatch(pattern("executor.not-homed"), control.shot.start_refusal_reason)
        return
    control.until(MachineState.IDLE, limit=20.0)
    assert control.shot.parts == parts + 1


def test_reset_with_a_persistent_connection_fault_enables_nothing(broken: Broken) -> None:
    """Whatever it tries: no power, no motion, and what is not heard stays unknown."""
    rig, fault = broken
    outcome = rig.faults[fault]
    if not outcome.unknown:
        pytest.skip("everything is heard all the while")
    control = Control(rig)
    cutting(control)
    rig.acts()[fault]()
    control.until(MachineState.FAULT, limit=outcome.told + 0.01)
    control.run(outcome.rests + 1.0)
    stood = control.world.place()
    control.post(Reset())
    for _ in range(150):
        control.tick()
        assert control.shot.rpm_command == 0.0
        if control.shot.unknown:
            control.post(EnableDrives())
            assert control.state in {MachineState.FAULT, MachineState.DISABLED, MachineState.IDLE}
            assert not (control.state is MachineState.IDLE and UnknownPart.AXES in control.shot.unknown)
    assert math.dist(control.world.place(), stood) < STILL
    assert bool(control.shot.unknown) is (control.state is MachineState.FAULT)
