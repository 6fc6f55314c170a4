"""The executor on the bus: what an operator sees of palms, homing, and a drive that comes and goes."""

from __future__ import annotations

import pytest

from core.executor.commands import CycleStart, FeedHold, HomeAxes, Jog
from core.executor.executor import Executor
from core.executor.snapshot import MachineState
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.executor.rig import Rig
from tests.texts import text

OVER = "G90G94F300\nX0Z0\nG01F300\n" + "X.2Z-3\nX0Z0\n" * 3 + "M30"


BUS_TICK = 0.01  # s


class BusRig(Rig):
    """The rig of the executor's tests, on the bus instead of the simulation's own ports."""

    def __post_init__(self) -> None:
        self.bench = CanBench(self.machine)
        self.clock = self.bench.clock
        self.executor = Executor(self.machine, self.bench.machine.ports, self.events.append, self._passes)
        self.executor.run_tick()

    def tick(self, dt: float | None = None) -> None:
        """Two rounds of the bus for each of the executor's."""
        step = BUS_TICK if dt is None else dt
        for _ in range(2):
            self.clock.advance(step / 2)
            self.bench.machine.run_cycle()
            self.bench.peers.process_frames()
        self.executor.run_tick()
        for look in self.watch:
            look(self.executor.snapshot)


def under_way(rig: BusRig, seconds: float = 0.5) -> None:
    """On the way at 300 in/min."""
    rig.start(OVER)
    rig.until(MachineState.RUN)
    rig.until_true(lambda s: s.velocity > 126.0)
    rig.run(seconds)


def test_drive_that_restarts_is_no_longer_homed() -> None:
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false"), absolute=False))
    rig.ready()
    for axis in rig.bench.machine.axes.drives.axes:
        axis.is_homed = True
    rig.run(0.1)
    rig.bench.peers.nodes["X"].boot_up()
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[-1].code == "drive-restarted"
    assert rig.shot.alarms[-1].cause.startswith("X: ")
    assert rig.bench.machine.axes.sample().homed == (False, True, True)
    rig.bench.close()


def test_palm_buttons_start_if_machine_file_requires_two_hands() -> None:
    rig = BusRig(can_machine())
    rig.start(OVER)
    rig.run(0.1)
    assert rig.state is MachineState.IDLE
    assert rig.shot.start_refusal_reason == text("executor.press-palms")
    rig.bench.peers.machine.press_start()
    rig.until(MachineState.RUN, limit=0.3)
    rig.bench.close()


def test_homing_follows_the_machine_file_order_and_precedes_a_cycle() -> None:
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false"), absolute=False))
    for index, way in ((0, 8.0), (1, -15.0)):
        rig.bench.peers.plant.servos[index].switch = way
    rig.start(OVER)
    rig.run(0.2)
    assert rig.state is MachineState.IDLE
    assert rig.shot.start_refusal_reason == text("executor.not-homed", axes="X, Z")
    order: list[str] = []

    def note(shot: object) -> None:
        homing = rig.bench.machine.axes.active_homing
        if homing is not None and homing.config.name not in order:
            order.append(homing.config.name)

    rig.watch.append(note)
    rig.post(HomeAxes(""))
    rig.until(MachineState.HOMING)
    rig.until(MachineState.IDLE, limit=20.0)
    assert order == ["Z", "X"]
    assert rig.shot.homed[:2] == (True, True)
    assert rig.shot.actual[:2] == pytest.approx((0.0, 0.0), abs=0.00127)
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, limit=30.0)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    rig.bench.close()


def test_feed_hold_ends_homing_and_jogging_is_possible_afterwards() -> None:
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false"), absolute=False))
    rig.bench.peers.plant.servos[1].switch = 60.0
    rig.ready()
    rig.post(HomeAxes("Z"))
    rig.until(MachineState.HOMING)
    rig.run(0.8)
    rig.post(FeedHold())
    rig.until(MachineState.IDLE)
    rig.run(0.6)
    stood = rig.shot.actual[1]
    assert stood > 10.0
    rig.post(Jog("Z", 5.0, 0.2))
    rig.until(MachineState.JOG)
    rig.until(MachineState.IDLE)
    assert 0.0 < rig.shot.actual[1] - stood < 2.0
    assert rig.shot.alarms == ()
    rig.bench.close()
