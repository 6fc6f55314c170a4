"""A guard that is opened in a cycle, at every driver: all stops, and closing it starts nothing."""

from __future__ import annotations

import pytest

from core.executor.snapshot import MachineState
from tests.drivers.contract.control import Control
from tests.drivers.contract.rigs import make

CUT = "G90G94F300\nM03S1000\nX.5Z.2\nG01F10Z-2.\nM30\n"


@pytest.mark.parametrize("name", ["simulated", "fed", "fed canopen", "fed csp", "grblhal", "hal", "delta"])
def test_opened_guard_stops_axes_and_spindle_and_closing_starts_nothing(name: str) -> None:
    rig = make(name)
    assert rig.machine.interlocks.guard_stops
    control = Control(rig)
    control.start(CUT)
    control.until_true(lambda shot: shot.line == 4 and shot.velocity > 0.0 and control.world.rpm() > 900.0)
    control.world.set_input("guard", False)
    control.until(MachineState.HOLD, MachineState.FAULT, limit=0.5)
    control.rest(1.0)
    control.until_true(lambda _: control.world.rpm() == 0.0, limit=4.0)
    control.world.set_input("guard", True)
    assert control.nothing_moves()
    assert control.state in {MachineState.HOLD, MachineState.FAULT}
    rig.close()


def test_no_cycle_starts_at_a_controller_whose_guard_is_open() -> None:
    rig = make("grblhal")
    control = Control(rig)
    control.ready()
    control.load(CUT)
    control.world.set_input("guard", False)
    control.press()
    assert control.nothing_moves()
    assert control.state is not MachineState.RUN
