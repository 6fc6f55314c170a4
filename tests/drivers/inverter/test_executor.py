"""The executor with simulated slides and an inverter on its line: what an operator sees of its faults."""

from __future__ import annotations

import dataclasses

import pytest

import resources
from app.compose.inverter import ClearingAxes
from core.executor.commands import Reset
from core.executor.executor import Executor
from core.executor.snapshot import State
from core.machine.load import parse_machine
from drivers.inverter.spindle import InverterSpindle
from tests.drivers.inverter.benches import FAMILIES, Bench, bench, config
from tests.executor.rig import TICK, Rig

TURNS = "G90G94F300\nM03S1800\nG04F4\nM05\nG04F9\nM30\n"
CUTS = "G90G94F30\nM03S1800\nX.5Z.1\nG01X.4F5\nX.1\nX.5\nM30\n"


class LineRig(Rig):
    """The line has a clock of its own, which is kept up with that of the executor."""

    family = FAMILIES[0]

    def __post_init__(self) -> None:
        super().__post_init__()
        self.bench: Bench = bench(self.family)
        self.clock.advance(self.bench.clock.now())
        ports = self.sim.ports
        spindle = InverterSpindle(
            config(self.family),
            self.bench.attendant,
            self.clock,
            estop=lambda: ports.station.snapshot().estop,
        )
        ports = dataclasses.replace(
            ports, axes=ClearingAxes(ports.axes, spindle.clear_fault), spindle=spindle, gear=None
        )
        self.executor = Executor(self.machine, ports, self.events.append, self._passes)
        self.executor.tick()

    def tick(self, dt: float = TICK) -> None:
        self.clock.advance(dt)
        while self.bench.clock.now() < self.clock.now():
            self.bench.run(0.001)
        self.executor.tick()


@pytest.fixture(params=FAMILIES)
def rig(request: pytest.FixtureRequest) -> LineRig:
    """Each family."""
    kind = type("OneFamily", (LineRig,), {"family": request.param})
    made = kind(machine=parse_machine(resources.machine_file("gt75-vfd.toml"), "gt75-vfd.toml"))
    assert isinstance(made, LineRig)
    return made


def test_a_program_with_a_turning_spindle_runs_to_its_end(rig: LineRig) -> None:
    rig.start(CUTS)
    rig.until_true(lambda shot: abs(shot.rpm_actual - 1800.0) < 20.0)
    rig.until(State.IDLE, State.FAULT)
    assert rig.shot.alarms == ()
    rig.run(3.0)
    assert rig.bench.rpm == 0.0


def test_ignoring_m05_becomes_an_alarm_that_asks_for_the_estop(rig: LineRig) -> None:
    rig.start(TURNS)
    rig.until_true(lambda shot: shot.rpm_actual > 1700.0)
    rig.bench.inverter.deaf = True
    rig.until_true(lambda shot: shot.rpm_command == 0.0)
    began = rig.clock.now()
    rig.until_true(lambda shot: bool(shot.alarms), limit=3.0)
    assert rig.clock.now() - began < 1.7
    alarm = rig.shot.alarms[0]
    assert alarm.code in {"spindle", "ignores-stop"}
    assert "PRESS E-STOP" in alarm.cause + alarm.remedy


@pytest.mark.parametrize("fault", ["silent", "out"])
def test_a_dead_line_stops_the_cycle_and_reset_starts_no_spindle(rig: LineRig, fault: str) -> None:
    rig.start(CUTS)
    rig.until_true(lambda shot: shot.rpm_actual > 1700.0)
    setattr(rig.bench.wire, fault, True)
    rig.until_true(lambda shot: bool(shot.alarms), limit=4.0)
    assert rig.shot.alarms[0].code == "spindle"
    assert "PRESS E-STOP" in rig.shot.alarms[0].cause
    rig.run(1.0)
    assert rig.state in {State.FAULT, State.DISABLED}
    setattr(rig.bench.wire, fault, False)
    rig.run(4.0)
    assert rig.bench.rpm == 0.0
    rig.post(Reset())
    rig.run(6.0)
    assert rig.bench.rpm == 0.0
    assert rig.shot.alarms == ()
    assert rig.shot.rpm_command == 0.0


def test_estop_stops_it_and_release_starts_nothing(rig: LineRig) -> None:
    rig.start(TURNS)
    rig.until_true(lambda shot: shot.rpm_actual > 1700.0)
    rig.sim.machine.press_estop()
    rig.run(3.0)
    assert rig.state is State.ESTOP
    assert rig.bench.rpm == 0.0
    rig.sim.machine.release_estop()
    rig.run(3.0)
    assert rig.bench.rpm == 0.0
    assert rig.shot.alarms == ()


def test_a_thread_is_refused_without_an_encoder(rig: LineRig) -> None:
    rig.start("G90G94F300\nM03S1000\nX.25Z.2\nG33X.24Z-.2I.01K.05O\nM30\n")
    rig.until(State.FAULT)
    assert "encoder" in rig.shot.alarms[0].cause
