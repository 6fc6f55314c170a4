"""Threads in the time law: a lead counts along Z."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import MotionError
from core.motion.motion_plan import plan_motion
from tests.coded import raises_code
from tests.motion.moves import LIMITS, Point, line
from tests.motion.paths import build_path


def thread(end: Point, rpm: float = 600.0) -> Block:
    """From the origin at 2 mm a turn."""
    return replace(line((0, 0), end, 2.0, kind=BlockKind.THREAD), rpm=rpm)


def test_thread_feed_is_lead_times_speed() -> None:
    path = build_path([thread((0, -40))], LIMITS)
    assert path.pieces.rate.tolist() == pytest.approx([20.0])


def test_tapered_thread_has_its_lead_along_z() -> None:
    path = build_path([thread((30, -40))], LIMITS)
    assert path.pieces.rate.tolist() == pytest.approx([20.0 * 50 / 40])
    profile = plan_motion(path)
    middle = profile.compute_positions(0.5 * profile.duration_s + np.array([0.0, 0.1]))
    assert middle[0][1] - middle[1][1] == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("start", "end"), [((7.0, 5.0), (7.0, 0.0)), ((0.0, -3.0), (4.0, 0.0)), ((6.0, 0.0), (3.0, -4.0))]
)
def test_lead_is_measured_along_z_at_any_start(start: Point, end: Point) -> None:
    """Ways of 5 mm along 5, 3 and 4 mm of Z."""
    block = replace(line(start, end, 2.0, kind=BlockKind.THREAD), rpm=600.0)
    way = 5.0 if start[0] == end[0] else float(np.hypot(end[0] - start[0], end[1] - start[1]))
    path = build_path([block], LIMITS)
    assert path.pieces.rate.tolist() == pytest.approx([20.0 * way / abs(end[1] - start[1])])


@pytest.mark.parametrize("z", [0.0, 4.0])
def test_thread_perpendicular_to_z_is_rejected(z: float) -> None:
    with raises_code(MotionError, "no-lead"):
        build_path([replace(line((1.0, z), (5.0, z), 2.0, kind=BlockKind.THREAD), rpm=600.0)], LIMITS)


def test_thread_without_z_travel_is_rejected() -> None:
    with raises_code(MotionError, "no-lead", "Block 1"):
        build_path([thread((5, 0))], LIMITS)


def test_thread_with_stopped_spindle_is_rejected() -> None:
    with raises_code(MotionError, "spindle-stopped", "Block 1"):
        build_path([thread((0, -5), 0.0)], LIMITS)
