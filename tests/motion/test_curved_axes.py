"""Moves in which C turns: the surface that they leave, the speeds they keep, what they refuse."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.virtual_mill import FacePlane, MillPoint, PlaneMove, SidePlane
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.motion.axis_limits import OVERRIDE_MAX, FloatArray, MotionError, MotionLimits
from core.motion.motion_path import MAX_CHORD_ERROR_MM, MotionPath, divide_into_chords
from core.motion.motion_plan import plan_motion
from core.motion.motion_profile import MotionProfile
from core.motion.window_planner import sample_positions
from tests.coded import raises_code
from tests.motion.moves import line
from tests.motion.paths import build_path

# The shipped lathe: C at 200 rpm and 600 rpm/s at most.
LIMITS = MotionLimits(vmax=(127.0, 127.0, 1200.0), amax=(3048.0, 3048.0, 3600.0), interval=0.001)
FLAT = 0.00005 * 25.4
ENDS = np.array([0.0, 1.0])


def milled(move: PlaneMove, feed: float = 4.0, n: int = 1) -> Block:
    """A block of plane switching, as the interpreter makes it."""
    (x0, z0, c0), (x, z, c) = move.compute_machine_positions(ENDS).tolist()
    block = line((x0, z0), (x, z), feed, n=n, kind=BlockKind.PLANE_LINE)
    return replace(block, c0=c0, c=c, plane=move)


def face_line(start: tuple[float, float], end: tuple[float, float], h: float = 0.0) -> PlaneMove:
    return PlaneMove(FacePlane(0.0, h), (*start, 0.0), (*end, 0.0), math.atan2(start[1], start[0]))


def turned(c0: float, c: float, feed: float, n: int = 1, **more: object) -> Block:
    block = line((10.0, 5.0), (10.0, 5.0), feed, n=n, kind=BlockKind.ROTATE)
    return replace(block, c0=c0, c=c, **more)  # type: ignore[arg-type]


def fed_by_c(z: float, c: float, feed: float, rpm: float) -> Block:
    block = line((10.0, 0.0), (10.0, z), feed)
    return replace(block, c=c, per_rev=True, rpm=rpm, modal=ModalState(c_locked=True))


def off_line(profile: MotionProfile, move: PlaneMove, dt: float) -> float:
    """How far the tool leaves the straight way on the part, mm, sampled every ``dt``."""
    _, positions, _ = sample_positions(profile, dt)
    points = move.frame.convert_to_mill(positions)
    (x0, y0, _), (x1, y1, _) = move.start, move.end
    across = (x1 - x0) * (points[:, 1] - y0) - (y1 - y0) * (points[:, 0] - x0)
    return float(np.abs(across).max() / math.hypot(x1 - x0, y1 - y0))


@pytest.mark.parametrize("dt", [0.00037, 0.001, 0.0131])
@pytest.mark.parametrize(
    "move",
    [
        face_line((8.0, -6.35), (8.0, 6.35)),
        face_line((0.5, -6.35), (0.5, 6.35)),
        face_line((9.0, 0.01), (-9.0, 0.01)),
        face_line((8.0, 2.0), (-8.0, 2.0), h=1.5),
    ],
    ids=["flat", "near", "past the centre", "tool above the axis"],
)
def test_flat_is_within_flatness_limit(move: PlaneMove, dt: float) -> None:
    assert off_line(plan_motion(build_path([milled(move)], LIMITS)), move, dt) < 0.5 * FLAT


def test_drive_segments_are_flat_and_end_at_end_point() -> None:
    """Pieces of constant acceleration, looked at within them: the same chords."""
    move = face_line((2.0, -6.0), (2.0, 6.0))
    profile = plan_motion(build_path([milled(move)], LIMITS))
    t, dt, p, v, a = profile.make_segments(0.0, profile.duration_s)
    for share in (0.0, 0.3, 0.7, 1.0):
        tau = (share * dt)[:, None]
        points = move.frame.convert_to_mill(p + (v + 0.5 * a * tau) * tau)
        assert np.abs(points[:, 0] - 2.0).max() < 0.5 * FLAT
    assert np.abs(np.diff(t) - dt[:-1]).max() < 1e-9
    assert profile.compute_positions(profile.duration_s)[0].tolist() == pytest.approx(
        move.compute_machine_positions(ENDS)[1].tolist()
    )


def test_feed_is_relative_to_milling_tool() -> None:
    """12 mm of a flat at 4 mm/s, 8 mm off the axis: 3 s, and a little for the ramps."""
    move = face_line((8.0, -6.0), (8.0, 6.0))
    profile = plan_motion(build_path([milled(move)], LIMITS))
    assert profile.duration_s == pytest.approx(3.0, abs=0.03)
    points = move.frame.convert_to_mill(profile.compute_positions(np.array([1.0, 2.0])))
    assert points[1, 1] - points[0, 1] == pytest.approx(4.0, abs=2e-3)


def test_c_slows_feed_near_center() -> None:
    """A hundredth of a millimetre beside the axis C turns half round: over .4 s at 3600 degrees/s²."""
    move = face_line((3.0, 0.01), (-3.0, 0.01))
    profile = plan_motion(build_path([milled(move)], LIMITS))
    assert profile.duration_s > 6.0 / 4.0 + 0.4
    assert profile.duration_s < 6.0 / 4.0 + 1.5


def axis_speeds(profile: MotionProfile) -> FloatArray:
    _, _, _, v, a, piece = profile.phases
    fastest = np.maximum(v, v + a * profile.phases.durations_s)
    speeds: FloatArray = np.abs(profile.path.pieces.direction[piece]) * fastest[:, None]
    return speeds


@settings(max_examples=40, deadline=None)
@given(
    st.floats(-12.0, 12.0), st.floats(-12.0, 12.0), st.floats(-12.0, 12.0), st.floats(-12.0, 12.0),
    st.sampled_from([1.0, 8.0, 120.0]),
)  # fmt: skip
def test_no_axis_exceeds_its_limits(x: float, y: float, u: float, v: float, feed: float) -> None:
    move = face_line((x, y), (u, v))
    if move.length < 0.1 or move.compute_distance_from_axis(move.get_fastest_rotation_fraction()) < 0.01:
        return
    path = build_path([milled(move, feed)], LIMITS)
    profile = plan_motion(path)
    assert (axis_speeds(profile) <= LIMITS.speeds * (1.0 + 1e-6)).all()
    assert (
        joint_steps(profile, path) <= LIMITS.max_acceleration_array * LIMITS.interval * (1.0 + 1e-6)
    ).all()
    assert off_line(profile, move, 0.0047) < 0.5 * FLAT


def joint_steps(profile: MotionProfile, path: MotionPath) -> FloatArray:
    """Change of each axis' velocity (k, 3) at the joints of pieces."""
    v = profile.compute_distances_and_speeds(profile.compute_times_at_distances(path.joint_distances[1:-1]))[
        1
    ]
    steps: FloatArray = np.abs(np.diff(path.pieces.direction, axis=0)) * v[:, None]
    return steps


def test_arc_chords_on_side_stay_on_arc() -> None:
    move = PlaneMove(
        SidePlane(0.0, 0.0, 22.0), (0.0, 0.0, 10.0), (5.0, 5.0, 10.0), 0.0, (5.0, 0.0), clockwise=True
    )
    share = divide_into_chords(move, 4.0, LIMITS)
    path = build_path([milled(move)], LIMITS)
    assert len(path) == len(share) - 1
    profile = plan_motion(path)
    _, positions, _ = sample_positions(profile, 0.0023)
    points = move.frame.convert_to_mill(positions)
    assert np.abs(np.hypot(points[:, 0] - 5.0, points[:, 1]) - 5.0).max() < 1.1 * MAX_CHORD_ERROR_MM
    assert path.length == pytest.approx(2.5 * math.pi)


def test_line_on_side_is_one_piece() -> None:
    start, end = (0.0, 0.0, 11.0), (5.0, 5.0, 10.0)
    path = build_path([milled(PlaneMove(SidePlane(0.0, 0.0, 22.0), start, end))], LIMITS)
    assert len(path) == 1
    assert path.length == pytest.approx(math.dist(start, end))


def test_c_alone_turns_at_its_speed() -> None:
    """90 degrees at 300 degrees/s and 3600 degrees/s²: 90/300 + 300/3600 s."""
    profile = plan_motion(build_path([turned(10.0, 100.0, 300.0)], LIMITS))
    assert profile.duration_s == pytest.approx(90.0 / 300.0 + 300.0 / 3600.0)
    assert profile.compute_positions(profile.duration_s)[0].tolist() == pytest.approx([10.0, 5.0, 100.0])


def test_shifted_c_count_is_converted_to_machine() -> None:
    block = turned(-30.0, 0.0, 600.0, modal=ModalState(offset_c=-360.0))
    assert build_path([block], LIMITS).start_position.tolist() == pytest.approx([10.0, 5.0, -390.0])


def test_linear_feed_follows_c_revolutions() -> None:
    """The worked slot: .1 in at .8 in/rev takes 45 of 45.1 degrees; C at 3.5 rpm all the way."""
    way = 0.1 * 25.4
    profile = plan_motion(build_path([fed_by_c(-way, -45.1, 0.8 * 25.4, -3.5)], LIMITS))
    assert len(profile.path) == 2
    t = np.linspace(0.0, profile.duration_s, 500)
    at = profile.compute_positions(t)
    arrived = at[:, 2] <= -45.0
    assert at[arrived, 1] == pytest.approx(-way)
    assert at[~arrived, 1] == pytest.approx(at[~arrived, 2] / 45.0 * way)
    # 45.1 degrees at 21 degrees/s; the ramps take next to nothing
    assert profile.duration_s == pytest.approx(45.1 / 21.0, abs=0.02)


def test_c_with_own_drive_moves_along_with_feed() -> None:
    """.2 mm a turn at 300 rpm is 1 mm/s: 10 mm take 10 s, however far C turns meanwhile."""
    block = replace(fed_by_c(-10.0, 5.0, 0.2, 300.0), modal=ModalState())
    profile = plan_motion(build_path([block], LIMITS))
    assert len(profile.path) == 1
    assert profile.duration_s == pytest.approx(10.0, abs=0.01)
    assert profile.compute_positions(profile.duration_s)[0].tolist() == pytest.approx([10.0, -10.0, 5.0])


def test_exactly_sufficient_c_rotation_is_one_piece() -> None:
    assert len(build_path([fed_by_c(-10.0, 360.0, 10.0, 5.0)], LIMITS)) == 1


def test_insufficient_c_rotation_is_rejected_with_needed_angle() -> None:
    with raises_code(MotionError, "rotary-range", 432, 360):
        build_path([fed_by_c(-0.3 * 25.4, 360.0, 0.25 * 25.4, 5.0)], LIMITS)


def test_discontinuous_plane_path_is_rejected() -> None:
    first, second = face_line((8.0, 0.0), (8.0, 1.0)), face_line((8.0, 1.1), (8.0, 2.0))
    with raises_code(MotionError, "broken-path", "Block 2"):
        build_path([milled(first), milled(second, n=2)], LIMITS)


def test_zero_feed_is_rejected() -> None:
    with raises_code(MotionError, "no-feed"):
        build_path([milled(face_line((8.0, 0.0), (8.0, 1.0)), feed=0.0)], LIMITS)


def test_zero_length_move_has_no_piece() -> None:
    spot: MillPoint = (8.0, 1.0, 0.0)
    stand = PlaneMove(FacePlane(0.0), spot, spot, math.atan2(1.0, 8.0))
    path = build_path([milled(stand), milled(face_line((8.0, 1.0), (8.0, 2.0)), n=2)], LIMITS)
    assert path.block_numbers.tolist() == [1, 2]
    assert path.first_pieces.tolist()[1] == 0


def test_stop_and_restart_stay_on_path() -> None:
    move = face_line((8.0, -6.0), (8.0, 6.0))
    path = build_path([milled(move)], LIMITS)
    running = plan_motion(path)
    s, v = running.compute_distances_and_speeds(1.5)
    stopped = plan_motion(path, start_distance=float(s[0]), start_speed=float(v[0]), stop_early=True)
    assert stopped.duration_s < 0.05
    assert off_line(stopped, move, 0.0005) < 0.5 * FLAT
    on = plan_motion(path, start_distance=stopped.end_distance)
    assert on.compute_positions(on.duration_s)[0].tolist() == pytest.approx(
        move.compute_machine_positions(ENDS)[1].tolist()
    )


@pytest.mark.parametrize("h", [0.5, -2.0])
def test_tool_reaches_nearest_point_to_axis_and_continues(h: float) -> None:
    """At rho = |H| X stands on the axis of the lathe and its speed for any feed would be endless."""
    reached = (abs(h), 0.0)
    to, on = face_line((9.0, 3.0), reached, h), face_line(reached, (5.0, -1.0), h)
    turn_on = replace(
        on,
        frame=FacePlane(
            to.compute_machine_positions(ENDS)[1, 2] - on.compute_machine_positions(ENDS)[0, 2], h
        ),
    )
    path = build_path([milled(to, 1.7), milled(turn_on, 1.7, n=2)], LIMITS)
    assert path.pieces.length.min() > 1e-6
    profile = plan_motion(path)
    assert (axis_speeds(profile) <= LIMITS.speeds * (1.0 + 1e-6)).all()
    assert profile.duration_s < 20.0
    _, _, _, v, a = (column[-1] for column in profile.make_segments(0.0, profile.duration_s))
    dt = profile.make_segments(0.0, profile.duration_s)[1][-1]
    assert np.abs(v + a * dt).max() < 1e-6


def test_stop_near_axis_decelerates_c() -> None:
    """The mill creeps there while C turns fast: no speed is too small to be braked."""
    path = build_path([milled(face_line((3.0, 0.001), (-3.0, 0.001)), 8.0)], LIMITS)
    running = plan_motion(path)
    near = running.compute_times_at_distances(path.joint_distances[:1] + 3.0)
    s, v = running.compute_distances_and_speeds(near)
    assert 0.0 < v[0] < 0.1
    stopped = plan_motion(path, start_distance=float(s[0]), start_speed=1e-3 * float(v[0]), stop_early=True)
    assert stopped.duration_s > 0.0
    _, dt, _, begin, a = stopped.make_segments(0.0, stopped.duration_s)
    tangent = path.pieces.direction[path.find_piece_indices(s)]
    assert begin[0] == pytest.approx(tangent[0] * 1e-3 * v[0])
    assert np.abs(begin[-1] + a[-1] * dt[-1]).max() < 1e-6


@dataclass(frozen=True)
class Circle:
    """A way along a circle of so large a radius, mm; ``seen`` False: from the part it looks straight."""

    radius: float
    length: float
    seen: bool = True
    is_straight: bool = False

    def compute_machine_positions(self, share: FloatArray) -> FloatArray:
        """X, Z and C at shares of the way."""
        angle = share * self.length / self.radius
        return np.stack([self.radius * np.cos(angle), self.radius * np.sin(angle), 0.0 * angle], axis=1)

    def compute_workpiece_points(self, points: FloatArray) -> FloatArray:
        """The points as the part has them."""
        return points if self.seen else np.zeros_like(points)

    def get_fastest_rotation_fraction(self) -> float:
        """Where C turns fastest: nowhere, so in the middle."""
        return 0.5


def circle(radius: float, length: float, *, seen: bool = True) -> Any:
    """As one of the moves that the interpreter makes."""
    return Circle(radius, length, seen)


def test_long_path_has_same_chord_error_as_short_path() -> None:
    """A chord c leaves a circle by c²/8R: of 1e-4 mm at R 50 with chords of .2 mm."""
    way = circle(50.0, 300.0)
    ways = np.diff(divide_into_chords(way, 1.0, LIMITS)) * way.length
    assert ways.max() <= math.sqrt(8.0 * MAX_CHORD_ERROR_MM * way.radius)
    assert ways.min() > 0.4 * math.sqrt(8.0 * MAX_CHORD_ERROR_MM * way.radius)


def test_chords_are_divided_until_joints_do_not_slow_motion() -> None:
    """At 127 mm/s a joint turns by .5·3048·.001/127 = .012 at most: 16 chords of 22.5 mm turn .0225, 32 half.

    On a circle of 1000 mm the acceleration allows 1561 mm/s, so it is the speed of the axes that counts.
    """
    way = circle(1000.0, 360.0, seen=False)
    assert len(divide_into_chords(way, 127.0 / OVERRIDE_MAX, LIMITS)) - 1 == 32
    assert len(divide_into_chords(way, 60.0 / OVERRIDE_MAX, LIMITS)) - 1 == 16
