"""What the control makes of a lost pendant, a start inhibit, a button that holds a jog, and a load."""

from __future__ import annotations

import dataclasses

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import CycleStart, Jog, SelectHandwheel
from core.executor.snapshot import MachineState
from core.machine.hardware_model import AnalogInputModel
from core.machine.machine_model import InputModel, Machine
from core.ports import StationState
from tests.executor.rig import Rig
from tests.texts import text

AWAY = "the pendant Knob is not plugged in"
CUT = "G90G94F300\nG71G72\nG01Z-50F300\nM30\n"


def wired(*names: str) -> Machine:
    machine = load_machine()
    wheel = AnalogInputModel("handwheel", "wheel", (0.0, 1.0))
    inputs = {name: InputModel(name, f"test {name}") for name in names}
    hardware = dataclasses.replace(machine.hardware, analog_inputs={"handwheel": wheel})
    return dataclasses.replace(machine, inputs={**machine.inputs, **inputs}, hardware=hardware)


class PendantRig(Rig):
    """Its station has a pendant beside it, of which ``pendant`` is told."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.pendant: dict[str, object] = {}
        station = self.sim.ports.station
        plain = station.read_state

        def snapshot() -> StationState:
            return dataclasses.replace(plain(), **self.pendant)  # type: ignore[arg-type]

        station.read_state = snapshot  # type: ignore[method-assign]

    def cutting(self) -> None:
        self.start(CUT)
        self.until_true(lambda shot: shot.velocity > 1.0)


def ready(*names: str) -> PendantRig:
    rig = PendantRig(wired(*names))
    rig.ready()
    return rig


def test_a_pendant_that_is_lost_holds_the_cycle_and_starts_nothing() -> None:
    rig = ready()
    rig.cutting()
    rig.pendant = {"trouble": AWAY, "wheel_trouble": AWAY}
    rig.until(MachineState.HOLD, limit=1.0)
    assert rig.shot.stop is not None
    assert (rig.shot.stop.number, rig.shot.stop.cause) == (605, AWAY.lower())
    assert rig.said("disturbed") == [AWAY.upper()]
    rig.run(0.5)  # another press is no bounce of the last
    rig.post(CycleStart())
    rig.run(0.1)
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason == AWAY
    rig.pendant = {}
    rig.run(0.5)
    assert rig.said("disturbed")[-1] == "THE PENDANT IS CONNECTED AGAIN"
    assert rig.state is MachineState.HOLD  # nothing goes on by itself
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)


def test_key_jog_stops_once_when_the_pendant_is_lost_and_can_restart() -> None:
    rig = ready()
    rig.post(Jog("X", 5.0, 0.25))
    rig.run(0.1)
    rig.pendant = {"trouble": AWAY}
    rig.run(0.2)
    assert rig.state is MachineState.IDLE
    rig.post(Jog("X", 5.0, 0.25))
    rig.run(0.1)
    assert rig.state is MachineState.JOG


def test_handwheel_of_a_lost_pendant_returns_only_on_new_selection() -> None:
    rig = ready()
    wheel = SelectHandwheel("X", 0.0254, 0.25)
    rig.post(wheel)
    rig.run(0.15)
    assert rig.shot.wheel == "X"
    rig.pendant = {"wheel_trouble": AWAY}
    rig.post(wheel)
    assert rig.shot.wheel == ""
    assert AWAY in rig.shot.wheel_ended
    rig.pendant = {}
    rig.post(wheel)
    rig.run(0.05)
    assert rig.shot.wheel == ""


def test_start_inhibit_blocks_every_start_and_resume() -> None:
    rig = ready("start_inhibit")
    rig.cutting()
    rig.sim.machine.press_hold()
    rig.until(MachineState.HOLD)
    rig.sim.machine.release_hold()
    rig.sim.machine.set_input("start_inhibit", True)
    rig.run(0.5)
    rig.post(CycleStart())
    rig.run(0.1)
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason == text("executor.inhibit-switch")
    rig.sim.machine.set_input("start_inhibit", False)
    rig.run(0.5)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)


@pytest.mark.parametrize("name", ["jog_x_plus", "wheel_enable"])
def test_jog_ends_when_its_button_or_enabling_switch_is_released(name: str) -> None:
    """Though the screen goes on asking: it has not seen it, or stands still."""
    rig = ready("jog_x_plus", "wheel_enable")
    for each in ("jog_x_plus", "wheel_enable"):
        rig.sim.machine.set_input(each, True)
    rig.tick()
    jog = Jog("X", 5.0, 0.25, "jog_x_plus")
    rig.post(jog)
    rig.run(0.1)
    assert rig.state is MachineState.JOG
    rig.sim.machine.set_input(name, False)
    rig.tick()
    at = rig.shot.actual[0]
    for _ in range(30):
        rig.post(jog)
    assert rig.state is MachineState.IDLE
    assert rig.shot.actual[0] - at < 5.0 * 0.05  # what is committed, and the ramp
    assert rig.said("refused") == []


def test_jog_ends_on_button_release_when_the_screen_hangs() -> None:
    """Nobody posts any more: the lease would go on for a quarter of a second."""
    rig = ready("jog_x_plus")
    rig.sim.machine.set_input("jog_x_plus", True)
    rig.tick()
    rig.post(Jog("X", 5.0, 0.25, "jog_x_plus"))
    rig.sim.machine.set_input("jog_x_plus", False)
    rig.run(0.1)
    assert rig.state is MachineState.IDLE


def test_jog_with_a_released_button_never_starts() -> None:
    rig = ready("jog_x_plus")
    rig.post(Jog("X", 5.0, 0.25, "jog_x_plus"))
    rig.run(0.2)
    assert rig.state is MachineState.IDLE
    assert rig.shot.demand[0] == 0.0


def test_spindle_load_is_reported() -> None:
    rig = ready()
    assert rig.shot.spindle_load is None
    rig.pendant = {"spindle_load": 43.5}
    rig.tick()
    assert rig.shot.spindle_load == 43.5
