"""A bus whose control sleeps: fewer SYNCs, our heartbeat as ever, and all of it again once it wakes up."""

from __future__ import annotations

import itertools

import pytest

from tests.drivers.canopen.bench import CanBench, can_machine
from tests.drivers.machines import ramp

STEP = 0.005


class Sleeping:
    """What the driver host's loop does with the bus while its control sleeps."""

    def __init__(self, bench: CanBench, monkeypatch: pytest.MonkeyPatch) -> None:
        self.bench = bench
        self.syncs: list[float] = []
        bus = bench.machine.bus
        sent = bus.send_sync

        def noted() -> None:
            self.syncs.append(bench.clock.now())
            sent()

        monkeypatch.setattr(bus, "send_sync", noted)

    def go_on(self, seconds: float, *, asleep: bool = True) -> None:
        machine, clock = self.bench.machine, self.bench.clock
        end = clock.now() + seconds
        while clock.now() < end:
            pause = machine.get_idle_time(asleep)
            due = clock.now() + (pause or STEP)
            while clock.now() < due - 1e-9:
                clock.advance(min(STEP, due - clock.now()))
                self.bench.peers.process_frames()
            machine.run_cycle()
            self.bench.peers.process_frames()


@pytest.fixture
def sleeping(bench: CanBench, monkeypatch: pytest.MonkeyPatch) -> Sleeping:
    bench.machine.axes.enable(True)
    bench.run(0.3)
    return Sleeping(bench, monkeypatch)


def test_idle_bus_has_ten_syncs_a_second_without_faults(sleeping: Sleeping) -> None:
    sleeping.go_on(3.0)
    gaps = [b - a for a, b in zip(sleeping.syncs, sleeping.syncs[1:], strict=False)]
    assert 28 <= len(sleeping.syncs) <= 31
    assert max(gaps) < 0.11
    machine = sleeping.bench.machine
    assert machine.axes.sample().fault == ""
    assert machine.axes.sample().enabled
    assert machine.find_unknown_items() == frozenset()
    assert machine.io.read_state().age < 0.2  # a station that is silent for longer would hold


def test_sync_of_a_sleeping_bus_may_be_sent_early(sleeping: Sleeping) -> None:
    sleeping.go_on(1.0)
    machine, clock = sleeping.bench.machine, sleeping.bench.clock
    before = len(sleeping.syncs)
    for _ in range(40):  # a round each 5 ms, as if something else were to do in each
        clock.advance(STEP)
        sleeping.bench.peers.process_frames()
        machine.run_cycle()
        machine.get_idle_time(True)
    gaps = [b - a for a, b in itertools.pairwise(sleeping.syncs[before:])]
    assert gaps == pytest.approx([0.07] * len(gaps), abs=0.006)
    assert gaps


def test_drives_receive_the_heartbeat_while_the_bus_sleeps(
    sleeping: Sleeping, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus, clock = sleeping.bench.machine.bus, sleeping.bench.clock
    beats: list[float] = []
    send = bus.send_message

    def noted(can_id: int, data: bytes, remote: bool = False) -> None:
        if can_id == 0x700 + bus.config.host_id:
            beats.append(clock.now())
        send(can_id, data, remote)

    monkeypatch.setattr(bus, "send_message", noted)
    sleeping.go_on(2.0)
    gaps = [b - a for a, b in itertools.pairwise(beats)]
    assert max(gaps) <= bus.config.heartbeat + 1e-9
    assert min(gaps) > 0.9 * bus.config.heartbeat


def test_input_change_is_read_with_the_next_sync(sleeping: Sleeping) -> None:
    sleeping.go_on(1.0)
    sleeping.bench.peers.machine.press_estop()
    sleeping.go_on(0.12)
    assert sleeping.bench.machine.io.read_state().estop


def test_node_that_replies_to_every_second_sync_is_read_as_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    made = CanBench(can_machine(("sync_ms = 10 ", "sync_ms = 5 ")))
    try:
        assert made.machine.config.bus_settings.slow_reply_divisor == 2
        made.run(0.5)
        sleeping = Sleeping(made, monkeypatch)
        for pressed in (True, False) * 4:  # at any time between two SYNCs
            sleeping.go_on(0.53)
            made.peers.machine.set_input("TB2-5", pressed)
            sleeping.go_on(0.12)
            assert made.machine.io.inputs()["TB2-5"] is pressed
    finally:
        made.close()


def test_sync_rate_is_normal_again_one_cycle_after_waking(sleeping: Sleeping) -> None:
    sleeping.go_on(1.0)
    del sleeping.syncs[:]
    woken = sleeping.bench.clock.now()
    sleeping.go_on(1.0, asleep=False)
    assert sleeping.syncs[0] - woken < 3 * STEP
    assert len(sleeping.syncs) == pytest.approx(1.0 / sleeping.bench.machine.config.bus_settings.sync, abs=2)


def test_moving_or_faulted_bus_needs_every_cycle(sleeping: Sleeping) -> None:
    machine = sleeping.bench.machine
    sleeping.go_on(1.0)
    axes = machine.axes
    begin = sleeping.bench.clock.now() + axes.commit + 0.05
    axes.splice(ramp(begin, axes.sample().demand, 30.0, 0.5))
    sleeping.bench.run(0.4)
    assert axes.sample().moving
    assert machine.get_idle_time(True) == 0.0
    sleeping.bench.run(2.0)
    assert machine.get_idle_time(True) > 0.0
    machine.bus.mark_failed("the interface has failed")
    assert machine.get_idle_time(True) == 0.0


def test_axis_without_power_coasts_and_stays_where_it_is_pushed(bench: CanBench) -> None:
    plant = bench.peers.plant
    bench.run(0.1)
    assert plant.axis_drives["X"].is_idle
    plant.axis_drives["X"].servo_axis.v = 20.0  # it rolls
    assert not plant.axis_drives["X"].is_idle
    bench.run(0.1)
    at = bench.machine.axes.sample().actual[0]
    assert at > 0.0
    bench.peers.machine.push("X", 1.0)
    bench.run(0.1)
    assert bench.machine.axes.sample().actual[0] == pytest.approx(at + 1.0, abs=0.002)


@pytest.mark.parametrize("act", ["moves", "jammed", "pushed"])
def test_drive_with_an_external_force_is_not_idle(bench: CanBench, act: str) -> None:
    drive = bench.peers.plant.axis_drives["X"]
    bench.machine.axes.enable(True)
    bench.run(0.3)
    if act == "moves":
        bench.machine.axes.splice(ramp(bench.clock.now() + 0.2, (0.0, 0.0, 0.0), 20.0, 0.5))
        bench.run(0.4)
    elif act == "jammed":
        bench.peers.machine.jam("X")
    else:
        bench.peers.machine.push("X", 0.5)
    assert not drive.is_idle
