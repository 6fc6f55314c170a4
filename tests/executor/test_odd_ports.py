"""Drivers that raise what nobody has thought of, at any call, in any state: every safe step is taken."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import pytest

from core.executor.commands import CycleStart, EnableDrives, Reset
from core.executor.executor import Executor
from core.executor.snapshot import LogEvent, MachineState
from core.ports import AxisSink, DigitalIO, MachinePorts, OperatorStation, Spindle
from tests.executor.rig import Rig
from tests.texts import text

pytestmark = pytest.mark.long

BUSY = "G90G94F300\nM03S1000\nM08\nM25\nX1\nG01F20Z-1\nG04F1\nM00\nX0Z0\nM30\n"
ODD = [ValueError, SystemExit, GeneratorExit, MemoryError, ZeroDivisionError]
CALLS = {
    "axes": ("now", "horizon", "splice", "demand_at", "sample", "stop", "clear_fault", "enable"),
    "spindle": ("set_speed", "start_coasting", "speed", "read_angle", "read_fault"),
    "io": ("inputs", "get_outputs", "write", "switch_to_safe_state"),
    "station": ("read_state",),
}
PORTS = {"axes": AxisSink, "spindle": Spindle, "io": DigitalIO, "station": OperatorStation}
EACH = [(port, call) for port, calls in CALLS.items() for call in calls]
NAMED = ["-".join(each) for each in EACH]
MOMENTS: dict[str, Callable[[Rig], object]] = {
    "cutting": lambda rig: rig.until_true(lambda shot: shot.actual[1] < -3.0),
    "dwell": lambda rig: rig.until_true(lambda shot: shot.waiting_for == "DWELL"),
    "stopped": lambda rig: rig.until(MachineState.PROGRAM_STOP),
}


class Odd:
    """A port one of whose calls raises while it is ``broken``."""

    def __init__(self, port: object, call: str, error: type[BaseException]) -> None:
        self._port, self._call, self._error = port, call, error
        self.broken = False
        self.raised = 0

    def __getattr__(self, name: str) -> object:
        if name == self._call and self.broken:
            return self._raise
        return getattr(self._port, name)

    def _raise(self, *_: object, **__: object) -> object:
        self.raised += 1
        raise self._error("nobody has thought of this")


@dataclasses.dataclass
class OddRig(Rig):
    """The executor on ports of which one is odd, at the longest of the ticks that it has."""

    every: float = 0.02

    def break_into(self, port: str, call: str, error: type[BaseException]) -> Odd:
        real = self.sim.ports
        odd = Odd(getattr(real, port), call, error)
        ports: MachinePorts = dataclasses.replace(real, **{port: odd})  # type: ignore[arg-type]
        self.executor = Executor(self.machine, ports, self.events.append, self._passes)
        self.executor.run_tick()
        return odd


def all_off(rig: Rig) -> bool:
    """By the machine itself."""
    on = {name for name, lit in rig.sim.ports.io.get_outputs().items() if lit}
    return (
        on <= {"collet"}
        and rig.sim.machine.get_spindle_rpm() == 0.0
        and not rig.sim.ports.axes.sample().moving
    )


@pytest.mark.parametrize("moment", MOMENTS)
@pytest.mark.parametrize(("port", "call"), EACH, ids=NAMED)
def test_estop_completes_all_other_steps_when_a_driver_raises(port: str, call: str, moment: str) -> None:
    for error in ODD[:2]:
        rig = OddRig()
        odd = rig.break_into(port, call, error)
        rig.start(BUSY)
        MOMENTS[moment](rig)
        odd.broken = True
        rig.sim.machine.press_estop()
        rig.run(4.0)
        outputs = {name for name, lit in rig.sim.ports.io.get_outputs().items() if lit}
        if (port, call) not in {("io", "write"), ("io", "switch_to_safe_state")}:
            assert outputs <= {"collet"}
        assert rig.sim.machine.get_spindle_rpm() == 0.0
        assert not rig.sim.ports.axes.sample().enabled
        assert rig.state in {MachineState.ESTOP, MachineState.FAULT}
        assert rig.state is MachineState.ESTOP or port == "station" or rig.shot.alarms
        odd.broken = False
        rig.run(0.3)
        assert all_off(rig)


@pytest.mark.parametrize("error", ODD)
@pytest.mark.parametrize(("port", "call"), EACH, ids=NAMED)
def test_driver_failure_in_a_cut_stops_the_machine_unless_not_needed(
    port: str, call: str, error: type[BaseException]
) -> None:
    rig = OddRig()
    odd = rig.break_into(port, call, error)
    rig.start(BUSY)
    MOMENTS["cutting"](rig)
    odd.broken = True
    rig.run(4.0)
    if odd.raised:
        assert rig.state is MachineState.FAULT
        assert "internal" in {alarm.code for alarm in rig.shot.alarms}
    odd.broken = False
    rig.run(4.0)
    if odd.raised:
        assert all_off(rig)
        assert not rig.sim.ports.axes.sample().enabled
        rig.post(Reset())
        rig.post(EnableDrives())
        rig.run(0.5)
        assert rig.state is MachineState.IDLE
        assert all_off(rig)


def test_failed_output_switch_off_is_retried_and_raises_its_own_alarm() -> None:
    rig = OddRig()
    odd = rig.break_into("io", "switch_to_safe_state", ValueError)
    write = rig.sim.ports.io.write

    def stuck(name: str, is_on: bool) -> None:
        if name == "coolant" and odd.broken:
            raise ValueError("welded")
        write(name, is_on)

    rig.sim.ports.io.write = stuck  # type: ignore[method-assign]
    rig.start(BUSY)
    MOMENTS["cutting"](rig)
    assert {"coolant", "catcher"} <= rig.shot.outputs
    odd.broken = True
    rig.sim.machine.press_estop()
    rig.run(0.5)
    assert rig.shot.outputs & {"coolant", "catcher"} == {"coolant"}
    assert rig.shot.alarms[-1].code == "not-safe"
    assert "the outputs" in rig.shot.alarms[-1].cause
    assert text("executor.press-estop") in rig.shot.alarms[-1].remedy
    odd.broken = False
    rig.run(0.2)
    assert "coolant" not in rig.shot.outputs


def test_log_failure_does_not_prevent_the_stop() -> None:
    def lost(event: LogEvent) -> None:
        raise RuntimeError(f"no disk for {event.kind}")

    rig = Rig()
    executor = rig.executor = Executor(rig.machine, rig.sim.ports, lost)
    rig.start("G90G94F300\nM03S1000\nM08\nG01F20Z-1\nM30\n")
    rig.until_true(lambda shot: shot.actual[1] < -3.0)
    rig.sim.machine.drive_fault("X")
    rig.run(4.0)
    assert executor.snapshot.state is MachineState.FAULT
    assert [alarm.code for alarm in executor.snapshot.alarms] == ["axis"]
    assert all_off(rig)


def test_cycle_start_seen_before_a_driver_failure_starts_nothing_later() -> None:
    rig = OddRig()
    odd = rig.break_into("axes", "sample", ValueError)
    rig.ready()
    rig.load("G90G94F300\nX1\nM30\n")
    rig.run(0.5)
    rig.sim.machine.press_start()
    odd.broken = True
    rig.run(0.5)
    odd.broken = False
    rig.run(1.0)
    assert rig.state is MachineState.FAULT
    assert rig.shot.actual[0] == 0.0
    rig.post(CycleStart())
    assert rig.state is MachineState.FAULT


def test_calls_that_break_are_methods_of_the_ports() -> None:
    assert [each for each in EACH if not hasattr(PORTS[each[0]], each[1])] == []
