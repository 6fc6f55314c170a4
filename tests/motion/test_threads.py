"""Threads in the time law: a lead counts along Z."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.interpreter.elementary_blocks import Block, Kind
from core.motion.axis_limits import MotionError
from core.motion.motion_plan import plan
from tests.motion.moves import LIMITS, Point, line
from tests.motion.paths import build_path


def thread(end: Point, rpm: float = 600.0) -> Block:
    """From the origin at 2 mm a turn."""
    return replace(line((0, 0), end, 2.0, kind=Kind.THREAD), rpm=rpm)


def test_a_lead_is_fed_per_turn() -> None:
    path = build_path([thread((0, -40))], LIMITS)
    assert path.pieces.rate.tolist() == pytest.approx([20.0])


def test_a_taper_keeps_its_lead_along_z() -> None:
    path = build_path([thread((30, -40))], LIMITS)
    assert path.pieces.rate.tolist() == pytest.approx([20.0 * 50 / 40])
    profile = plan(path)
    middle = profile.position(0.5 * profile.duration + np.array([0.0, 0.1]))
    assert middle[0][1] - middle[1][1] == pytest.approx(2.0)


def test_a_thread_that_does_not_advance_is_refused() -> None:
    with pytest.raises(MotionError, match="Block 1: a thread does not advance along Z"):
        build_path([thread((5, 0))], LIMITS)


def test_a_thread_with_the_spindle_still_is_refused() -> None:
    with pytest.raises(MotionError, match="Block 1: feed per revolution with the spindle stopped"):
        build_path([thread((0, -5), 0.0)], LIMITS)
