"""What comes late or more than once, drivers that fall silent or fail while TurnDesk closes."""

from __future__ import annotations

from typing import Any

import pytest

from core.executor.commands import CycleStart, DeselectHandwheel, FeedHold, Reset, StopJog
from core.executor.snapshot import MachineState
from core.ports import DriverError, UnknownPart
from tests.executor.model_machine import Machine
from tests.executor.rig import Rig

CUT = "G90G94F20\nG01Z-3.F20\nM30\n"
SPIN_UP = "G90G94F300\nM03S1500\nX.5Z.1\nM05\nM30\n"


def codes(rig: Rig) -> list[str]:
    """The alarms that stand."""
    return [alarm.code for alarm in rig.shot.alarms]


def begun(text: str) -> Machine:
    """A machine with breakable ports in a cycle of this program."""
    machine = Machine()
    machine.ready()
    machine.load(text)
    machine.run(0.3)
    machine.pressed = True
    machine.post(CycleStart())
    return machine


@pytest.mark.parametrize("times", [2, 3, 10])
def test_repeated_reset_during_spindle_acceleration_raises_no_alarm(times: int) -> None:
    rig = Rig()
    rig.start(SPIN_UP)
    rig.tick()
    for _ in range(times):
        rig.post(Reset())
    rig.run(5.0)
    assert codes(rig) == []
    assert rig.state is MachineState.IDLE


def test_repeated_stops_do_not_extend_the_spindle_stop_time() -> None:
    machine = begun("G90G94F300\nM03S1500\nG04F9.\nM05\nM30\n")
    machine.run(4.0)
    machine.harmed = True
    machine.freeze("spindle")  # it goes on as if nobody had told it anything
    machine.frozen_since.clear()
    for _ in range(200):
        machine.post(Reset())
    assert codes(machine) == ["ignores-stop"]


@pytest.mark.parametrize("release", [StopJog(), DeselectHandwheel()])
def test_repeated_jog_release_in_a_cut_has_no_effect(release: Any) -> None:
    rig = Rig()
    rig.start(CUT)
    rig.run(0.5)
    rig.post(release, release)
    rig.run(0.2)
    assert (rig.state, codes(rig)) == (MachineState.RUN, [])


def test_cycle_start_pressed_while_the_host_was_away_is_rejected() -> None:
    machine = Machine()
    machine.ready()
    machine.load(CUT)
    machine.harmed = True
    machine.broken["io"].stalls["inputs"] = 0.5  # s in which the computer stands still inside a tick
    machine.tick()
    machine.sim.machine.press_start()
    machine.tick()
    assert machine.state is MachineState.IDLE
    assert len(machine.said("refused")) == 1


def test_silent_axes_are_not_ready() -> None:
    machine = Machine()
    machine.ready()
    machine.harmed = True
    machine.freeze("axes")
    machine.run(0.6)
    assert (machine.state, codes(machine)) == (MachineState.FAULT, ["drive-silent"])


def test_silent_axes_stop_without_a_driver_fault() -> None:
    machine = begun(CUT)
    machine.run(0.5)
    machine.harmed = True
    machine.freeze("axes")
    machine.run(0.6)
    assert machine.state is MachineState.FAULT
    assert codes(machine) == ["drive-silent"]
    assert UnknownPart.AXES in machine.shot.unknown


@pytest.mark.parametrize("times", [1, 50])
def test_drives_that_reject_braking_lose_power_when_turndesk_closes(times: int) -> None:
    machine = begun(CUT)
    machine.run(0.5)
    machine.broken["axes"].breaks["stop"] = (DriverError("the wire is out"), times)
    machine.executor.shut_down()
    machine.clock.advance(1.0)  # the drives brake by themselves
    assert not machine.true_ports.axes.sample().enabled


def test_encoder_frozen_at_hold_end_is_detected_on_the_next_move() -> None:
    """Until then a slide that stands and an encoder that stands tell the same."""
    rig = Rig(every=0.01)
    rig.start(CUT)
    rig.run(1.0)
    rig.post(FeedHold())
    rig.run(0.3)
    assert rig.state is MachineState.HOLD
    rig.sim.machine.encoder_stuck("Z")
    rig.run(2.0)
    begins = rig.sim.machine.get_true_positions()[1]
    rig.post(CycleStart())
    took = rig.until(MachineState.FAULT, limit=1.0)
    assert codes(rig) == ["encoder-still"]
    assert took <= 0.12
    rig.run(1.0)
    assert abs(rig.sim.machine.get_true_positions()[1] - begins) < 4.0  # mm, at 8.5 mm/s
