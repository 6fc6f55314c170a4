"""Chains of threads as a curve over the turns of the spindle, and the way of both slides along it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest

from core.executor.program_motion.setpoint_motion import SetpointMotion
from core.executor.program_motion.thread_curve import build_thread_curve
from core.executor.program_motion.thread_path import ThreadPath, ThreadRetract
from core.executor.raised_alarm import AlarmError
from core.executor.spindle_control import SpindleRequest
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.motion.axis_limits import MotionLimits
from core.ports import MotionSegments
from tests.coded import raises_code
from tests.executor.played_controller import context_of
from tests.texts import text

A = 3048.0
LIMITS = MotionLimits(vmax=(127.0, 127.0, 1200.0), amax=(A, A, 12000.0))


def thread(n: int, z0: float, z: float, lead: float, **words: object) -> Block:
    """At one turn a second; machine and program coordinates are the same."""
    values: dict[str, object] = {
        **{"x0": 5.0, "x": 5.0, "c0": 0.0, "c": 0.0, "offset_x": 0.0, "offset_z": 0.0, "line": n, "text": ""},
        **{
            "modal": ModalState(metric=True),
            "kind": BlockKind.THREAD,
            "per_rev": True,
            "rpm": 60.0,
            "continues": n > 1,
        },
    }
    return Block(**{**values, "n": n, "z0": z0, "z": z, "feed": lead, **words})  # type: ignore[arg-type]


def place(way: MotionSegments, t: float) -> tuple[float, float]:
    """X and Z at a time."""
    i = max(int(np.searchsorted(way.start_times_s, t, side="right")) - 1, 0)
    u = min(t - float(way.start_times_s[i]), float(way.durations_s[i]))
    x, z, _ = way.positions[i] + (way.velocities[i] + 0.5 * way.accelerations[i] * u) * u
    return float(x), float(z)


# Four turns of lead 1, then two of lead 2: six turns, 8 mm.
CHAIN = [thread(1, 0.0, -4.0, 1.0), thread(2, -4.0, -8.0, 2.0)]
OUT = thread(3, -8.0, -8.0, 40.0, kind=BlockKind.RAPID, x=9.0, per_rev=False, continues=False)


def test_z_follows_the_next_lead_after_a_joint() -> None:
    curve = build_thread_curve(CHAIN, LIMITS)
    assert curve.length_mm == pytest.approx(6.0)
    for s, z, lead in ((2.0, -2.0, -1.0), (5.0, -6.0, -2.0)):
        assert curve.evaluate_curve(s) == pytest.approx((5.0, z, 0.0, lead))
        assert curve.find_curve_position(z) == pytest.approx(s)
    assert curve.compute_max_acceleration(A, A) == pytest.approx(A / 2)  # Z goes twice as fast as s


def test_joint_is_rounded_using_half_of_the_acceleration() -> None:
    """From 1 to 2 mm/s at A/2 takes 2/A s, so 1/A mm of s on each side; in its middle Z is 1/4A behind."""
    curve = build_thread_curve(CHAIN, LIMITS)
    assert curve.curve_positions_mm[1] == pytest.approx(4.0 - 1.0 / A)
    assert curve.curve_positions_mm[-2] == pytest.approx(4.0 + 1.0 / A)
    assert curve.evaluate_curve(4.0)[1] == pytest.approx(-4.0 - 0.25 / A, abs=1e-9)


def test_joint_rounding_is_set_by_the_axis_that_changes_speed_most() -> None:
    """A cylinder goes over into 45 degrees outwards: from 0 to 1 mm/s of X at half of A/4 takes 8/A s."""
    cone = [thread(1, 0.0, -4.0, 1.0), thread(2, -4.0, -8.0, 1.0, x=9.0)]
    curve = build_thread_curve(cone, MotionLimits(vmax=(127.0, 127.0, 1200.0), amax=(A / 4.0, A, 12000.0)))
    assert curve.curve_positions_mm[1] == pytest.approx(4.0 - 4.0 / A)
    assert curve.curve_positions_mm[-2] == pytest.approx(4.0 + 4.0 / A)
    assert curve.evaluate_curve(4.0)[0] == pytest.approx(5.0 + 1.0 / A, abs=1e-9)


def test_joint_without_a_change_is_unchanged() -> None:
    same = [thread(1, 0.0, -4.0, 1.0), thread(2, -4.0, -6.0, 1.0)]
    assert build_thread_curve(same, LIMITS).curve_positions_mm.tolist() == [0.0, 4.0, 6.0]


def test_growing_lead_is_followed_per_revolution() -> None:
    """From 1 mm on .5 mm more a turn: (1 + q/4)·q, 1.25 mm in a turn and 3 mm in two; 1.5 on average."""
    curve = build_thread_curve([thread(1, 0.0, -3.0, 1.5, growth=0.5)], LIMITS)
    assert len(curve.curve_positions_mm) == 33  # sixteen a turn
    assert curve.length_mm == pytest.approx(2.0)
    assert curve.evaluate_curve(1.0)[1] == pytest.approx(-1.25)
    assert curve.evaluate_curve(2.0)[1] == pytest.approx(-3.0)


@pytest.mark.parametrize("block", [thread(1, -4.0, -4.0, 1.0), thread(1, 0.0, -4.0, 0.0)])
def test_thread_without_length_or_lead_is_rejected(block: Block) -> None:
    with raises_code(AlarmError, "program", text("executor.thread-nothing")):
        ThreadPath.from_blocks([block], LIMITS)


def test_axes_follow_a_thread_chain_and_leave_it_by_its_rapid() -> None:
    """At 1 mm/s of s: Z −2 after two seconds, −6 after five, at rest at −8; then X goes out to 9."""
    path = ThreadPath.from_blocks([*CHAIN, OUT], LIMITS)
    assert (path.lead_mm, path.z_direction, path.retract_x_mm, path.exit_length_mm) == (1.0, -1.0, 9.0, 0.0)
    way, left = path.plan_remaining_pass(0.0, 0.0, 1.0, [])
    assert place(way, 2.0) == pytest.approx((5.0, -2.0))
    assert place(way, 5.0) == pytest.approx((5.0, -6.0))
    assert left == pytest.approx(6.0, abs=0.001)
    assert place(way, 99.0) == pytest.approx((9.0, -8.0))
    assert path.find_position_and_speed(-6.0, -2.0) == pytest.approx((5.0, 1.0))
    back = path.make_retract()
    assert back is not None
    assert place(back, 0.0) == pytest.approx((5.0, -8.0))
    assert place(back, 99.0) == pytest.approx((9.0, -8.0))


def test_synchronized_pull_out_follows_its_own_path() -> None:
    """1 mm of Z at a lead of 2 is half a turn of the first lead."""
    out = thread(3, -8.0, -9.0, 2.0, x=6.0, continues=False)
    path = ThreadPath.from_blocks([*CHAIN, out], LIMITS)
    assert path.exit_length_mm == pytest.approx(0.5)
    assert path.make_retract() is None
    way, left = path.plan_remaining_pass(0.0, 0.0, 1.0, [])
    assert place(way, left) == pytest.approx((5.0, -8.0))
    assert place(way, 99.0) == pytest.approx((6.0, -9.0))


def test_stop_in_a_thread_chain_follows_the_chain() -> None:
    """At s 5 with 1 mm/s; s brakes with A/2: 1/A mm further, of which Z makes two."""
    path = ThreadPath.from_blocks([*CHAIN, OUT], LIMITS)
    assert place(path.make_stop_setpoints(0.0, 5.0, 1.0), 99.0) == pytest.approx(
        (5.0, -6.0 - 2.0 / A), abs=1e-9
    )


def retract(measured: float, behind: Sequence[Block], **words: object) -> ThreadRetract:
    """S600 is asked, so much is measured."""
    spindle = context_of(None).spindle
    spindle.request_speed(SpindleRequest(600.0))
    spindle.commanded_rpm, spindle.measured_rpm = 600.0, measured
    return ThreadRetract.from_block(thread(1, 0.0, -4.0, 1.0, **words), behind, spindle)


@pytest.mark.parametrize(
    ("measured", "why"),
    [
        (-300.0, text("executor.wrong-direction", rpm=300)),
        (20.0, text("executor.spindle-fell", rpm=20, ordered=600)),
    ],
)
def test_reason_for_leaving_a_thread_is_reported(measured: float, why: str) -> None:
    lost = retract(measured, [OUT])
    lost.require_axes_in_thread((8.0, -2.0, 0.0))  # not out yet
    with raises_code(AlarmError, "thread-lost", text("executor.left-thread", why=why, z="-2.000")):
        lost.require_axes_in_thread((9.0, -2.0, 0.0))


def test_thread_left_in_its_pull_out_is_reported_in_program_units() -> None:
    fell = text("executor.spindle-fell", rpm=20, ordered=600)
    with raises_code(AlarmError, "thread-lost", text("executor.thread-cut", why=fell)):
        retract(20.0, []).require_axes_in_thread((5.0, -4.0, 0.0))
    inch = retract(20.0, [OUT], modal=ModalState(metric=False))
    with raises_code(AlarmError, "thread-lost", text("executor.left-thread", why=fell, z="-0.1000")):
        inch.require_axes_in_thread((9.0, -2.54, 0.0))
    way = inch.make_retract_block((5.0, -2.54, 0.0))
    assert (way.x0, way.z0, way.x, way.z) == (5.0, -2.54, 9.0, -2.54)
    assert not math.isclose(way.feed, 0.0)


class BrakingAxes:
    """Axes that brake until 1 s; the clock of the axes is at 2 s."""

    def now(self) -> float:
        return 2.0

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        z = -10.0 - min(t, 1.0)
        return (5.0, z, 0.0), (0.0, 0.0 if t >= 1.0 else -1.0, 0.0)


def test_late_tick_retracts_the_tool_from_its_rest_position(monkeypatch: pytest.MonkeyPatch) -> None:
    """The time of the tick is before the end of the braking; the axes are at rest when they are asked."""
    begun: list[Block] = []
    motion = object.__new__(SetpointMotion)
    monkeypatch.setattr(motion, "_axes", BrakingAxes(), raising=False)
    monkeypatch.setattr(motion, "_context", SimpleNamespace(now=0.5), raising=False)
    monkeypatch.setattr(motion, "_retract", retract(0.0, [OUT]), raising=False)
    monkeypatch.setattr(motion, "_begin_section", begun.extend)
    monkeypatch.setattr(motion, "_splice", lambda _overrides, _last: None)
    motion.continue_retract()
    (block,) = begun
    assert (block.x0, block.z0, block.x, block.z) == (5.0, -11.0, 9.0, -11.0)
