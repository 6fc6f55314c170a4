"""Slides that follow the spindle inside the driver: cams, slipping, what releases and what brakes a gear."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.ports import Cam, DriverError, MotionSegments, SpindleGear, StopMode, is_queue_finished
from drivers.simulated.simulated_machine import Simulation
from drivers.spindle_gear import SpindlePhaseFilter
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.machines import play, ramp, simulation

ZERO = (0.0, 0.0, 0.0)
LEAD = 2.0  # mm a turn


def turning(rpm: float = 600.0) -> tuple[Simulation, ManualClock, SpindleGear]:
    """A lathe whose spindle is up to speed, and its gear."""
    sim, clock = simulation()
    sim.ports.spindle.set_speed(rpm)
    play(sim, clock, 4.0)
    assert sim.ports.gear is not None
    return sim, clock, sim.ports.gear


def cam(sim: Simulation, lead: float = LEAD, turns: float = 10.0, start: float = 1.0) -> Cam:
    """Z, from ``start`` turns ahead: half a turn of running up, ``turns`` in step, half a turn to rest."""
    read = sim.ports.spindle.read_angle()
    assert read is not None
    sign = math.copysign(1.0, sim.machine.get_spindle_rpm())
    a = 2.0 * lead
    z = np.array([0.0, 0.25 * lead, (0.25 + turns) * lead])
    v, acc, still = np.array([0.0, lead, lead]), np.array([a, 0.0, -a]), np.zeros(3)
    way = MotionSegments(
        start_times_s=np.array([0.0, 0.5, 0.5 + turns]),
        durations_s=np.array([0.5, turns, 0.5]),
        positions=np.column_stack([still, z, still]),
        velocities=np.column_stack([still, v, still]),
        accelerations=np.column_stack([still, acc, still]),
    )
    return Cam(read[1] + sign * start, sign, way)


def z_of(sim: Simulation, clock: ManualClock) -> float:
    return sim.ports.axes.demand_at(clock.now())[0][1]


@pytest.mark.parametrize("rpm", [600.0, -600.0])
def test_setpoints_follow_the_true_angle(rpm: float) -> None:
    sim, clock, gear = turning(rpm)
    sim.machine.spindle_wander(0.02, 0.5)
    made = cam(sim)
    gear.mesh(made)
    off = []
    for _ in range(150):
        clock.advance(0.01)
        z = z_of(sim, clock)
        if LEAD < z < 10.0 * LEAD:
            turns = made.sign * (sim.machine.spindle_turns() - made.start_revolutions)
            off.append(z - LEAD * (turns - 0.25))  # running up for half a turn covers a quarter of a lead
    assert len(off) > 80
    assert np.abs(off).max() < LEAD * 0.0003  # a tenth of a degree
    assert gear.geared() is None
    assert z_of(sim, clock) == pytest.approx(10.5 * LEAD)
    assert sim.ports.axes.horizon() <= clock.now()


def test_motion_by_time_follows_a_gear_without_delay() -> None:
    sim, clock, gear = turning()
    made = cam(sim)
    end = (0.0, 10.5 * LEAD, 0.0)
    gear.mesh(made._replace(following_segments=ramp(0.0, end, 60.0, 0.2)))
    while gear.geared() is not None:
        clock.advance(0.001)
    clock.advance(0.02)
    assert sim.ports.axes.demand_at(clock.now())[1][0] == pytest.approx(60.0)
    clock.advance(0.22)
    assert sim.ports.axes.demand_at(clock.now())[0] == pytest.approx((60.0 * 0.22, 10.5 * LEAD, 0.0))


def test_stopped_spindle_stops_the_geared_axes() -> None:
    sim, clock, gear = turning()
    gear.mesh(cam(sim, turns=60.0))
    play(sim, clock, 0.5)
    sim.ports.spindle.set_speed(0.0)
    play(sim, clock, 3.0)
    stood = z_of(sim, clock)
    assert stood > LEAD
    play(sim, clock, 2.0)
    assert z_of(sim, clock) == pytest.approx(stood, abs=1e-6)
    assert sim.ports.axes.horizon() == math.inf
    assert sim.ports.axes.sample().fault == ""
    sim.ports.spindle.set_speed(600.0)
    play(sim, clock, 1.0)
    assert z_of(sim, clock) > stood + 4 * LEAD


def test_gear_slips_at_maximum_axis_speed_and_catches_up() -> None:
    sim, clock, gear = turning(600.0)
    gear.mesh(cam(sim, lead=12.6, turns=8.0))  # 126 mm/s of 127
    sim.machine.spindle_wander(0.03, 0.5)
    speeds, lags = [], []
    while gear.geared() is not None:
        clock.advance(0.005)
        speeds.append(sim.ports.axes.demand_at(clock.now())[1][1])
        geared = gear.geared()
        lags.append(geared.lag_revolutions if geared else 0.0)
    assert max(speeds) < 127.0 * 1.001
    assert max(lags) > 0.01
    caught_up = lags[np.argmax(lags) :]
    assert min(caught_up[:-1]) == pytest.approx(0.0, abs=1e-9)
    assert min(lags) > -0.001  # never ahead
    assert sim.ports.axes.sample().fault == ""


def test_later_gear_motion_replaces_the_rest_of_the_first() -> None:
    sim, clock, gear = turning()
    made = cam(sim, turns=60.0)
    gear.mesh(made)
    play(sim, clock, 0.6)
    short = cam(sim, turns=20.0).segments
    cut = MotionSegments(*(part[1:] for part in short))
    at = 8.0
    cut.start_times_s[0], cut.durations_s[0] = at, 20.5 - at
    cut.positions[0, 1] = LEAD * (at - 0.25)
    gear.mesh(made._replace(segments=cut))
    play(sim, clock, 3.0)
    assert z_of(sim, clock) == pytest.approx(20.5 * LEAD)


def test_drive_stop_brakes_a_geared_axis_from_its_position() -> None:
    sim, clock, gear = turning()
    gear.mesh(cam(sim, turns=60.0))
    play(sim, clock, 0.6)
    began = z_of(sim, clock)
    sim.ports.axes.stop(StopMode.RAMP_HOLD)
    assert gear.geared() is None
    play(sim, clock, 0.5)
    speed = LEAD * 10.0
    assert z_of(sim, clock) - began == pytest.approx(speed**2 / 2.0 / 3048.0, abs=1e-3)
    assert sim.ports.axes.sample().enabled


def test_accelerating_spindle_does_not_overload_a_geared_axis() -> None:
    """The way was planned for 600 rpm; at 1600 its braking would take seven times as much."""
    sim, clock, gear = turning(600.0)
    lead = 4.0
    gear.mesh(cam(sim, lead=lead, turns=20.0))
    sim.ports.spindle.set_speed(1600.0)
    speeds, p = [], []
    while gear.geared() is not None:
        clock.advance(0.001)
        (_, z, _), (_, v, _) = sim.ports.axes.demand_at(clock.now())
        speeds.append(v)
        p.append(z)
    assert np.abs(np.diff(speeds)).max() <= 1.25 * 3048.0 * 0.001
    assert max(speeds) > lead * 1500.0 / 60.0
    assert p[-1] == pytest.approx(20.5 * lead)
    assert sim.ports.axes.sample().fault == ""


def test_gear_motion_is_never_reported_as_finished_while_it_is_played() -> None:
    sim, clock, gear = turning()
    gear.mesh(cam(sim))
    sim.ports.spindle.set_speed(150.0)
    while gear.geared() is not None:
        assert not is_queue_finished(sim.ports.axes.horizon(), clock.now())
        clock.advance(0.00037)
    assert is_queue_finished(sim.ports.axes.horizon(), clock.now())


def test_rounding_remainder_of_a_motion_counts_as_rest() -> None:
    """Executor and driver ask by one rule, else a start on a clock of 2.5 ms is refused."""
    sim, clock, gear = turning()
    sim.ports.axes.splice(ramp(clock.now() + 0.03, ZERO, 60.0, 0.1))
    end = sim.ports.axes.horizon()
    clock.advance(end - clock.now() - 1e-9)
    assert sim.ports.axes.horizon() > clock.now()
    assert is_queue_finished(sim.ports.axes.horizon(), clock.now())
    made = cam(sim)
    x = np.array([sim.ports.axes.demand_at(end)[0][0], 0.0, 0.0])
    gear.mesh(made._replace(segments=made.segments._replace(positions=made.segments.positions + x)))
    assert gear.geared() is not None


def test_gear_motion_not_yet_started_is_replaced_completely() -> None:
    """A shorter running up leaves nothing of the longer one before it."""
    sim, clock, gear = turning()
    made = cam(sim, start=3.0)
    early = MotionSegments(*(part.copy() for part in made.segments))
    early.start_times_s[0], early.durations_s[0] = -1.0, 1.5
    early.positions[0, 1], early.accelerations[0, 1] = -0.5 * LEAD, LEAD / 1.5
    gear.mesh(
        made._replace(segments=early._replace(positions=early.positions + np.array([0.0, 0.5 * LEAD, 0.0])))
    )
    gear.mesh(made)
    play(sim, clock, 4.0)
    assert z_of(sim, clock) == pytest.approx(10.5 * LEAD)


# --- refusals -----------------------------------------------------------------------------------------------


def test_gear_to_a_spindle_without_an_encoder_is_rejected() -> None:
    sim, _ = simulation()
    assert sim.ports.gear is not None
    with raises_code(DriverError, "thread-no-encoder"):
        sim.ports.gear.mesh(cam(sim))


def test_gear_to_a_spindle_turning_the_other_way_is_rejected() -> None:
    sim, _, gear = turning(-600.0)
    made = cam(sim)
    with raises_code(DriverError, "thread-no-encoder"):
        gear.mesh(made._replace(sign=1.0))


def test_gear_motion_that_starts_within_the_commit_time_is_rejected() -> None:
    sim, _, gear = turning()  # ten turns a second: .3 turn in 30 ms
    with raises_code(DriverError, "late") as told:
        gear.mesh(cam(sim, start=0.25))
    assert told.value.reason == "too-early"
    assert gear.geared() is None
    gear.mesh(cam(sim, start=0.35))


def test_gear_motion_must_start_at_the_axes_and_end_at_rest() -> None:
    sim, _, gear = turning()
    made = cam(sim)
    with raises_code(DriverError, "driver", "Z: ") as told:
        gear.mesh(
            made._replace(
                segments=made.segments._replace(positions=made.segments.positions + np.array([0.0, 1.0, 0.0]))
            )
        )
    assert told.value.reason == "jump"
    with raises_code(DriverError, "broken-path") as told:
        gear.mesh(made._replace(segments=MotionSegments(*(part[:2] for part in made.segments))))
    assert told.value.reason == "moves-at-end"
    assert gear.geared() is None


def test_different_index_is_rejected_once_the_gear_moves() -> None:
    sim, clock, gear = turning()
    made = cam(sim, turns=60.0)
    gear.mesh(made._replace(start_revolutions=made.start_revolutions + 1.0))
    gear.mesh(made)  # nothing has moved yet
    play(sim, clock, 0.5)
    with raises_code(DriverError, "broken-path") as told:
        gear.mesh(made._replace(start_revolutions=made.start_revolutions + 1.0))
    assert told.value.reason == "other-index"


def test_gear_motion_too_fast_or_out_of_travel_is_rejected() -> None:
    sim, _, gear = turning(1500.0)
    with raises_code(DriverError, "drive-limits", "Z: ") as told:
        gear.mesh(cam(sim, lead=6.0))  # 150 mm/s
    assert told.value.reason == "too-fast"
    with raises_code(DriverError, "drive-limits", "Z: ") as told:
        gear.mesh(cam(sim, turns=100.0))  # to 201 mm
    assert told.value.reason == "leaves-travel"


def test_gear_is_rejected_while_axes_move_by_time() -> None:
    sim, clock, gear = turning()
    sim.ports.axes.splice(ramp(clock.now() + 0.03, ZERO, 60.0, 0.5))
    play(sim, clock, 0.1)
    with raises_code(DriverError, "broken-path") as told:
        gear.mesh(cam(sim))
    assert told.value.reason == "not-at-rest"


def test_setpoints_by_time_release_only_a_waiting_gear() -> None:
    sim, clock, gear = turning()
    gear.mesh(cam(sim, start=5.0))
    with raises_code(DriverError, "broken-path") as told:
        sim.ports.axes.splice(ramp(clock.now() + 1.0, ZERO, 60.0, 0.1))  # will have moved by then
    assert told.value.reason == "follows-spindle"
    sim.ports.axes.splice(ramp(clock.now() + 0.1, ZERO, 60.0, 0.1))
    assert gear.geared() is None
    play(sim, clock, 2.0)
    assert z_of(sim, clock) == 0.0


def test_disabled_drives_do_not_follow_a_gear() -> None:
    sim, clock, gear = turning()
    sim.ports.axes.enable(False)
    with raises_code(DriverError, "power-lost"):
        gear.mesh(cam(sim))
    sim.ports.axes.enable(True)
    gear.mesh(cam(sim))
    play(sim, clock, 0.5)
    sim.machine.press_estop()
    play(sim, clock, 0.5)
    assert gear.geared() is None


# --- the angle ----------------------------------------------------------------------------------------------


def test_filter_recovers_the_angle_of_a_wandering_spindle() -> None:
    def truth(t: float) -> float:
        return 50.0 * (t - 0.02 * 0.25 / (2 * math.pi) * math.cos(2 * math.pi * t / 0.25))  # 3000 rpm

    phase = SpindlePhaseFilter(0.0, truth(0.0), 50.0)
    off = []
    for k in range(1, 2000):
        t = 0.001 * k
        phase.add_reading(t, round(truth(t) * 4096) / 4096)
        off.append(phase.revolutions - truth(t))
    assert np.abs(off[100:]).max() * 360.0 < 0.06
    jerk = 50.0 * 0.02 * (2 * math.pi / 0.25) ** 2  # what the filter trails: jerk over the cube of its pole
    assert np.abs(off[100:]).max() < jerk / 250.0**3 + 1.0 / 4096


def test_filter_follows_an_accelerating_spindle_without_lag() -> None:
    phase = SpindlePhaseFilter(0.0, 0.0, 0.0)
    for k in range(1, 1000):
        phase.add_reading(0.001 * k, 12.5 * (0.001 * k) ** 2)
    assert phase.revolutions == pytest.approx(12.5 * 0.999**2, abs=1e-9)
    assert phase.predict_revolutions(1.009) == pytest.approx(12.5 * 1.009**2, abs=1e-6)


def test_repeated_reading_does_not_change_the_filter() -> None:
    phase = SpindlePhaseFilter(1.0, 5.0, 10.0)
    phase.add_reading(1.0, 7.0)
    phase.add_reading(0.5, 9.0)
    assert (phase.time_s, phase.revolutions, phase.speed_rev_per_s) == (1.0, 5.0, 10.0)
