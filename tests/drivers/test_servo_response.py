"""The closed form of the simulated servo against its steps, and the limits at which it is not used."""

from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from drivers.simulators.plant_config import SimAxis
from drivers.simulators.servo_axis import ServoLoop, SetpointPolynomial, SimulatedServo
from tests.drivers.machines import SLIDE

DT = 0.001  # s
NEAR = 1e-9  # mm, and mm/s per 1000


def moving(p: float, v: float) -> SimulatedServo:
    servo = SimulatedServo(SLIDE, DT)
    servo.p, servo.v = p, v
    return servo


@given(
    start=st.floats(-50.0, 50.0),
    speed=st.floats(-60.0, 60.0),
    off=st.floats(-0.05, 0.05),
    accel=st.floats(-600.0, 600.0),
    steps=st.integers(1, 200),
)
def test_predicted_response_matches_stepping(
    start: float, speed: float, off: float, accel: float, steps: int
) -> None:
    setpoints = SetpointPolynomial(start + off, speed * DT, 0.5 * accel * DT * DT)
    stepped, glided = moving(start, speed), moving(start, speed)
    response = glided.predict_response(setpoints, steps)
    assume(response is not None)
    assert response is not None
    glided.apply_response(setpoints, response, steps)
    for k in range(steps):
        t = k * DT
        assert not stepped.follow_setpoint(start + off + (speed + 0.5 * accel * t) * t, speed + accel * t, DT)
    assert glided.p == pytest.approx(stepped.p, abs=NEAR)
    assert glided.v == pytest.approx(stepped.v, abs=1000 * NEAR)
    assert glided.load == pytest.approx(stepped.load, abs=1e-4)
    assert glided.over == 0.0


def test_steady_move_is_predicted() -> None:
    assert moving(0.0, 100.0).predict_response(SetpointPolynomial(0.08, 0.1, 0.0), 1000) is not None


EVEN = SetpointPolynomial(0.017, 0.02, 0.0)  # 20 mm/s; the following error at that speed is 0.016 mm


@pytest.mark.parametrize(
    "limited",
    [
        dataclasses.replace(SLIDE, following_window=0.005),
        dataclasses.replace(SLIDE, amax=20.0),
        dataclasses.replace(SLIDE, vmax=15.0),
    ],
    ids=["window", "force", "speed"],
)
def test_motion_near_a_limit_is_stepped(limited: SimAxis) -> None:
    free, bound = SimulatedServo(SLIDE, DT), SimulatedServo(limited, DT)
    free.v = bound.v = 20.0
    assert free.predict_response(EVEN, 50) is not None
    assert bound.predict_response(EVEN, 50) is None


def test_following_window_includes_the_initial_offset() -> None:
    narrow = SimulatedServo(dataclasses.replace(SLIDE, following_window=0.005), DT)
    assert narrow.predict_response(SetpointPolynomial(0.001, 0.0, 0.0), 50) is not None
    assert narrow.predict_response(SetpointPolynomial(0.006, 0.0, 0.0), 50) is None


@pytest.mark.parametrize(("share", "foreseen"), [(0.9, True), (1.1, False)])
def test_force_of_the_first_step_limits_the_prediction(share: float, foreseen: bool) -> None:
    """In its fast mode alone the servo needs more force in the first step than in all that follow."""
    loop = ServoLoop(2.0 * math.pi * SLIDE.bandwidth_hz * DT, SLIDE.feed_forward_fraction)
    first = share * SLIDE.amax * SLIDE.acceleration_reserve_factor * DT * DT
    p = first * loop.fast_mode / loop.fast_curvature
    servo = moving(p, (p - p / loop.fast_mode) / DT)
    assert (servo.predict_response(SetpointPolynomial(0.0, 0.0, 0.0), 50) is not None) is foreseen


@pytest.mark.parametrize(("accel", "foreseen"), [(1500.0, True), (4000.0, False)])
def test_acceleration_beyond_the_drive_limit_is_stepped(accel: float, foreseen: bool) -> None:
    """The drive has 1.3 times 3048 mm/s²; here the first step needs no force."""
    response = moving(0.0, 0.0).predict_response(SetpointPolynomial(0.0, 0.0, 0.5 * accel * DT * DT), 4)
    assert (response is not None) is foreseen


@pytest.mark.parametrize(
    "fault", [{"jammed": True}, {"runaway": 1.0}, {"stuck": 0.0}], ids=["jammed", "runaway", "stuck"]
)
def test_faulty_axis_is_stepped(fault: dict[str, float]) -> None:
    servo = moving(0.0, 0.0)
    for name, value in fault.items():
        setattr(servo, name, value)
    assert servo.predict_response(SetpointPolynomial(0.0, 0.0, 0.0), 10) is None


@pytest.mark.parametrize("worn", ["gib", "ripple", "missed"])
def test_worn_axis_is_stepped(worn: str) -> None:
    servo = moving(0.0, 0.0)
    setattr(servo.worn, worn, 0.01)
    assert servo.predict_response(SetpointPolynomial(0.0, 0.0, 0.0), 10) is None


def test_oscillating_loop_is_rejected_and_its_axis_is_stepped() -> None:
    with pytest.raises(ValueError, match=r"0\.5"):
        ServoLoop(0.5, 1.0)
    stiff = SimulatedServo(dataclasses.replace(SLIDE, bandwidth_hz=100.0), DT)
    assert stiff.predict_response(SetpointPolynomial(0.0, 0.0, 0.0), 10) is None
