"""The closed form of the simulated servo against its steps, and the limits at which it is not used."""

from __future__ import annotations

import dataclasses

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.lookalikes.servo_axis import Servo
from drivers.lookalikes.servo_response import ServoLoop, Setpoints
from tests.drivers.machines import SLIDE

DT = 0.001  # s
NEAR = 1e-9  # mm, and mm/s per 1000


def moving(p: float, v: float) -> Servo:
    servo = Servo(SLIDE, DT)
    servo.p, servo.v = p, v
    return servo


@given(
    start=st.floats(-50.0, 50.0),
    speed=st.floats(-60.0, 60.0),
    off=st.floats(-0.05, 0.05),
    accel=st.floats(-600.0, 600.0),
    steps=st.integers(1, 200),
)
def test_one_evaluation_is_as_many_steps(
    start: float, speed: float, off: float, accel: float, steps: int
) -> None:
    setpoints = Setpoints(start + off, speed * DT, 0.5 * accel * DT * DT)
    stepped, glided = moving(start, speed), moving(start, speed)
    response = glided.foresee(setpoints, steps)
    if response is None:
        return
    glided.glide(setpoints, response, steps)
    for k in range(steps):
        t = k * DT
        assert not stepped.follow(start + off + (speed + 0.5 * accel * t) * t, speed + accel * t, DT)
    assert glided.p == pytest.approx(stepped.p, abs=NEAR)
    assert glided.v == pytest.approx(stepped.v, abs=1000 * NEAR)
    assert glided.load == pytest.approx(stepped.load, abs=1e-4)
    assert glided.over == 0.0


def test_an_even_move_is_foreseen() -> None:
    assert moving(0.0, 100.0).foresee(Setpoints(0.08, 0.1, 0.0), 1000) is not None


@pytest.mark.parametrize(
    ("p", "v", "setpoints"),
    [
        (0.0, 0.0, Setpoints(3.0, 0.0, 0.0)),  # beyond the following window
        (0.0, 0.0, Setpoints(0.5, 0.0, 0.0)),  # more force than the drive has
        (0.0, 120.0, Setpoints(0.0, 0.15, 0.0)),  # faster than the axis
        (0.0, 0.0, Setpoints(0.0, 0.0, 0.01)),  # harder than the drive accelerates
    ],
)
def test_where_a_limit_may_act_it_is_stepped(p: float, v: float, setpoints: Setpoints) -> None:
    assert moving(p, v).foresee(setpoints, 50) is None


@pytest.mark.parametrize(
    "fault", [{"jammed": True}, {"runaway": 1.0}, {"stuck": 0.0}], ids=["jammed", "runaway", "stuck"]
)
def test_a_faulty_slide_is_stepped(fault: dict[str, float]) -> None:
    servo = moving(0.0, 0.0)
    for name, value in fault.items():
        setattr(servo, name, value)
    assert servo.foresee(Setpoints(0.0, 0.0, 0.0), 10) is None


@pytest.mark.parametrize("worn", ["gib", "ripple", "missed"])
def test_a_worn_slide_is_stepped(worn: str) -> None:
    servo = moving(0.0, 0.0)
    setattr(servo.worn, worn, 0.01)
    assert servo.foresee(Setpoints(0.0, 0.0, 0.0), 10) is None


def test_a_loop_that_would_oscillate_is_refused_and_its_axis_is_stepped() -> None:
    with pytest.raises(ValueError, match=r"0\.5"):
        ServoLoop(0.5, 1.0)
    stiff = Servo(dataclasses.replace(SLIDE, bandwidth=100.0), DT)
    assert stiff.foresee(Setpoints(0.0, 0.0, 0.0), 10) is None
