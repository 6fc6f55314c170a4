"""The executor on the bus: what an operator sees of holds, faults, E-stop, and drives that come and go."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.executor.commands import CycleStart, EnableDrives, FeedHold, Home, Jog, Reset
from core.executor.executor import Executor
from core.executor.snapshot import State
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.executor.rig import INCH, Rig, off_line

OVER = "G90G94F300\nX0Z0\nG01F300\n" + "X.2Z-3\nX0Z0\n" * 3 + "M30"
LINE = ((0.0, 0.0), (0.2 * INCH, -3.0 * INCH))


class BusRig(Rig):
    """The rig of the executor's tests, on the bus instead of the simulation's own ports."""

    def __post_init__(self) -> None:
        self.bench = CanBench(self.machine)
        self.clock = self.bench.clock
        self.executor = Executor(self.machine, self.bench.machine.ports, self.events.append, self._passes)
        self.executor.tick()

    def tick(self, dt: float = 0.01) -> None:
        """Two rounds of the bus for each of the executor's."""
        for _ in range(2):
            self.clock.advance(dt / 2)
            self.bench.machine.tick()
            self.bench.peers.pump()
        self.executor.tick()
        for look in self.watch:
            look(self.executor.snapshot)


@pytest.fixture
def rig() -> Iterator[BusRig]:
    """Drives off; a command may start a cycle."""
    made = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false")))
    yield made
    made.bench.close()


def under_way(rig: BusRig, seconds: float = 0.5) -> None:
    """On the way at 300 in/min."""
    rig.start(OVER)
    rig.until(State.RUN)
    rig.until_true(lambda s: s.velocity > 126.0)
    rig.run(seconds)


def test_a_program_runs_to_its_end(rig: BusRig) -> None:
    rig.start(OVER)
    rig.until(State.IDLE, limit=20.0)
    assert rig.shot.alarms == ()
    assert rig.shot.underruns == 0
    assert rig.shot.demand[:2] == pytest.approx((0.0, 0.0), abs=1e-3)


def test_feed_hold_from_300_inches_a_minute_within_a_quarter_second(rig: BusRig) -> None:
    under_way(rig)
    pressed = rig.clock.now()
    rig.post(FeedHold())
    rig.until(State.HOLD)
    assert rig.clock.now() - pressed <= 0.25
    assert off_line(rig.shot, *LINE) < 0.005
    assert rig.shot.alarms == ()
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(State.IDLE, limit=20.0)
    assert rig.shot.demand[:2] == pytest.approx((0.0, 0.0), abs=1e-3)


@pytest.mark.parametrize("stall", [0.5, 5.0])
def test_a_stalled_control_stops_on_the_path_without_a_fault(rig: BusRig, stall: float) -> None:
    under_way(rig, 0.1)
    drives = rig.bench.peers.plant.drives
    worst = 0.0
    for _ in range(round(stall / 0.005)):
        rig.bench.tick()
        x, z = drives["X"].p, drives["Z"].p
        worst = max(worst, abs(0.2 * z + 3.0 * x) / (0.2**2 + 3.0**2) ** 0.5)
    assert worst < 0.005
    rig.tick()
    assert rig.shot.alarms == ()
    assert any("starved" in event.kind for event in rig.events)
    if stall > 2.0:
        rig.until(State.HOLD, limit=0.2)


def test_a_drive_fault_stops_all_axes_and_spindle(rig: BusRig) -> None:
    under_way(rig)
    rig.bench.peers.machine.drive_fault("Z")
    rig.until(State.FAULT)
    assert "Z: " in rig.shot.alarms[-1].cause
    rig.run(1.0)
    assert not any(drive.power.powered for drive in rig.bench.peers.plant.drives.values())
    rig.post(Reset())
    rig.until(State.DISABLED)
    rig.post(EnableDrives())
    rig.until(State.IDLE)


def test_a_drive_that_restarts_has_lost_its_home() -> None:
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false"), absolute=False))
    rig.ready()
    for axis in rig.bench.machine.axes.drives.axes:
        axis.homed = True
    rig.run(0.1)
    rig.bench.peers.nodes["X"].boot()
    rig.until(State.FAULT)
    assert "X: the drive has restarted" in rig.shot.alarms[-1].cause
    assert rig.bench.machine.axes.sample().homed == (False, True, True)
    rig.bench.close()


@pytest.mark.parametrize("after", [0.05, 0.3, 0.61])
def test_estop_at_any_moment(rig: BusRig, after: float) -> None:
    under_way(rig, after)
    rig.bench.peers.machine.press_estop()
    rig.until(State.ESTOP, limit=0.1)
    rig.run(1.0)
    assert not any(drive.power.powered for drive in rig.bench.peers.plant.drives.values())
    stood = rig.bench.peers.machine.true_position()
    rig.bench.peers.machine.release_estop()
    rig.run(1.0)
    assert rig.state is State.DISABLED
    assert rig.bench.peers.machine.true_position() == stood


def test_a_jog_ends_with_its_lease(rig: BusRig) -> None:
    rig.ready()
    rig.post(Jog("X", 20.0, 0.2))
    rig.until(State.JOG)
    began = rig.clock.now()
    rig.until(State.IDLE)
    assert rig.clock.now() - began < 0.2 + 0.1 + 0.1
    # lease · v + v²/2a, and nothing more
    assert rig.shot.demand[0] < 20.0 * 0.2 + 20.0**2 / (2 * 3048.0) + 0.01


def test_palms_start_where_the_machine_file_wants_two_hands() -> None:
    rig = BusRig(can_machine())
    rig.start(OVER)
    rig.run(0.1)
    assert rig.state is State.IDLE
    assert "palm" in rig.shot.start_refused
    rig.bench.peers.machine.press_start()
    rig.until(State.RUN, limit=0.3)
    rig.bench.close()


def test_homing_in_the_order_of_the_machine_file_and_a_cycle_only_afterwards() -> None:
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false"), absolute=False))
    for index, way in ((0, 8.0), (1, -15.0)):
        rig.bench.peers.plant.servos[index].switch = way
    rig.start(OVER)
    rig.run(0.2)
    assert rig.state is State.IDLE
    assert "home" in rig.shot.start_refused.lower()
    order: list[str] = []

    def note(shot: object) -> None:
        homing = rig.bench.machine.axes.homing
        if homing is not None and homing.config.name not in order:
            order.append(homing.config.name)

    rig.watch.append(note)
    rig.post(Home(""))
    rig.until(State.HOME)
    rig.until(State.IDLE, limit=20.0)
    assert order == ["Z", "X"]
    assert rig.shot.homed[:2] == (True, True)
    assert rig.shot.actual[:2] == pytest.approx((0.0, 0.0), abs=0.00127)
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(State.IDLE, limit=30.0)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    rig.bench.close()


def test_feed_hold_ends_a_homing_and_jogs_go_on_from_there() -> None:
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false"), absolute=False))
    rig.bench.peers.plant.servos[1].switch = 60.0
    rig.ready()
    rig.post(Home("Z"))
    rig.until(State.HOME)
    rig.run(0.8)
    rig.post(FeedHold())
    rig.until(State.IDLE)
    rig.run(0.6)
    stood = rig.shot.actual[1]
    assert stood > 10.0
    rig.post(Jog("Z", 5.0, 0.2))
    rig.until(State.JOG)
    rig.until(State.IDLE)
    assert 0.0 < rig.shot.actual[1] - stood < 2.0
    assert rig.shot.alarms == ()
    rig.bench.close()
