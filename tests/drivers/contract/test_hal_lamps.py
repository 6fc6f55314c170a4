"""The signal tower on HAL: an open E-stop chain leaves its lamps to the control, a silent bridge does not."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.executor.snapshot import MachineState
from core.ports import DriverError
from tests.coded import raises_code
from tests.drivers.contract.control import Control
from tests.drivers.contract.hal import Hal

CUT = "G90G94F300\nM08\nX.1\nG01F30Z-2\nM30\n"


def tower(control: Control) -> set[str]:
    """What is really lit, at the machine."""
    return {name[5:] for name, on in control.world.outputs().items() if on and name.startswith("lamp_")}


@pytest.fixture(params=["true", "false"], ids=["red safe on", "red safe off"])
def safe_red(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def control(safe_red: str) -> Iterator[Control]:
    lamps = f'lamp_red = {{ at = "out-red", safe = {safe_red} }}\n'
    lamps += "".join(
        f'lamp_{name} = {{ at = "out-{name}", safe = false }}\n' for name in ("amber", "green", "buzzer")
    )
    rig = Hal(lamps=lamps)
    yield Control(rig)
    rig.close()


def lit_steadily(control: Control, seconds: float, lamps: set[str]) -> None:
    end = control.clock.now() + seconds
    while control.clock.now() < end:
        control.tick()
        assert tower(control) == lamps


def test_red_lamp_is_lit_while_the_estop_chain_is_open(control: Control) -> None:
    control.start(CUT)
    control.run(0.5)
    assert tower(control) == {"green"}
    control.rig.slides.press_estop()
    control.until(MachineState.ESTOP)
    control.run(0.1)
    lit_steadily(control, 2.5, {"red"})
    assert "coolant" not in {name for name, on in control.world.outputs().items() if on}
    control.rig.slides.release_estop()
    control.ready()
    control.run(0.1)
    assert tower(control) == set()
    assert not [text for text in control.said("disturbed") if "LAMP" in text]


def test_no_lamp_is_lit_or_reported_before_the_first_reset(control: Control) -> None:
    control.run(0.5)
    lit_steadily(control, 1.5, set())
    assert control.said("disturbed") == []


def test_red_lamp_blinks_for_a_drive_alarm_that_opens_the_chain(control: Control) -> None:
    control.start(CUT)
    control.run(0.5)
    control.rig.slides.drive_fault("X")
    control.until(MachineState.FAULT)
    control.run(1.5)
    seen = []
    for _ in range(100):
        control.tick()
        seen.append("red" in tower(control))
    assert 40 <= sum(seen) <= 60  # half a second on, half a second off


def test_any_other_output_is_refused_while_the_chain_is_open(control: Control) -> None:
    control.ready()
    control.rig.slides.press_estop()
    control.run(0.1)
    with raises_code(DriverError, "output", "coolant", "E-stop"):
        control.rig.ports.io.write("coolant", True)


def test_a_silent_bridge_leaves_no_green_lamp(control: Control, safe_red: str) -> None:
    """HAL's own watchdog: nobody lives who could light or put out anything."""
    control.start(CUT)
    control.run(0.5)
    assert tower(control) == {"green"}
    assert isinstance(control.rig, Hal)
    control.rig.far.is_bridge_suspended = True
    control.rig.alone(0.4)
    assert tower(control) == ({"red"} if safe_red == "true" else set())
