"""Drive tests: held as a jog is, back where they began, refused where a jog or its travel forbids it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.executor.commands import (
    Command,
    FeedHold,
    Jog,
    JogByStep,
    RenewDriveTest,
    Reset,
    RunDriveTest,
    SelectHandwheel,
    StopJog,
)
from core.executor.hand_motion.drive_test import (
    PAUSE_BETWEEN_MOVES_S,
    AxisTestLimits,
    DriveTestMotion,
    Shape,
    compute_duration_s,
    compute_position_range,
    make_braking_ramp,
    slice_ramps,
)
from core.executor.snapshot import MachineState
from tests.executor.rig import FINE, INCH, TICK, Rig
from tests.executor.test_jog_steps import nothing_homed
from tests.texts import text

AMAX = 120 * INCH
LEASE = 0.2
STEP = DriveTestMotion("X", Shape.STEP, 0.5)
RAMP = DriveTestMotion("Z", Shape.RAMP, -5.0, speed=20.0)
SINE = DriveTestMotion("X", Shape.SINE, 0.5, frequencies_hz=(5.0,))
LIMITS = AxisTestLimits(max_speed_mm_s=100 * INCH / 60, max_acceleration_mm_s2=AMAX, sample_rate_hz=1000.0)


def ready() -> Rig:
    rig = Rig(every=FINE)
    rig.ready()
    return rig


def hold(rig: Rig, path: DriveTestMotion, most: float = 30.0) -> tuple[list[float], np.ndarray]:
    """Held until it is over, or for ``most`` s: times and demand."""
    rig.post(RunDriveTest(path, LEASE))
    times, seen = [], []
    began = rig.clock.now()
    while rig.state is MachineState.JOG and rig.clock.now() - began < most:
        times.append(rig.clock.now())
        seen.append(rig.sim.ports.axes.sample().demand)
        rig.post(RenewDriveTest(LEASE))
    return times, np.array(seen)


# --- what is played -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", [STEP, RAMP, SINE])
def test_drive_test_travels_its_size_and_returns_to_its_start(path: DriveTestMotion) -> None:
    rig = ready()
    _, seen = hold(rig, path)
    assert rig.state is MachineState.IDLE
    assert rig.said("refused") == []
    assert rig.said("test") == [text("executor.test-kind", axis=path.axis)]
    assert rig.shot.drive_test.completed_test_count == 1
    index, other = (0, 1) if path.axis == "X" else (1, 0)
    assert rig.shot.demand[index] == pytest.approx(0.0, abs=1e-9)
    assert rig.shot.demand[other] == 0.0
    extreme = seen[:, index].max() if path.travel_mm > 0.0 else seen[:, index].min()
    # a tick beside its crest a sine of 5 Hz lacks s/2·(1 − cos(π/10)) at most, and .2 % by its pieces
    lacks = 0.25 * (1.0 - math.cos(math.pi / 10.0)) + 0.001 if path is SINE else 1e-9
    assert abs(extreme - path.travel_mm) <= lacks
    assert (seen[:, index] * math.copysign(1.0, path.travel_mm)).min() >= -1e-9


def test_step_duration_follows_from_the_acceleration() -> None:
    """Speeding up over half of the way: s = 2·½·a·(t/2)², so t = 2·√(s/a), and no faster than the hand."""
    ramps = STEP.make_ramps(LIMITS)
    peak = math.sqrt(0.5 * AMAX)
    assert peak < LIMITS.max_speed_mm_s
    assert compute_duration_s(ramps) == pytest.approx(
        2.0 * (2.0 * math.sqrt(0.5 / AMAX) + PAUSE_BETWEEN_MOVES_S)
    )


def test_sine_pieces_follow_the_sine_curve() -> None:
    """s/2·(1 − cos ωt) and its velocity, at the ends of pieces; the place is short by (ω dt)²/12."""
    frequency, size = 2.0, 1.0
    ramps = DriveTestMotion("X", Shape.SINE, size, frequencies_hz=(frequency,)).make_ramps(LIMITS)
    omega, t, p = 2.0 * math.pi * frequency, 0.0, 0.0
    for dt, v, a in ramps[:-1]:
        assert v == pytest.approx(0.5 * size * omega * math.sin(omega * t), abs=1e-9)
        short = (omega * dt) ** 2 / 12.0
        assert p == pytest.approx(0.5 * size * (1.0 - math.cos(omega * t)), abs=1.01 * short * size)
        p, t = p + (v + 0.5 * a * dt) * dt, t + dt
    assert p == pytest.approx(0.0, abs=1e-9)
    assert t * frequency == pytest.approx(5.0)


def test_sine_beyond_the_axis_limits_is_reduced() -> None:
    """An acceleration of s/2·ω² leaves s = 2a/ω² at 40 Hz."""
    path = DriveTestMotion("X", Shape.SINE, -2.0, frequencies_hz=(2.0, 40.0))
    assert path.compute_sine_travel_mm(40.0, LIMITS) == pytest.approx(-2.0 * AMAX / (80.0 * math.pi) ** 2)
    ramps = path.make_ramps(LIMITS)
    assert max(abs(a) for _, _, a in ramps) <= AMAX * (1.0 + 1e-9)
    assert max(abs(v) for _, v, _ in ramps) <= LIMITS.max_speed_mm_s


def test_interrupted_drive_test_stops_within_its_travel() -> None:
    ramps = DriveTestMotion("X", Shape.SINE, 2.0, frequencies_hz=(2.0, 10.0)).make_ramps(LIMITS)
    low, high = compute_position_range(ramps)
    ends = []
    for begun in np.arange(0.0, compute_duration_s(ramps), 0.0037):
        kept = slice_ramps(ramps, 0.0, float(begun))
        kept += make_braking_ramp(kept, AMAX)
        ends.append(sum((v + 0.5 * a * dt) * dt for dt, v, a in kept))
        if kept:
            dt, v, a = kept[-1]
            assert v + a * dt == pytest.approx(0.0, abs=1e-9)
    assert low - 1e-9 <= min(ends) <= 0.0
    assert 1.9 < max(ends) <= high + 1e-9 <= 2.0 + 1e-8


# --- held, as a jog -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("stopper", [StopJog(), FeedHold(), Reset()])
def test_released_drive_test_brakes_in_place_and_is_reported(stopper: Command) -> None:
    rig = ready()
    hold(rig, RAMP, most=0.1)
    assert rig.state is MachineState.JOG
    rig.post(stopper)
    assert rig.until(MachineState.IDLE) < 0.03 + 20.0 / AMAX + 3 * TICK
    assert -5.0 < rig.shot.demand[1] < -0.5
    assert rig.said("refused") == [text("executor.test-cut-short", axis="Z")]
    assert rig.shot.drive_test.completed_test_count == 0


def test_drive_test_stops_within_its_lease_when_the_host_dies() -> None:
    rig = ready()
    rig.post(RunDriveTest(RAMP, LEASE))
    began = rig.sim.ports.axes.sample().demand[1]
    rig.clock.advance(LEASE + 0.03 + 20.0 / AMAX + 0.1)  # and until the slide has settled
    sample = rig.sim.ports.axes.sample()
    assert not sample.moving
    assert abs(sample.demand[1] - began) < 20.0 * (LEASE + 0.03)
    rig.until(MachineState.IDLE)
    assert rig.said("refused") == [text("executor.test-cut-short", axis="Z")]


@pytest.mark.parametrize("late", [0.07, 0.08, 0.09, 0.14])
def test_expired_lease_cannot_be_renewed(late: float) -> None:
    """What is committed is as good as over: a tick before its end nothing can be added any more."""
    rig = ready()
    rig.post(RunDriveTest(RAMP, 0.1))
    rig.run(late)
    rig.post(RenewDriveTest(LEASE))
    rig.until(MachineState.IDLE, limit=0.3)
    assert rig.shot.alarms == ()
    assert rig.shot.demand[1] > -4.0


def test_renewal_after_release_is_ignored() -> None:
    rig = ready()
    hold(rig, RAMP, most=0.1)
    rig.post(StopJog(), RenewDriveTest(LEASE), RenewDriveTest(LEASE))
    rig.until(MachineState.IDLE, limit=0.1)
    assert rig.shot.alarms == ()
    assert rig.shot.demand[1] > -4.0


def test_renewal_never_starts_a_drive_test() -> None:
    rig = ready()
    rig.post(RenewDriveTest(LEASE))
    rig.run(0.5)
    assert rig.state is MachineState.IDLE
    hold(rig, STEP)
    rig.post(RenewDriveTest(LEASE))  # the key is still down when it is over
    rig.run(0.5)
    assert (rig.shot.drive_test.number, rig.shot.drive_test.completed_test_count) == (1, 1)
    assert rig.state is MachineState.IDLE


def test_following_error_trips_during_a_drive_test() -> None:
    rig = ready()
    rig.post(RunDriveTest(RAMP, LEASE))
    rig.sim.machine.jam("Z")
    for _ in range(60):
        rig.post(RenewDriveTest(LEASE))
    assert rig.state is MachineState.FAULT
    assert "Z" in rig.shot.alarms[0].cause
    assert rig.shot.drive_test.tested_axis == "" or rig.state is MachineState.FAULT


def test_estop_stops_a_drive_test_and_rejects_another() -> None:
    rig = ready()
    hold(rig, SINE, most=0.3)
    rig.sim.machine.press_estop()
    rig.run(0.5)
    assert rig.state is MachineState.ESTOP
    assert not rig.sim.ports.axes.sample().enabled
    rig.post(RunDriveTest(STEP, LEASE))
    assert rig.said("refused")[-1] == text("executor.no-jog", state="E-STOP")


@pytest.mark.parametrize(
    "other", [Jog("Z", 5.0, LEASE), JogByStep("X", 0.1, 5.0), RunDriveTest(STEP, LEASE), Jog("X", 5.0, LEASE)]
)
def test_any_other_motion_command_ends_the_drive_test(other: Command) -> None:
    rig = ready()
    hold(rig, SINE, most=0.3)
    rig.post(other)
    assert rig.until(MachineState.IDLE, limit=0.3) < 0.3
    assert rig.said("refused")
    stood = rig.shot.demand
    rig.run(0.5)
    assert rig.shot.demand == stood


# --- refusals -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "why"),
    [
        (DriveTestMotion("B", Shape.STEP, 0.5), text("executor.no-jog-axis", axis="B")),
        (DriveTestMotion("C", Shape.STEP, 0.5), text("executor.rotary", axis="C")),
        (DriveTestMotion("X", Shape.STEP, 0.0), text("executor.test-size", mm="2.54")),
        (DriveTestMotion("X", Shape.STEP, 2.6), text("executor.test-size", mm="2.54")),
        (DriveTestMotion("X", Shape.STEP, math.nan), text("executor.test-size", mm="2.54")),
        (DriveTestMotion("X", Shape.RAMP, 26.0, speed=5.0), text("executor.test-size", mm="25.4")),
        (DriveTestMotion("X", Shape.RAMP, 1.0), text("executor.ramp-speed", speed=42)),
        (DriveTestMotion("X", Shape.RAMP, 1.0, speed=1e4), text("executor.ramp-speed", speed=42)),
        (
            DriveTestMotion("X", Shape.RAMP, 0.1, speed=20.0),
            text("executor.test-too-short", mm="0.1", speed=20),
        ),
        (DriveTestMotion("X", Shape.SINE, 0.5), text("executor.sine-range")),
        (DriveTestMotion("X", Shape.SINE, 0.5, frequencies_hz=(math.nan,)), text("executor.sine-range")),
        (
            DriveTestMotion("X", Shape.SINE, 0.5, frequencies_hz=(150.0,)),
            text("executor.too-few-samples", rate=1000, hz=150),
        ),
    ],
)
def test_invalid_drive_tests_are_rejected(path: DriveTestMotion, why: str) -> None:
    rig = ready()
    rig.post(RunDriveTest(path, LEASE))
    rig.run(0.3)
    assert why in rig.said("refused")[0]
    assert rig.shot.demand == (0.0, 0.0, 0.0)
    assert rig.state is MachineState.IDLE


@pytest.mark.parametrize("lease", [0.0, -1.0, math.nan, math.inf])
def test_invalid_lease_is_rejected(lease: float) -> None:
    rig = ready()
    rig.post(RunDriveTest(STEP, lease))
    assert rig.said("refused") == [text("executor.drive-test", why=text("executor.test-lease"))]


def test_drive_test_including_braking_must_fit_in_the_travel() -> None:
    """Half a millimetre before the end of the travel; a hundredth is kept from it."""
    rig = ready()
    x = rig.machine.find_axis("X")
    assert x.travel is not None
    for _ in range(600):
        rig.executor.post(Jog("X", 40.0, 0.2))
        rig.tick()
    rig.until(MachineState.IDLE)
    rig.post(JogByStep("X", -0.5, 10.0))
    rig.until(MachineState.IDLE)
    here = rig.shot.demand
    for size, fits in ((0.49, True), (0.52, False)):
        rig.events.clear()
        hold(rig, DriveTestMotion("X", Shape.STEP, size))
        assert (rig.said("refused") == []) is fits
        assert rig.shot.demand == pytest.approx(here, abs=1e-9)
    assert text("executor.test-travel", axis="X", mm="0.520", sign="+") in rig.said("refused")[0]
    rig.events.clear()
    hold(rig, DriveTestMotion("X", Shape.SINE, -2.0, frequencies_hz=(5.0,)))
    assert rig.said("refused") == []


def test_an_axis_that_is_not_homed_is_not_tested() -> None:
    rig = Rig(nothing_homed())
    rig.ready()
    rig.post(RunDriveTest(STEP, LEASE))
    assert text("executor.test-not-homed", axis="X") in rig.said("refused")[0]


def test_drive_test_is_rejected_while_the_spindle_turns() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S500\nM02\n")
    rig.until(MachineState.IDLE)
    rig.post(RunDriveTest(STEP, LEASE))
    assert rig.said("refused") == [text("executor.drive-test", why=text("executor.spindle-turns-stop"))]


def test_opening_the_guard_ends_a_drive_test() -> None:
    rig = ready()
    hold(rig, RAMP, most=0.1)
    rig.executor._context.spindle.is_guard_open = True
    rig.executor._control.drive_tester.stop_if_guard_open()
    assert rig.executor._control.jogger.is_stopping
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[1] > -4.0


@pytest.mark.parametrize("command", [RunDriveTest(STEP, LEASE), RenewDriveTest(LEASE)])
def test_drive_test_is_rejected_while_a_program_runs(command: Command) -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F60Z-1\nM00\nM30\n")
    rig.run(0.2)
    rig.post(command)
    assert rig.said("refused") == (
        [text("executor.no-jog", state="RUNNING")] if isinstance(command, RunDriveTest) else []
    )
    rig.until(MachineState.PROGRAM_STOP)
    rig.post(command)
    rig.run(0.3)
    assert rig.shot.demand[0] == 0.0


def test_late_drive_test_command_is_rejected() -> None:
    rig = ready()
    rig.executor.post(RunDriveTest(STEP, LEASE))
    rig.clock.advance(0.6)
    rig.executor.run_tick()
    rig.run(0.2)
    assert rig.shot.demand[0] == 0.0
    assert text("executor.came-too-late", command="RunDriveTest") in rig.said("refused")[0]


def test_handwheel_does_not_move_the_axis_during_a_drive_test() -> None:
    rig = ready()
    hold(rig, SINE, most=0.2)
    rig.post(SelectHandwheel("X", 0.01, LEASE))
    rig.run(0.3)
    assert rig.shot.drive_test.completed_test_count == 0
