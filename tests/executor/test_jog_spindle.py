"""A jog with a turning spindle: what stops the spindle ends the jog, and a key still held begins no other."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from core.executor.commands import Jog, StopJog, StopSpindle
from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from tests.executor.lines import mdi
from tests.executor.rig import Rig
from tests.texts import pattern

SPEED, LEASE = 2.0, 0.2  # mm/s, s


def turning(machine: Machine | None = None) -> Rig:
    """The spindle turns at 900 rpm, by a line of MDI, and Z is jogged."""
    rig = Rig(machine) if machine is not None else Rig()
    mdi(rig, "M03S900")
    rig.run(2.0)
    assert rig.shot.rpm_actual == pytest.approx(900, rel=0.05)
    held(rig, 0.3)
    assert rig.state is MachineState.JOG
    return rig


def held(rig: Rig, seconds: float) -> None:
    """So long a key is held: its lease is renewed every 50 ms, whatever the machine does."""
    end = rig.clock.now() + seconds
    while rig.clock.now() < end - 1e-9:
        rig.post(Jog("Z", -SPEED, LEASE))
        rig.run(0.04)


def switch_off(rig: Rig) -> None:
    rig.sim.machine.set_spindle_auto(False)


def pot_to_nought(rig: Rig) -> None:
    rig.sim.machine.set_spindle_pot(0.0)


def stopped_by_hand(rig: Rig) -> None:
    rig.post(StopSpindle())


@pytest.mark.parametrize("stops", [switch_off, pot_to_nought, stopped_by_hand])
def test_spindle_stop_ends_the_jog_and_held_down_key_starts_no_other(
    stops: Callable[[Rig], None],
) -> None:
    rig = turning()
    stops(rig)
    at = rig.shot.demand[1]
    held(rig, 1.0)
    assert rig.state is MachineState.IDLE
    assert at - rig.shot.demand[1] < SPEED * 0.3  # it braked, and stood
    assert any(re.search(pattern("executor.spindle-has-stopped"), each) for each in rig.said("refused"))
    rig.post(StopJog())  # the key comes up, and is pressed anew: away from the part
    stood = rig.shot.demand[1]
    rig.post(Jog("Z", SPEED, LEASE))
    rig.run(0.1)
    assert rig.shot.demand[1] > stood


def test_an_open_guard_stops_spindle_and_jog() -> None:
    machine = Rig().machine
    machine = replace(machine, interlocks=replace(machine.interlocks, guard_stops=True))
    rig = Rig(machine)
    rig.sim.machine.set_input("guard", True)
    rig.tick()
    mdi(rig, "M03S900")
    rig.run(2.0)
    held(rig, 0.3)
    assert rig.state is MachineState.JOG
    rig.sim.machine.set_input("guard", False)
    held(rig, 0.5)
    assert (rig.state, rig.shot.rpm_command) == (MachineState.IDLE, 0.0)
    rig.sim.machine.set_input("guard", True)
    held(rig, 0.5)
    assert (rig.state, rig.shot.rpm_command) == (MachineState.IDLE, 0.0)  # neither comes on again by itself


def test_stopped_spindle_does_not_affect_a_jog() -> None:
    rig = Rig()
    rig.ready()
    held(rig, 0.5)
    assert rig.state is MachineState.JOG
    switch_off(rig)
    held(rig, 0.5)
    assert rig.state is MachineState.JOG


def test_slower_spindle_does_not_end_the_jog() -> None:
    rig = turning()
    rig.sim.machine.set_spindle_pot(0.4)
    held(rig, 3.0)
    assert rig.state is MachineState.JOG
    assert rig.shot.rpm_actual == pytest.approx(360, rel=0.05)
