"""Acceptance tests of spindle, threads and collet: each on every driver, with its bound."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import pytest

from core.executor.snapshot import MachineState
from core.ports import DriverError
from tests.drivers.contract.can import Canopen
from tests.drivers.contract.control import INCH, Control
from tests.drivers.contract.grbl import Grblhal
from tests.drivers.contract.hal import Hal
from tests.drivers.contract.rig import STILL, Rig
from tests.drivers.contract.simulated import Fed, Simulated
from tests.texts import text

THREAD = "G90G94F300\nM03S600\nX.5Z.2\nX.25\nG33X.2Z-1I.025K.05\nG00Z1\nM30\n"
STILL_G95 = "G90G94F300\nG95F.01Z-1\nM30\n"
THREADING: dict[str, Callable[[], Rig]] = {
    "simulated": Simulated,
    "fed": Fed,
    "canopen": lambda: Canopen(turns=True),
    "grblhal": Grblhal,
    "hal": Hal,
}


def test_feed_per_rev_with_a_stopped_spindle_moves_nothing(control: Control) -> None:
    """Proving refuses it; should a proof ever let it pass, the executor or the controller does."""
    with pytest.raises(AssertionError, match="spindle-stopped"):
        control.load(STILL_G95)
    control.ready()
    control.load(STILL_G95, proved=False)
    control.press()
    assert control.nothing_moves()
    assert control.state is MachineState.FAULT
    assert control.shot.parts == 0


@pytest.mark.parametrize("name", THREADING)
def test_spindle_loss_in_a_thread_retracts_and_starts_no_other_pass(name: str) -> None:
    rig = THREADING[name]()
    control = Control(rig)
    control.start(THREAD)
    groove = -0.2 * INCH
    control.until_true(lambda _: control.world.place()[1] < groove)  # the first pass
    control.until_true(lambda _: control.world.place()[1] > 0.0)
    control.until_true(lambda _: control.world.place()[1] < groove)  # the second
    assert control.world.place()[0] < 0.245 * INCH
    control.world.spindle_dies()
    control.until(MachineState.FAULT, limit=5.0)
    control.rest(1.0)
    assert control.shot.alarms[0].code == "thread-lost"
    x, z = control.world.place()
    assert x == pytest.approx(0.325 * INCH, abs=0.01)  # where its passes come out
    assert -1.0 * INCH < z < -0.2 * INCH
    control.run(3.0)
    assert control.world.place() == pytest.approx((x, z), abs=STILL)
    assert control.world.rpm() == 0.0
    rig.close()


def test_thread_is_refused_before_cutting_without_an_encoder(control: Control) -> None:
    if control.rig.ports.spindle.read_angle() is not None or control.rig.blocks is not None:
        pytest.skip("it has an encoder: its threads are cut, and tried above")
    control.start(THREAD)
    control.until(MachineState.FAULT, MachineState.IDLE, limit=5.0)
    assert "encoder" in control.shot.start_refusal_reason + "".join(a.cause for a in control.shot.alarms)
    assert control.world.place()[1] > 0.2 * INCH - 0.01


def test_collet_stays_closed_until_the_spindle_has_stopped(shipped: Rig) -> None:
    """Where the machine file says so."""
    locks = dataclasses.replace(shipped.machine.interlocks, unclamp_while_turning=False)
    control = Control(shipped, dataclasses.replace(shipped.machine, interlocks=locks))
    control.start("G90G94F300\nM03S1000\nG04F1\nM05\nM13\nM12\nM30\n")
    control.until_true(lambda shot: shot.waiting_for == text("executor.spindle-stop-wait"))
    assert abs(control.world.rpm()) > 300.0
    assert control.world.outputs()["collet"]
    control.until_true(lambda _: not control.world.outputs()["collet"])
    assert abs(control.world.rpm()) < 5.0
    control.until(MachineState.IDLE)


def test_no_spindle_start_with_the_collet_open(control: Control) -> None:
    control.world.open_collet()
    control.run(0.5)
    control.start("G90G94F300\nM03S1000\nG04F1\nM30\n")
    control.until(MachineState.FAULT, limit=3.0)
    assert control.shot.alarms[0].code == "collet-open"
    assert control.nothing_moves()


def test_spindle_that_ignores_its_stop_is_reported_and_asks_for_the_estop(
    control: Control,
) -> None:
    control.start("G90G94F300\nM03S1800\nG04F3\nM05\nG04F9\nM30\n")
    control.until_true(lambda _: control.world.rpm() > 1700.0)
    control.world.spindle_ignores_stop()
    control.until_true(lambda shot: shot.rpm_command == 0.0)
    assert control.until(MachineState.FAULT, limit=3.0) <= 1.7
    alarm = control.shot.alarms[0]
    assert alarm.code in {"spindle", "ignores-stop"}
    assert text("executor.press-estop") in alarm.cause + alarm.remedy


@pytest.mark.parametrize("name", [name for name in THREADING if name != "grblhal"])
def test_thread_pass_queued_too_late_is_cut_after_resuming(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing of it is passed over: what stands next would begin elsewhere."""
    rig = THREADING[name]()
    control = Control(rig)

    def too_late(*_: object) -> None:
        raise DriverError("it comes too late", "late")

    ports = rig.ports
    sink, way = (ports.axes, "splice") if ports.gear is None else (ports.gear, "mesh")
    control.start(THREAD)
    control.until_true(lambda shot: shot.waiting_for == text("executor.at-speed"))
    with monkeypatch.context() as patch:
        patch.setattr(sink, way, too_late)
        control.until(MachineState.HOLD, limit=10.0)
    assert control.shot.stop is not None
    assert control.shot.stop.code == "late"
    control.press()
    control.until_true(lambda _: control.world.place()[1] < -0.2 * INCH)  # the thread itself
    assert control.shot.alarms == ()
    rig.close()


def test_repeatedly_late_thread_pass_starts_at_a_later_index(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At rest a computer that was away for .3 s costs a turn, not a hold: the sixth try is .32 s ahead."""
    rig = Simulated()
    control = Control(rig)
    assert rig.ports.gear is not None
    mesh, late = rig.ports.gear.mesh, [True] * 5

    def at_times(*asked: Any) -> None:
        if late:
            late.pop()
            raise DriverError("it comes too late", "late")
        mesh(*asked)

    control.start(THREAD)
    control.until_true(lambda shot: shot.waiting_for == text("executor.at-speed"))
    monkeypatch.setattr(rig.ports.gear, "mesh", at_times)
    control.until_true(lambda _: control.world.place()[1] < -0.2 * INCH)
    assert control.shot.stop is None
    assert not late
    rig.close()


def test_slow_encoder_polling_is_not_a_spindle_fault(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = Simulated()
    monkeypatch.setattr(rig.ports.spindle, "read_angle", lambda: (0.0, 0.0))  # never a new reading
    control = Control(rig)
    control.start(THREAD)
    control.until(MachineState.HOLD)
    assert control.shot.stop is not None
    assert control.shot.stop.code == "late"
    assert control.shot.alarms == ()
    assert control.world.place()[1] > 0.0
    rig.close()
