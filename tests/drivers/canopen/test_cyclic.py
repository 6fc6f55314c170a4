"""A setpoint each SYNC: CSP and interpolated position by 60C1h, on time, late, missing, and between modes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from core.faults import get_fault_code
from core.ports import MotionSegments, StopMode
from drivers.canopen import canopen_objects as od
from drivers.canopen.position_modes import SyncSchedule
from tests.drivers.canopen.bench import CanBench, cyclic
from tests.drivers.machines import ramp

ZERO = (0.0, 0.0, 0.0)
TICK = 0.002


@pytest.fixture(params=["csp", "ip", "epos4"])
def bench(request: pytest.FixtureRequest) -> Iterator[CanBench]:
    """CiA 402 drives in both modes, and EPOS4 by its own objects."""
    family = "epos4" if request.param == "epos4" else "cia402"
    found = CanBench(cyclic("csp" if family == "epos4" else request.param, drive=family))
    yield found
    found.close()


def run(bench: CanBench, seconds: float) -> None:
    for _ in range(round(seconds / TICK)):
        bench.tick(TICK)


def test_path_is_followed_and_ends_within_one_count(bench: CanBench) -> None:
    """The drive's own demand against the path, one SYNC of 4 ms and one of the wire behind."""
    axes, drive = bench.machine.axes, bench.peers.plant.axis_drives["X"]
    axes.enable(True)
    start = bench.clock.now() + 0.05
    axes.splice(ramp(start, ZERO, 60.0, 0.3))  # up in .02 s at 3000 mm/s²
    worst = 0.0
    for _ in range(300):
        bench.tick(TICK)
        t = bench.clock.now() - start
        if 0.05 < t < 0.25:
            worst = max(worst, abs(drive.setpoint_position - (0.6 + 60.0 * (t - 0.02))))
    assert worst < 60.0 * TICK + 0.00127
    run(bench, 0.3)
    sample = axes.sample()
    assert sample.fault == ""
    assert not sample.moving
    assert sample.actual[0] == pytest.approx(60.0 * 0.32, abs=0.0013)
    assert abs(sample.following_error[0]) < 0.0013


def test_syncs_continue_while_a_long_path_is_queued(bench: CanBench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A tenth of a second of work, in hundreds of pieces: without a SYNC the drives would stop."""
    axes, bus = bench.machine.axes, bench.machine.bus
    axes.enable(True)
    run(bench, 0.2)
    syncs: list[float] = []
    sent, go_on = bus.send_sync, axes.queue.yield_cpu

    def noted() -> None:
        syncs.append(bench.clock.now())
        sent()

    def slowly() -> None:
        for _ in range(5):
            bench.clock.advance(0.001)
            bench.peers.process_frames()
            go_on()

    monkeypatch.setattr(bus, "send_sync", noted)
    axes.queue.yield_cpu = slowly
    count, rest = 2000, np.array([axes.demand_at(axes.horizon())[0]])
    zero = np.zeros((count, rest.shape[1]))
    start = bench.clock.now() + 0.2
    t = start + 0.002 * np.arange(count, dtype=np.float64)
    axes.splice(MotionSegments(t, np.full(count, 0.002), np.repeat(rest, count, 0), zero, zero))
    assert len(syncs) == pytest.approx(25, abs=1)
    assert np.diff(syncs) == pytest.approx(0.004, abs=1e-6)
    run(bench, 0.1)
    assert axes.sample().fault == ""
    assert axes.horizon() == pytest.approx(start + 4.0)


def test_following_error_excludes_the_bus_delay(bench: CanBench) -> None:
    """2(1 - .9) v/wn with wn = 2 pi 40 is .048 mm at 60 mm/s; a SYNC more or less of it would be .24 mm."""
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.5))
    run(bench, 0.3)
    assert abs(axes.sample().following_error[0]) == pytest.approx(0.048, abs=0.13)


def test_hold_brakes_on_the_path(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 120.0, 0.5))
    run(bench, 0.3)
    asked = bench.clock.now()
    axes.stop(StopMode.RAMP_HOLD)
    while axes.sample().moving:
        bench.tick(TICK)
    # 30 ms of commit, 120/3048 s of braking, two SYNCs, the slide's own lag, 10 ms to see that it stands
    assert bench.clock.now() - asked < 0.125
    assert axes.sample().fault == ""
    assert axes.sample().enabled


def test_late_sync_is_caught_up_without_a_velocity_jump(bench: CanBench) -> None:
    axes, drive = bench.machine.axes, bench.peers.plant.axis_drives["X"]
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.6))
    run(bench, 0.3)
    for _ in range(4):  # nobody feeds for 8 ms, two SYNCs
        bench.clock.advance(TICK)
        bench.peers.process_frames()
    fastest = 0.0
    for _ in range(200):
        bench.tick(TICK)
        fastest = max(fastest, abs(drive.setpoint_velocity))
    assert fastest < 60.0 * 1.03  # a leap over what was missed would be 180
    assert bench.machine.collect_warnings() or bench.machine.axes.follower.lag == 0.0  # type: ignore[attr-defined]
    run(bench, 0.5)
    sample = axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(60.0 * 0.62, abs=0.0013)


def test_longer_setpoint_gap_is_a_fault_that_stops_all_axes(bench: CanBench) -> None:
    axes, plant = bench.machine.axes, bench.peers.plant
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.6))
    run(bench, 0.3)
    for _ in range(8):  # 16 ms; the drives themselves would wait for 20
        bench.clock.advance(TICK)
        bench.peers.process_frames()
    run(bench, 0.3)
    assert get_fault_code(axes.sample().fault, "driver") == "queue-dry"
    assert not any(drive.power_states.is_powered for drive in plant.axis_drives.values())
    assert plant.servos[0].v == 0.0


def test_setpoint_gap_at_rest_is_not_a_fault(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    run(bench, 0.2)
    for _ in range(8):
        bench.clock.advance(TICK)
        bench.peers.process_frames()
    run(bench, 0.3)
    assert axes.sample().fault == ""
    assert axes.sample().enabled


def test_host_failure_stops_the_drives_by_their_own_timeout() -> None:
    bench = CanBench(cyclic())
    axes, plant = bench.machine.axes, bench.peers.plant
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.6))
    run(bench, 0.3)
    silent = bench.clock.now()
    while any(drive.power_states.is_powered for drive in plant.axis_drives.values()):
        bench.clock.advance(TICK)
        bench.peers.process_frames()
    assert bench.clock.now() - silent < 0.2  # 20 ms of time-out and the ramp: our third heartbeat is at 300
    bench.close()


def test_drives_without_a_setpoint_timeout_stop_by_heartbeat_timeout() -> None:
    bench = CanBench(cyclic(drive="epos4"))
    axes, plant = bench.machine.axes, bench.peers.plant
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.6))
    run(bench, 0.3)
    before = bench.peers.machine.get_true_positions()[0]
    for _ in range(300):
        bench.clock.advance(TICK)
        bench.peers.process_frames()
    assert bench.peers.machine.get_true_positions()[0] - before < 60.0 * 0.02  # two setpoints and the braking
    assert not any(drive.power_states.is_powered for drive in plant.axis_drives.values())
    bench.close()


def test_homing_clears_the_old_target_position() -> None:
    """Its count leaps at home; a setpoint of before would send it back over the whole way."""
    bench = CanBench(cyclic("csp", drive="epos4", absolute=False))
    axes, drive = bench.machine.axes, bench.peers.plant.axis_drives["Z"]
    axes.enable(True)
    run(bench, 0.1)
    axes.home("Z")
    fastest, fault = 0.0, ""
    for _ in range(20000):
        bench.tick(TICK)
        fastest = max(fastest, abs(drive.setpoint_velocity))
        fault = axes.sample().fault
        if axes.sample().homed[1] or fault:
            break
    run(bench, 0.3)
    assert axes.sample().homed[1], fault
    assert fastest < 26.0  # 60 in/min are 25.4 mm/s
    assert axes.sample().actual[1] == pytest.approx(0.0, abs=0.002)
    assert drive.values[0x6099, 1] == 300  # rpm: 60 in/min, .2 in a turn
    bench.close()


def test_axis_moved_without_power_stays_in_place_when_enabled(bench: CanBench) -> None:
    axes, plant = bench.machine.axes, bench.peers.plant
    axes.enable(True)
    run(bench, 0.1)
    axes.enable(False)
    run(bench, 0.1)
    plant.servos[0].push(3.0)
    run(bench, 0.1)
    axes.enable(True)
    run(bench, 0.2)
    assert bench.peers.machine.get_true_positions()[0] == pytest.approx(3.0, abs=0.002)
    assert axes.sample().fault == ""


def test_drive_that_does_not_interpolate_is_reported() -> None:
    bench = CanBench(cyclic("ip"))
    drive = bench.peers.plant.axis_drives["X"]
    drive._is_cyclic = lambda: False  # type: ignore[method-assign]
    bench.machine.axes.enable(True)
    run(bench, 0.5)
    fault = bench.machine.axes.sample().fault
    assert get_fault_code(fault, "driver") == "queue-dry"
    assert fault.startswith("X: ")
    bench.close()


def test_each_setpoint_is_sent_once_before_its_sync(bench: CanBench) -> None:
    """On the wire: SYNC, then each drive's command once, every 4 ms."""
    frames: list[int] = []
    pump = bench.peers.network.bus
    assert pump is not None
    receive = pump.recv

    def heard(timeout: float) -> object:
        message = receive(timeout)
        if message is not None and message.arbitration_id in {0x80, 0x201, 0x202}:
            frames.append(message.arbitration_id)
        return message

    pump.recv = heard  # type: ignore[method-assign, assignment]
    bench.machine.axes.enable(True)
    run(bench, 0.1)
    frames.clear()
    run(bench, 0.4)
    assert frames.count(0x80) == 100
    start = frames.index(0x80)
    rounds = [frames[i : i + 3] for i in range(start, len(frames) - 2, 3)]
    assert all(each == [0x80, 0x201, 0x202] for each in rounds)


def test_sync_schedule_does_not_drift_after_a_late_sync() -> None:
    schedule = SyncSchedule(0.002, 10.0)
    assert schedule.record_sync(10.0) == 0.0
    assert schedule.record_sync(10.0024) == 0.0  # a fifth of a period late
    assert schedule.due_time_s == pytest.approx(10.004)
    assert schedule.record_sync(10.0101) == pytest.approx(0.0057)
    assert schedule.due_time_s == pytest.approx(10.012)
    assert schedule.max_delay_s == pytest.approx(0.0061)
    assert schedule.record_sync(10.0121) == 0.0  # as late as the last: an interval of a period


def test_constant_sync_delay_is_absorbed_by_the_schedule() -> None:
    schedule = SyncSchedule(0.002, 0.0)
    assert schedule.record_sync(0.001) == pytest.approx(0.001)
    assert all(schedule.record_sync(0.001 + 0.002 * n) == pytest.approx(0.0, abs=1e-12) for n in range(1, 50))


def test_drive_timeouts_are_written_to_their_objects() -> None:
    bench = CanBench(cyclic())
    assert bench.peers.plant.axis_drives["Z"].values[od.SYNC_PERIOD, 0] == 4000
    bench.close()
