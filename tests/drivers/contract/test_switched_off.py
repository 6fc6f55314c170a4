"""Spindle and outputs that somebody else has switched: nothing is fed, a start says what it switches on."""

from __future__ import annotations

import math
import re

import pytest

from core.executor.commands import CycleStart
from core.executor.snapshot import MachineState
from tests.drivers.contract.can import FedCanopen
from tests.drivers.contract.conftest import need
from tests.drivers.contract.control import INCH, Control
from tests.drivers.contract.rig import STILL, TICK
from tests.drivers.contract.simulated import Fed
from tests.texts import pattern, text

CUT = "G90G94F300\nM03S600\nM08\nX.1\nG01F30Z-2\nM30\n"
DWELL = "G90G94F300\nM03S600\nM08\nX.1\nG04F3\nG01F60X.5\nM30\n"
STOP = "G90G94F300\nM03S600\nM08\nX.1\nG01F60X.2\nM00\nG01X.5\nM30\n"
SILENT = 0.5


def on(control: Control) -> set[str]:
    return {name for name, lit in control.world.outputs().items() if lit}


def away(control: Control, seconds: float) -> None:
    """The control stands still, the machine does not."""
    for _ in range(round(seconds / TICK)):
        control.rig.alone(TICK)


def in_the_cut(control: Control) -> None:
    control.start(CUT)
    control.until_true(lambda _: control.world.place()[1] < -8.0)
    assert "coolant" in on(control)


def test_output_that_turns_off_during_a_cut_holds_and_is_announced(control: Control) -> None:
    need(control.rig, "outputs told")
    in_the_cut(control)
    control.rig.switch_output("coolant", False)
    struck = control.clock.now()
    control.until(MachineState.HOLD, limit=control.rig.sees_output + control.rig.hold + 0.1)
    assert control.clock.now() - struck < control.rig.sees_output + control.rig.hold + 0.1
    assert text("executor.gone-off", output="COOLANT") in control.shot.waiting_for
    control.run(0.5)
    stood = control.world.place()
    control.run(1.0)
    assert control.world.place() == pytest.approx(stood, abs=STILL)
    assert "coolant" not in on(control)  # and nobody has switched it on again
    assert control.shot.announced == (text("executor.comes-on", output="COOLANT"),)
    control.press()
    control.until(MachineState.RUN, limit=0.5)
    control.run(0.1 if control.rig.blocks is None else 1.0)  # a controller does it behind the blocks it has
    assert "coolant" in on(control)
    control.until(MachineState.IDLE)
    assert control.shot.alarms == ()
    assert control.shot.parts == 0
    (why,) = control.said("uncounted")
    gone = text("executor.gone-off", output="COOLANT").lower()
    assert why.startswith(text("executor.cycle-disturbed", why=gone))


def test_output_that_turns_on_unexpectedly_causes_hold(control: Control) -> None:
    need(control.rig, "outputs told")
    control.start(CUT.replace("M08\n", ""))
    control.until_true(lambda _: control.world.place()[1] < -8.0)
    if control.rig.blocks is not None:
        pytest.skip("what was never switched is not looked for in a controller's reports")
    control.rig.switch_output("coolant", True)
    control.until(MachineState.HOLD, limit=control.rig.sees_output + control.rig.hold + 0.1)
    assert control.shot.announced == (text("executor.goes-off", output="COOLANT"),)
    control.press()
    control.run(0.3)
    assert "coolant" not in on(control)


def test_spindle_failure_during_feed_per_minute_causes_hold(control: Control) -> None:
    in_the_cut(control)
    control.world.spindle_dies()
    control.until(MachineState.HOLD, MachineState.FAULT, limit=6.0)
    control.run(1.0)
    stood = control.world.place()
    control.press()
    control.run(1.0)
    assert control.world.place() == pytest.approx(stood, abs=STILL)


@pytest.mark.parametrize("program", [DWELL, STOP], ids=["dwell", "stop"])
def test_control_pause_at_standstill_is_announced_if_outputs_turned_off(
    control: Control, program: str
) -> None:
    """Where something switches off meanwhile it is declared and announced; else all is as it was."""
    control.start(program)
    control.until_true(lambda shot: shot.waiting_for == "DWELL" or shot.state is MachineState.PROGRAM_STOP)
    control.until_true(lambda _: control.world.rpm() > 590.0)
    state, place = control.state, control.world.place()
    away(control, SILENT)
    control.run(0.1)
    assert control.world.place() == pytest.approx(place, abs=STILL)
    if not control.rig.watched:
        assert control.state is state
        assert "coolant" in on(control)
        assert control.world.rpm() == pytest.approx(600.0, rel=0.1)
        return
    (said,) = control.said("disturbed")
    assert said == text("executor.control-trip", seconds=0.5, names="SPINDLE, COOLANT")
    assert control.state is (MachineState.HOLD if state is MachineState.WAIT else state)
    assert on(control) == {"collet"}
    assert set(control.shot.announced) == {
        text("executor.spindle-starts", rpm=600, direction="FORWARD"),
        text("executor.comes-on", output="COOLANT"),
    }
    control.post(CycleStart())
    control.world.press_start()
    control.run(0.1)
    assert control.state in {
        MachineState.HOLD,
        MachineState.PROGRAM_STOP,
    }  # nobody has had the time to read it
    assert re.fullmatch(pattern("executor.look-first"), control.shot.start_refusal_reason)
    control.run(2.0)
    assert on(control) == {"collet"}
    assert control.world.rpm() == 0.0
    control.press()
    least = math.inf
    while control.state not in {MachineState.IDLE, MachineState.FAULT}:
        before = control.world.place()
        control.tick()
        if math.dist(control.world.place(), before) > STILL and control.world.place()[0] > place[0] + 0.1:
            least = min(least, abs(control.world.rpm()))
            if control.state is MachineState.RUN and control.world.place()[0] < 11.0:
                assert "coolant" in on(control)
    assert least > 500.0  # not fed before the spindle was at its speed again
    assert control.shot.alarms == ()
    assert control.shot.parts == 0
    assert re.match(pattern("executor.cycle-disturbed"), control.said("uncounted")[0])


def test_stall_longer_than_the_queue_in_a_cut_resumes_with_cycle_start(control: Control) -> None:
    in_the_cut(control)
    away(control, 5.0)
    control.run(1.0)
    assert control.state is MachineState.HOLD
    assert ("coolant" in on(control)) is not control.rig.watched
    control.run(1.5)
    control.press()
    control.until(MachineState.RUN, limit=6.0)
    assert control.world.rpm() == pytest.approx(600.0, rel=0.1)
    assert "coolant" in on(control)
    control.until(MachineState.IDLE)
    assert control.shot.alarms == ()
    assert control.world.place()[1] == pytest.approx(-2.0 * INCH, abs=0.01)
    assert control.shot.parts == (0 if control.rig.watched else 1)


@pytest.mark.parametrize("program", [DWELL, CUT], ids=["dwell", "cut"])
@pytest.mark.parametrize("kind", [Fed, FedCanopen])
@pytest.mark.parametrize("seconds", [0.3, 1.0])
def test_outputs_switched_off_in_a_driver_host_stall_stay_off(
    kind: type[Fed | FedCanopen], program: str, seconds: float
) -> None:
    rig = kind()
    control = Control(rig)
    control.start(program)
    control.until_true(lambda shot: shot.waiting_for == "DWELL" or control.world.place()[1] < -8.0)
    control.until_true(lambda _: control.world.rpm() > 590.0)
    rig.host_stands(seconds)
    for _ in range(200):
        control.tick()
        assert on(control) == {"collet"}  # not even for a moment
    assert control.state in {MachineState.HOLD, MachineState.FAULT}
    assert control.state is (
        MachineState.FAULT if kind is FedCanopen else MachineState.HOLD
    )  # drives on a bus run dry
    stood = control.world.place()
    control.run(0.5)
    assert control.world.place() == pytest.approx(stood, abs=STILL)
    if control.state is MachineState.HOLD:
        assert text("executor.comes-on", output="COOLANT") in control.shot.announced
        control.press()
        control.run(1.5)
        assert "coolant" in on(control)
    rig.close()


def test_stall_between_polling_and_setpoints_moves_nothing(
    control: Control, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Frozen between the look and the setpoints: the driver host refuses them until the control knows."""
    if not control.rig.watched:
        pytest.skip("nothing switches off by itself")
    control.start("G90G94F300\nM03S600\nM08\nX.1\nG04F1\nG01F60X.5\nM30\n")
    control.until_true(lambda shot: shot.waiting_for == "DWELL")
    control.run(0.9)
    place = control.world.place()
    look = control.executor._look

    def frozen() -> None:
        look()
        away(control, SILENT)

    with monkeypatch.context() as stalled:
        stalled.setattr(control.executor, "_look", frozen)
        control.run(0.2)
    control.run(1.0)
    assert control.world.place() == pytest.approx(place, abs=STILL)
    assert control.state is MachineState.HOLD
    assert control.shot.alarms == ()
