"""An inverter on its line and the encoder on the bus, through the executor: at-speed, threads, and lies."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest

from app.compose.backends.inverter_backend import FaultClearingAxes
from core.executor.commands import Reset
from core.executor.executor import Executor
from core.executor.snapshot import MachineState
from core.ports import MachinePorts
from drivers.canopen.canopen_encoder import MeasuredSpindle
from drivers.inverter.command_monitor import SpeedComparator
from drivers.inverter.inverter_spindle import InverterSpindle, create_inverter_control
from tests.drivers.canopen.bench import can_machine
from tests.drivers.canopen.test_encoder import OWN
from tests.drivers.canopen.test_executor import BUS_TICK, BusRig
from tests.drivers.inverter.benches import Bench, config, far_end
from tests.drivers.inverter.inverter_simulators import Inverter
from tests.drivers.inverter.wires import BenchWire
from tests.executor.rig import INCH
from tests.texts import text

TURNS = "G90G94F300\nM03S1800\nG04F30\nM05\nG04F9\nM30\n"
CUTS = "G90G94F30\nM03S1800\nX.5Z.1\nG01X.4F5\nX.1\nX.5\nM30\n"
PITCH, RPM = 0.05, 1000
THREAD = f"G90G94F300\nM03S{RPM}\nX.25Z.2\nG33X.24Z-.2I.01K{PITCH}O\nM30\n"


class MeasuredRig(BusRig):
    """The inverter of the line turns the spindle whose encoder is on the bus."""

    def __post_init__(self) -> None:
        super().__post_init__()
        clock = type(self.clock)()
        clock.advance(self.clock.now())
        self.inverter = Inverter(self.clock, motor=self.bench.peers.plant.spindle)
        memory, slave = far_end("delta-vfdb", self.inverter)
        wire = BenchWire(slave, clock)
        one = create_inverter_control(config("delta-vfdb"), wire.opened, clock)
        ports = self.bench.machine.ports
        assert isinstance(ports.spindle, MeasuredSpindle)
        spindle = InverterSpindle(
            config("delta-vfdb"),
            one,
            self.clock,
            encoder=ports.spindle,
            is_estop_pressed=lambda: ports.station.read_state().estop,
            get_encoder_fault=ports.spindle.read_fault,
        )
        self.line = Bench(clock, self.inverter, memory, wire, one, spindle)
        one.open_and_check_line()
        self.bench.run(clock.now() - self.clock.now())
        joined = MachinePorts(
            clock=self.clock,
            axes=FaultClearingAxes(ports.axes, spindle.clear_fault),
            spindle=spindle,
            io=ports.io,
            station=ports.station,
        )
        self.executor = Executor(self.machine, joined, self.events.append, self._passes)
        self.executor.run_tick()

    def tick(self, dt: float | None = None) -> None:
        while self.line.clock.now() < self.clock.now() + (BUS_TICK if dt is None else dt):
            self.line.run(0.001)
        super().tick(dt)

    @property
    def cause(self) -> str:
        return self.shot.alarms[-1].cause if self.shot.alarms else ""


@pytest.fixture
def rig() -> Iterator[MeasuredRig]:
    made = MeasuredRig(can_machine(("two_hand_start = true", "two_hand_start = false"), *OWN))
    yield made
    made.bench.close()


def turning(rig: MeasuredRig, text: str = TURNS) -> None:
    rig.start(text)
    rig.until_true(lambda shot: shot.rpm_actual > 1780.0, limit=8.0)


def test_program_waits_for_the_measured_speed_and_completes(rig: MeasuredRig) -> None:
    rig.start(CUTS)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=120.0)
    assert rig.cause == ""
    rig.run(3.0)
    assert rig.inverter.rpm == 0.0


def test_slipping_motor_is_not_at_speed(rig: MeasuredRig) -> None:
    rig.bench.peers.plant.spindle.faults.speed_fraction = (
        0.9  # within what both may disagree, outside of the band
    )
    rig.start(CUTS)
    rig.until(MachineState.FAULT, limit=20.0)
    assert rig.shot.alarms[0].code == "at-speed"
    assert rig.shot.demand[0] > 0.4 * INCH  # no cut has begun


def test_thread_has_its_programmed_pitch(rig: MeasuredRig) -> None:
    reads: list[tuple[float, float]] = []

    def note(_shot: object) -> None:
        z, turns = rig.bench.peers.machine.get_true_positions()[1], rig.bench.peers.plant.spindle.revolutions
        reads.append((z, turns))

    rig.watch.append(note)
    rig.start(THREAD)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert rig.cause == ""
    inside = [(z, turns) for z, turns in reads if -0.15 * INCH < z < 0.05 * INCH]
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in itertools.pairwise(inside)]
    cut = [(dz, turns) for dz, turns in steps if dz < -0.05 and turns > 0.0]
    assert len(cut) > 5
    lead = sum(dz for dz, _ in cut) / sum(turns for _, turns in cut)
    assert lead == pytest.approx(-PITCH * INCH, rel=0.01)


def test_silent_encoder_during_a_cut_raises_an_alarm(rig: MeasuredRig) -> None:
    turning(rig)
    rig.bench.peers.nodes["turns"].is_silent = True
    rig.until(MachineState.FAULT, limit=0.5)
    assert rig.shot.alarms[0].code == "spindle-encoder"
    assert "turns: " in rig.cause
    rig.run(4.0)
    assert rig.inverter.rpm == 0.0
    assert rig.shot.rpm_actual == pytest.approx(
        0.0, abs=1.0
    )  # the inverter's word: it gives nothing any more


def test_spindle_stays_off_after_reset_and_m03_needs_the_encoder(rig: MeasuredRig) -> None:
    turning(rig)
    rig.bench.peers.nodes["turns"].is_silent = True
    rig.until(MachineState.FAULT, limit=0.5)
    rig.run(4.0)
    rig.post(Reset())
    rig.run(1.0)
    assert rig.state in {MachineState.DISABLED, MachineState.IDLE}  # the slides may be moved without it
    assert rig.inverter.rpm == 0.0
    rig.start(TURNS)
    rig.until(MachineState.FAULT, limit=2.0)
    assert rig.shot.alarms[0].code == "spindle-off"
    assert "turns: " in rig.cause
    rig.bench.peers.nodes["turns"].is_silent = False
    rig.post(Reset())
    rig.run(1.0)
    turning(rig)


def test_encoder_lost_with_a_stopped_spindle_raises_an_alarm_at_m03(rig: MeasuredRig) -> None:
    rig.ready()
    rig.bench.peers.nodes["turns"].is_silent = True
    rig.run(1.0)
    assert rig.state is MachineState.IDLE
    rig.start(TURNS)
    rig.until(MachineState.FAULT, limit=2.0)
    assert rig.shot.alarms[0].code == "spindle-off"
    assert "turns: " in rig.cause
    assert rig.inverter.rpm == 0.0


def test_detached_encoder_coupling_never_counts_as_standstill(rig: MeasuredRig) -> None:
    turning(rig)
    assert rig.bench.peers.encoder is not None
    rig.bench.peers.encoder.detach_coupling()
    rig.until(MachineState.FAULT, limit=2.5)
    assert rig.shot.alarms[0].code == "spindle-disagrees"
    assert text("executor.press-estop") in rig.cause
    rig.tick()
    while rig.inverter.rpm > 200.0:
        assert rig.shot.rpm_actual > 100.0  # it turns, and the collet stays shut
        rig.tick()


def test_swapped_motor_cable_is_detected(rig: MeasuredRig) -> None:
    rig.inverter.backwards = True
    rig.start(TURNS)
    rig.until(MachineState.FAULT, limit=5.0)
    assert rig.shot.alarms[0].code == "ignores-stop"
    assert text("executor.press-estop") in rig.cause


# --- agreement --------------------------------------------------------------------------------------------


def feed(pairs: list[tuple[float, float]], fraction: float = 0.15) -> list[str]:
    """What is said of (measured, given) every tenth of a second."""
    agreement = SpeedComparator(fraction)
    return [agreement.compare_speeds(measured, given, 0.1 * i) for i, (measured, given) in enumerate(pairs)]


def test_motor_slip_is_not_a_disagreement() -> None:
    assert not any(feed([(1700.0, 1800.0)] * 50))


def test_acceleration_ramp_is_not_a_disagreement() -> None:
    assert not any(feed([(50.0 * i, min(150.0 * i, 3000.0)) for i in range(21)]))


def test_coasting_down_is_not_a_disagreement() -> None:
    assert not any(feed([(1800.0 - 10 * i, 0.0) for i in range(60)]))


def test_short_disagreement_is_not_reported() -> None:
    assert not any(feed([(1800.0, 1800.0)] * 10 + [(1000.0, 1800.0)] * 9 + [(1800.0, 1800.0)] * 10))


@pytest.mark.parametrize("measured", [0.0, 1400.0, 2300.0, -1800.0])
def test_lasting_disagreement_is_reported_after_one_second(measured: float) -> None:
    said = feed([(1800.0, 1800.0)] * 10 + [(measured, 1800.0)] * 20)
    assert [bool(text) for text in said].index(True) == 20
    assert f"{measured:.0f} rpm" in said[-1]
