"""Lines and arcs as arrays for the motion planner, and smoothing between short chords.

Programmed points are rounded to the resolution. With chords of 0.01 mm, this rounding changes the direction
at every joint (junction of two pieces) far more than the original curve does. The planner therefore moves
each joint, by at most one resolution step per axis, to the curve through its neighbors. It does not move
the ends of a chain of chords, corners, arcs, long lines and moves of other axes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from core.message import Message
from core.motion.axis_limits import BoolArray, FloatArray, IntArray, MotionError, MotionLimits
from core.motion.block_table import BlockTable
from core.motion.joint_easing import smooth_joint_points

SAME_POINT_TOLERANCE = 1e-7  # mm or degrees; closer points count as one point
_MAX_DEG_PER_MM = 1e5  # degrees of C per mm; distances have an accuracy of 1e-9 mm, so C has 1e-4 degrees
_MIN_PATH_MM = 1e-4  # mm of X and Z below which a rotation of C measures the path
_C_ONLY_TOLERANCE_MM = 1e-6  # mm of X and Z below which the feed is that of C
RADIUS_TOLERANCE_MM = 0.02  # mm by which the radii at the start and end of an arc may differ
_SHARE = 0.25  # fraction of a chord by which its ends may be moved
_TURNS = 4.0  # resolution steps per chord length; a larger turn is not caused by rounding


@dataclass(frozen=True, slots=True)
class PathPieces:
    """Arrays of n lines and arcs in machine coordinates.

    Lengths are in mm, or degrees for C, angles are in radians, and speeds are in mm/s.

    - A line has ``start`` (n, axes) and ``direction`` (n, axes), the change of the axes per unit of path.
    - The path length of a lathe is measured in X and Z, or in degrees if only C rotates. On other
      machines, the blocks specify the path length.
    - An arc has ``curvatures`` of ±1/radius, positive for clockwise. The value of a line is 0.
    - ``angle`` is the angle at the start of the arc: x = center x + radius·sin, z = center z +
      radius·cos.
    - The ``direction`` of an arc contains only the motion of C.
    - ``block`` is the number of the block, and ``rate`` is the programmed speed.
    """

    block: IntArray
    start: FloatArray
    direction: FloatArray
    centre: FloatArray
    radius: FloatArray
    angle: FloatArray
    curvatures: FloatArray
    length: FloatArray
    rate: FloatArray
    rapid: BoolArray

    def __len__(self) -> int:
        return len(self.length)

    def __getitem__(self, part: slice | IntArray | BoolArray) -> PathPieces:
        return PathPieces(*[getattr(self, name)[part] for name in _FIELDS])

    def tangent(self, distances: FloatArray) -> FloatArray:
        """Return the directions (n, axes) at ``distances`` (n,) from the start of each piece."""
        tangent = self.direction.copy(order="K")
        arc = np.flatnonzero(self.curvatures)
        if len(arc):
            angle = self.angle[arc] + self.curvatures[arc] * distances[arc]
            turning = np.sign(self.curvatures[arc])
            tangent[arc, 0] += turning * np.cos(angle)
            tangent[arc, 1] -= turning * np.sin(angle)
        return tangent

    def point(self, distances: FloatArray) -> FloatArray:
        """Return the positions (n, axes) at ``distances`` (n,) from the start of each piece."""
        point = self.start + self.direction * distances[:, None]
        arc = self.curvatures != 0.0
        if arc.any():
            angle = self.angle[arc] + self.curvatures[arc] * distances[arc]
            point[arc, 0] = self.centre[arc, 0] + self.radius[arc] * np.sin(angle)
            point[arc, 1] = self.centre[arc, 1] + self.radius[arc] * np.cos(angle)
        return point


_FIELDS = tuple(f.name for f in fields(PathPieces))


def concatenate_pieces(parts: Sequence[PathPieces]) -> PathPieces:
    """Return the pieces of several arrays as one array, in the given order."""
    if len(parts) == 1:
        return parts[0]
    return PathPieces(*[np.concatenate([getattr(p, name) for p in parts]) for name in _FIELDS])


def make_pieces(table: BlockTable, speeds: FloatArray) -> PathPieces:
    """Return one path piece for each of m blocks, including blocks of zero length.

    ``speeds`` (m,) are in mm/s. Raises MotionError if the radii at the start and the end of an arc differ
    by more than RADIUS_TOLERANCE_MM.
    """
    delta = table.end - table.start
    length = np.hypot(delta[:, 0], delta[:, 1])
    turn = np.abs(delta[:, 2])
    path_length_mm, slides = (
        length,
        length > np.maximum(SAME_POINT_TOLERANCE, np.minimum(turn / _MAX_DEG_PER_MM, _MIN_PATH_MM)),
    )
    length = np.where(slides, path_length_mm, np.where(turn > SAME_POINT_TOLERANCE, turn, 0.0))
    has_short_path = ~slides & (path_length_mm > _C_ONLY_TOLERANCE_MM) & np.isnan(table.length)
    speeds = np.where(
        has_short_path, speeds * length / np.maximum(path_length_mm, _C_ONLY_TOLERANCE_MM), speeds
    )  # X and Z retain their feed
    length = np.where(np.isnan(table.length), length, table.length)
    centre, radius, angle, curvature, sweep = _circles(table)
    length = np.where(curvature != 0.0, radius * sweep, length)
    direction = delta / np.where(length > 0.0, length, 1.0)[:, None]
    direction[curvature != 0.0, :2] = 0.0
    return PathPieces(
        block=table.n.astype(np.int64),
        start=table.start,
        direction=direction,
        centre=centre,
        radius=radius,
        angle=angle,
        curvatures=curvature,
        length=length,
        rate=speeds,
        rapid=table.rapid,
    )


def _circles(table: BlockTable) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the center, radius, start angle, curvature and positive sweep of each block.

    The values are zero for lines and points.
    """
    m = len(table.n)
    centre, sweep = np.zeros((m, 2)), np.zeros(m)
    radius, angle, curvature = np.zeros(m), np.zeros(m), np.zeros(m)
    arc = np.flatnonzero(table.arc)
    if not len(arc):
        return centre, radius, angle, curvature, sweep
    start, end = table.start[arc, :2], table.end[arc, :2]
    centre[arc] = _adjust_centers(table, arc)
    a, b = start - centre[arc], end - centre[arc]
    first, last = np.arctan2(a[:, 0], a[:, 1]), np.arctan2(b[:, 0], b[:, 1])
    turning = np.where(table.clockwise[arc], 1.0, -1.0)
    closed = np.hypot(*(end - start).T) <= SAME_POINT_TOLERANCE
    sweep[arc] = np.where(closed, 2.0 * np.pi, (turning * (last - first)) % (2.0 * np.pi))
    radius[arc], angle[arc] = np.hypot(a[:, 0], a[:, 1]), first
    real = radius > SAME_POINT_TOLERANCE
    np.divide(1.0, radius, out=curvature, where=real)
    curvature[arc] *= turning
    return centre, radius, angle, curvature, sweep


def _adjust_centers(table: BlockTable, arc: IntArray) -> FloatArray:
    """Return arc centers moved to the perpendicular bisectors of the chords.

    Programmed centers are rounded to the resolution. Without this correction, an arc would miss its end
    point by up to one resolution step.
    """
    start, end, centre = table.start[arc, :2], table.end[arc, :2], table.centre[arc]
    radii = np.hypot(*(start - centre).T), np.hypot(*(end - centre).T)
    off = np.abs(radii[0] - radii[1])
    if (off > RADIUS_TOLERANCE_MM).any():
        worst = int(off.argmax())
        raise MotionError(
            Message(
                "Block {number}: the arc starts {radii} mm and ends {radii2} mm from its center. Correct "
                "the center or the end point.",
                number=f"{table.n[arc[worst]]:.0f}",
                radii=f"{radii[0][worst]:.4f}",
                radii2=f"{radii[1][worst]:.4f}",
            ),
            "arc-radii-differ",
        )
    chord = end - start
    size = np.hypot(chord[:, 0], chord[:, 1])[:, None]
    along = np.divide(chord, size, out=np.zeros_like(chord), where=size > SAME_POINT_TOLERANCE)
    middle = 0.5 * (start + end)
    settled: FloatArray = centre - along * np.sum((centre - middle) * along, axis=1)[:, None]
    return settled


def smooth_joints(pieces: PathPieces, limits: MotionLimits) -> PathPieces:
    """Return the path pieces with each joint moved by at most ``limits.grain`` per axis.

    ``limits.grain`` is the resolution of programmed positions. The first and the last point of the path
    remain unchanged.
    """
    inner = _is_free_joint(pieces, limits)
    if not inner.any():
        return pieces
    free = np.concatenate([[False], inner, [False]])
    shorter = np.minimum(pieces.length[:-1], pieces.length[1:])
    allowed = np.zeros(len(free))
    allowed[1:-1] = np.where(inner, np.minimum(limits.grain, _SHARE * shorter), 0.0)
    s = np.concatenate([[0.0], np.cumsum(pieces.length)])
    joints = _joint_positions(pieces)
    points = np.empty(len(joints), dtype=np.complex128)
    points.real, points.imag = joints[:, 0], joints[:, 1]
    points = smooth_joint_points(points, s, free, allowed)
    joints[:, 0], joints[:, 1] = points.real, points.imag
    return move_joints(pieces, joints, free)


def _joint_positions(pieces: PathPieces) -> FloatArray:
    """Return the start points of all pieces and the end point of the last piece (n+1, axes)."""
    return np.concatenate([pieces.start, pieces[-1:].point(pieces.length[-1:])])


def move_joints(pieces: PathPieces, joints: FloatArray, is_free: BoolArray) -> PathPieces:
    """Return the pieces with their ends moved to ``joints`` (n+1, axes).

    Only lines with at least one end where ``is_free`` (n+1,) is True are changed.
    """
    touched = np.flatnonzero(is_free[:-1] | is_free[1:])
    start, direction = pieces.start.copy(order="K"), pieces.direction.copy(order="K")
    length = pieces.length.copy()
    begins = [joints[:, axis].take(touched) for axis in (0, 1)]
    travels = [joints[:, axis].take(touched + 1) - begin for axis, begin in enumerate(begins)]
    size = np.hypot(*travels)
    length[touched] = size
    for axis, (begin, travel) in enumerate(zip(begins, travels, strict=True)):
        start[touched, axis] = begin
        direction[touched, axis] = travel / size
    return dataclasses.replace(pieces, start=start, direction=direction, length=length)


def extend_smoothed_pieces(
    smoothed_pieces: PathPieces,
    programmed_pieces: PathPieces,
    new_pieces: PathPieces,
    redo_count: int,
    limits: MotionLimits,
) -> PathPieces:
    """Return the last ``redo_count`` smoothed pieces and all ``new_pieces``, smoothed together.

    ``programmed_pieces`` contains the last pieces of ``smoothed_pieces`` as programmed, at least
    ``SUPPORT_PIECE_COUNT`` more than ``redo_count`` if so many exist.
    """
    both = concatenate_pieces([programmed_pieces, new_pieces])
    smooth = smooth_joints(both, limits)[len(programmed_pieces) - redo_count :]
    begin = (
        smoothed_pieces[-1:].point(smoothed_pieces.length[-1:])[0]
        if redo_count == 0
        else smoothed_pieces.start[len(smoothed_pieces) - redo_count]
    )
    # Only chords have moved ends. A rotation of C must not change its length because of noise in X and Z.
    if not len(smooth) or not find_short_chords(smooth[:1], limits)[0] or (smooth.start[0] == begin).all():
        return smooth
    joints = _joint_positions(smooth)
    joints[0] = begin
    return move_joints(smooth, joints, np.arange(len(joints)) == 0)


def ends_with_chord(pieces: PathPieces, limits: MotionLimits) -> bool:
    """Return whether the path ends with a short chord, so that its last joint may still be moved."""
    return len(pieces) > 0 and bool(find_short_chords(pieces[-1:], limits)[0])


def find_short_chords(pieces: PathPieces, limits: MotionLimits) -> BoolArray:
    """Return a mask (n,) of the lines of linear axes that are so short that rounding affects them."""
    # Rounding turns longer lines so little that no speed is too high for the joint.
    longest = (
        _TURNS * limits.grain * limits.max_plane_speed / (limits.max_plane_acceleration * limits.interval)
    )
    alone = (pieces.curvatures == 0.0) & ~pieces.direction[:, 2:].any(axis=1)
    chords: BoolArray = alone & (pieces.length < longest) & pieces.direction[:, :2].any(axis=1)
    return chords


def _is_free_joint(pieces: PathPieces, limits: MotionLimits) -> BoolArray:
    """Return a mask (n-1,) of the junctions of neighboring pieces that may be smoothed.

    At such a junction, two short chords meet whose directions differ no more than rounding can cause.
    """
    if limits.grain <= 0.0 or len(pieces) < 3:
        return np.zeros(max(len(pieces) - 1, 0), dtype=bool)
    chord = find_short_chords(pieces, limits)
    turn = np.abs(np.diff(pieces.direction[:, :2], axis=0)).max(axis=1)
    shorter = np.minimum(pieces.length[:-1], pieces.length[1:])
    rounding = turn * shorter <= _TURNS * limits.grain
    free: BoolArray = chord[:-1] & chord[1:] & rounding & (pieces.rapid[:-1] == pieces.rapid[1:])
    return free
