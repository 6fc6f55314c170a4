"""A machine at rest: everything is looked at in every tick, and shown as soon as anything happens."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from app.compose.backends.simulated_backend import create_sim_config
from app.compose.machine.machine_files import load_machine
from core.executor.commands import EnableDrives, ForceOutput, Jog, SetSwitch
from core.executor.executor import REST_TICK_S, Executor
from core.executor.snapshot import MachineState
from core.ports import DriverError, StopMode
from drivers.simulated.simulated_machine import build_simulation
from drivers.simulated.simulated_table import PlannedFault
from drivers.wakeups import ManualClock
from tests.executor.rig import FINE, Rig


def rested(*, powered: bool = True) -> Rig:
    """Nothing has happened for two seconds."""
    rig = Rig(every=FINE)
    if powered:
        rig.post(EnableDrives())
    rig.run(2.0)
    return rig


def shown(rig: Rig, ticks: int) -> int:
    """In how many ticks a snapshot is made."""
    made = {id(rig.shot): rig.shot}
    before = len(made)
    for _ in range(ticks):
        rig.tick()
        made[id(rig.shot)] = rig.shot
    return len(made) - before


@pytest.mark.parametrize("powered", [True, False])
def test_snapshot_is_published_20_times_per_second_after_1_s_at_rest(powered: bool) -> None:
    rig = Rig(every=FINE)
    if powered:
        rig.post(EnableDrives())
    assert shown(rig, 90) == 90
    rig.run(1.0)
    assert shown(rig, 100) == 20
    assert rig.shot.t > rig.clock.now() - 0.051
    assert rig.executor.tick_count > 290  # the watchdog sees each of them


HAPPENS = pytest.mark.parametrize(
    ("happens", "seen"),
    [
        (lambda rig: rig.sim.machine.press_estop(), lambda rig: rig.state is MachineState.ESTOP),
        (lambda rig: rig.sim.machine.drive_fault("X"), lambda rig: rig.state is MachineState.FAULT),
        (lambda rig: rig.sim.machine.set_input("TB2-5", True), lambda rig: "TB2-5" in rig.shot.inputs),
        (lambda rig: rig.sim.machine.set_feed_pot(0.5), lambda rig: rig.shot.feed_override == 0.5),
        (lambda rig: rig.sim.machine.push("X", 0.5), lambda rig: abs(rig.shot.following_error[0]) > 0.01),
        (lambda rig: rig.executor.post(SetSwitch("single_block", True)), lambda rig: rig.shot.single_block),
        (lambda rig: rig.executor.post(Jog("X", 5.0, 0.2)), lambda rig: rig.state is MachineState.JOG),
    ],
)


@HAPPENS
@pytest.mark.parametrize("phase", range(5))
def test_event_is_published_by_the_tick_that_detects_it(
    phase: int, happens: Callable[[Rig], None], seen: Callable[[Rig], bool]
) -> None:
    rig = rested()
    for _ in range(phase):
        rig.tick()
    happens(rig)
    rig.tick()
    assert seen(rig)
    assert rig.shot.t == rig.clock.now()


def test_moving_machine_is_published_every_tick() -> None:
    rig = rested()
    rig.post(Jog("X", 5.0, 0.5))
    assert shown(rig, 30) == 30


def test_late_tick_at_rest_is_reported() -> None:
    rig = rested()
    late: list[float] = []
    rig.executor._tell = lambda tick: late.append(tick.delay_s)
    rig.tick(0.07)
    rig.run(0.1)
    assert max(late) == pytest.approx(0.06)


@HAPPENS
def test_listener_is_called_when_the_snapshot_changes(
    happens: Callable[[Rig], object], seen: Callable[[Rig], bool]
) -> None:
    rig = rested()
    called: list[bool] = []
    rig.executor.on_change_at_rest = lambda: called.append(seen(rig))
    rig.run(1.0)
    assert not called
    happens(rig)
    rig.run(0.1)
    assert any(called), "and what has changed is in the snapshot by then"


def test_listener_is_not_called_while_the_machine_moves() -> None:
    rig = rested()
    rig.executor.post(Jog("X", 5.0, 2.0))
    rig.run(0.2)
    called: list[bool] = []
    rig.executor.on_change_at_rest = lambda: called.append(True)
    rig.run(0.5)
    assert rig.state is MachineState.JOG
    assert not called


# --- between two ticks ------------------------------------------------------------------------------------


class Ringing:
    """Stands in for waiting: how long it would have slept, and whether something had rung by then."""

    def __init__(self, rig: Rig) -> None:
        self._wakeup = rig.executor._ports.wakeup
        assert self._wakeup is not None
        self._wakeup.wait_for_wakeup(0.0)
        self.slept: list[float] = []
        self.rung: list[bool] = []
        self.meanwhile: Callable[[], None] = lambda: None
        self.wait, self._wakeup.wait_for_wakeup = self._wakeup.wait_for_wakeup, self._sleep  # type: ignore[method-assign]

    def _sleep(self, seconds: float) -> bool:
        self.slept.append(seconds)
        self.meanwhile()
        self.rung.append(self.wait(0.0))
        return self.rung[-1]


@pytest.mark.parametrize("powered", [True, False])
def test_machine_at_rest_is_polled_10_times_per_second(powered: bool) -> None:
    rig = rested(powered=powered)
    ringing = Ringing(rig)
    late: list[float] = []
    rig.executor._tell = lambda tick: late.append(tick.delay_s)
    for _ in range(5):
        before = rig.shot
        assert rig.executor.wait_at_rest()
        rig.tick(REST_TICK_S)
        assert rig.shot is not before  # each of them is shown
    assert ringing.slept == [REST_TICK_S] * 5
    assert not any(ringing.rung)
    assert max(late) < 1e-9  # as was meant


@HAPPENS
def test_event_ends_the_rest_wait_immediately(
    happens: Callable[[Rig], None], seen: Callable[[Rig], bool]
) -> None:
    rig = rested()
    ringing = Ringing(rig)
    ringing.meanwhile = lambda: happens(rig)
    assert rig.executor.wait_at_rest()
    assert ringing.rung == [True]
    rig.tick(0.001)
    assert seen(rig)
    for _ in range(99):
        assert not rig.executor.wait_at_rest()
        rig.tick()


def test_command_posted_before_the_wait_is_not_delayed() -> None:
    rig = rested()
    rig.executor.post(SetSwitch("single_block", True))
    assert not rig.executor.wait_at_rest()


@pytest.mark.parametrize(
    "goes_on",
    [
        lambda rig: setattr(rig.sim.ports.spindle, "speed", lambda: 1.0),
        lambda rig: rig.post(ForceOutput("coolant", True)),
        lambda rig: rig.sim.machine.station_silent(),
        lambda rig: rig.sim.machine.jam("X"),
    ],
)
def test_changing_state_is_polled_every_tick(goes_on: Callable[[Rig], None]) -> None:
    rig = rested()
    Ringing(rig)
    goes_on(rig)
    rig.run(3.0)
    assert rig.state in {MachineState.IDLE, MachineState.FAULT}
    for _ in range(20):
        rig.tick()
        assert not rig.executor.wait_at_rest()


@pytest.mark.parametrize(
    ("act", "seconds"),
    [
        (lambda rig: rig.sim.ports.io.write("collet", False), 0.31),  # .25 s ± 20 %
        (lambda rig: rig.sim.machine.press_start(), 0.11),
        (lambda rig: rig.sim.machine.push("X", 0.01), 0.3),
        (lambda rig: rig.sim.ports.axes.stop(StopMode.RAMP_OFF), 0.05),
    ],
)
def test_driver_reports_settled_only_once_it_is_settled(act: Callable[[Rig], None], seconds: float) -> None:
    rig = rested()
    wakeup = rig.sim.ports.wakeup
    assert wakeup is not None
    assert wakeup.can_rely_on_wakeups()
    act(rig)
    assert not wakeup.can_rely_on_wakeups()
    rig.clock.advance(seconds)
    assert wakeup.can_rely_on_wakeups()


def test_machine_with_a_planned_fault_never_settles() -> None:
    faults = (PlannedFault(at=1000.0, what="estop"),)
    config = replace(create_sim_config(load_machine()), planned_faults=faults)
    ports, _hands = build_simulation(config, ManualClock())
    assert ports.wakeup is not None
    assert not ports.wakeup.can_rely_on_wakeups()


def test_drivers_without_wakeup_are_polled_every_tick() -> None:
    rig = rested()
    ports = replace(rig.sim.ports, wakeup=None)
    executor = Executor(rig.machine, ports, rig.events.append)
    for _ in range(300):
        executor.run_tick()
        assert not executor.wait_at_rest()
        rig.clock.advance(0.01)


def test_driver_failure_in_settled_query_raises_an_alarm(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig = rested()

    def broken() -> bool:
        raise DriverError("the wire is cut")

    monkeypatch.setattr(rig.sim.ports.wakeup, "can_rely_on_wakeups", broken)
    assert not rig.executor.wait_at_rest()
    rig.tick()
    assert rig.state is MachineState.FAULT


def test_recorder_is_notified_when_the_machine_rests() -> None:
    rig = rested()
    told: list[bool] = []
    rig.executor._tell = lambda tick: told.append(tick.is_at_rest)
    rig.run(0.2)
    assert set(told) == {True}
    rig.sim.machine.set_input("guard", False)
    rig.tick()
    assert told[-1] is False
