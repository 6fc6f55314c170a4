"""Sections that are planned together get the plans that they get alone, and unusual ones are left out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import MotionLimits
from core.motion.motion_profile import MotionProfile
from core.motion.section_plans import plan_sections
from core.motion.window_planner import PlannedChunk, WindowPlanner
from tests.motion.moves import LIMITS, A, arc, line, polyline, programs

PASS = [
    line((12.7, 5.0), (12.7, -20.0), 1.25, n=1, kind=BlockKind.THREAD),
    line((12.7, -20.0), (15.0, -20.0), 127.0, n=2, kind=BlockKind.RAPID),
]
"""Thread pass of 20 revolutions at 600 rpm: 25 mm at 12.5 mm/s, and a rapid of 2.3 mm."""
TURNING = [replace(PASS[0], rpm=600.0), PASS[1]]


def plan_alone(blocks: Sequence[Block], limits: MotionLimits) -> PlannedChunk:
    """Plan one section with a planner that has planned nothing before."""
    planner = WindowPlanner(limits)
    return [*planner.plan_blocks(blocks), *planner.finish_section()][-1]


def list_values(profile: MotionProfile) -> list[list[float]]:
    """Return all numbers of a profile and of its path."""
    path = profile.path
    arrays = [*profile.phases, *(getattr(path.pieces, name) for name in path.pieces.__dataclass_fields__)]
    arrays += [path.joint_distances, path.speed_caps, path.accelerations, path.squared_speed_limits]
    arrays += [path.block_numbers, path.first_pieces, path.start_position]
    ends = [profile.start_distance, profile.end_distance, profile.duration_s]
    return [np.ravel(each).tolist() for each in (*arrays, ends)]


@settings(max_examples=60, deadline=None)
@given(st.lists(programs(most=6), min_size=1, max_size=8), st.sampled_from([0.0, 0.001, 0.02]))
def test_sections_get_the_same_plans_as_alone(sections: list[list[Block]], grain: float) -> None:
    limits = replace(LIMITS, grain=grain)
    placed: list[list[Block]] = []
    for section in sections:  # each section starts where the previous section ends
        x, z, n = (placed[-1][-1].x, placed[-1][-1].z, placed[-1][-1].n) if placed else (0.0, 0.0, 0)
        dx, dz = x - section[0].x0, z - section[0].z0
        placed.append(
            [
                replace(
                    each, n=n + at, x0=each.x0 + dx, x=each.x + dx, cx=each.cx + dx,
                    z0=each.z0 + dz, z=each.z + dz, cz=each.cz + dz,
                )
                for at, each in enumerate(section, start=1)
            ]
        )  # fmt: skip
    for blocks, plan in zip(placed, plan_sections(placed, limits, math.inf), strict=True):
        if plan is not None:
            alone = plan_alone(blocks, limits)
            assert list_values(plan.profile) == list_values(alone.profile)
            assert plan.joint_times_s[:-1].tolist() == alone.block_starts_s.tolist()
            assert plan.joint_times_s[1:].tolist() == alone.block_ends_s.tolist()


def test_thread_pass_takes_its_revolutions_and_two_ramps() -> None:
    """25 mm at 12.5 mm/s are 2 s, plus v/2a for the start and (v - c)²/2av for braking to the corner.

    The corner of 90 degrees permits c = a·T/2 = 1.524 mm/s.
    """
    (plan,) = plan_sections([TURNING], LIMITS, math.inf)
    assert plan is not None
    seconds = 2.0 + 12.5 / (2.0 * A) + (12.5 - 1.524) ** 2 / (2.0 * A * 12.5)
    assert plan.joint_times_s[1] == pytest.approx(seconds, abs=1e-9)
    assert plan.profile.path.block_numbers.tolist() == [1, 2]


def test_moves_shorter_than_a_setpoint_interval_are_planned_alone() -> None:
    """At 127 mm/s, an interval of 1 ms is 0.127 mm."""
    short = polyline([(15.0, -20.0), (15.1, -20.0)], 127.0)
    long = polyline([(15.1, -20.0), (17.0, -20.0)], 127.0)
    plans = plan_sections([short, long], LIMITS, math.inf)
    assert [plan is None for plan in plans] == [True, False]


@pytest.mark.parametrize(("second", "is_alone"), [((10.17, 0.17), True), ((20.0, 10.0), False)])
def test_neighboring_short_chords_are_planned_alone(second: tuple[float, float], is_alone: bool) -> None:
    """With a grain of 0.001 mm, a chord is short below 4·0.001·127/(3048·0.001) = 0.167 mm."""
    limits = replace(LIMITS, grain=0.001)
    blocks = polyline([(9.95, 0.0), (10.1, 0.05), second], 10.0)
    assert [plan is None for plan in plan_sections([blocks], limits, math.inf)] == [is_alone]


def test_moves_without_length_are_planned_alone() -> None:
    assert plan_sections([[line((1.0, 1.0), (1.0, 1.0))]], LIMITS, math.inf) == [None]


def test_long_sections_are_planned_alone() -> None:
    """A section of 24 moves has 25 joints, more than the row by row look-ahead of a short plan."""
    points = [(float(k % 2), -2.0 * k) for k in range(25)]
    assert plan_sections([polyline(points)], LIMITS, math.inf) == [None]


def test_arcs_at_constant_surface_speed_are_planned_alone() -> None:
    blocks = [replace(arc((10.0, 0.0), (0.0, -10.0), (0.0, 0.0)), per_rev=True, css=1000.0, feed=0.1)]
    assert plan_sections([blocks], LIMITS, 3000.0) == [None]


@pytest.mark.parametrize(
    "faulty",
    [
        replace(TURNING[0], feed=0.0),
        replace(TURNING[0], rpm=0.0),
        replace(TURNING[0], z=math.nan),
        replace(TURNING[0], z0=6.0),
        replace(TURNING[0], kind=BlockKind.DWELL),
    ],
    ids=["no feed", "spindle stopped", "not a number", "gap", "no motion"],
)
def test_block_that_cannot_be_planned_leaves_all_sections_to_the_caller(faulty: Block) -> None:
    before = polyline([(20.0, 5.0), (12.7, 5.0)])
    assert plan_sections([before, [faulty, TURNING[1]]], LIMITS, math.inf) == [None, None]
