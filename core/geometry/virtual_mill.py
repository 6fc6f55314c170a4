"""Coordinate transformation (plane switching) from a virtual mill to the lathe axes X, Z and C.

The XC plane is on the face of the part. The ZC plane is its side, unrolled at a diameter. The live tool is
on the negative X side of the lathe, or on the positive side if ``is_far_side`` is True. As seen from the
tool, mill X points to the right and mill Y points up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import compute_arc_sweep

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FacePlane:
    """The XC plane on the face of the part.

    - ``c_start_deg`` is the C angle in degrees at which the coordinate transformation starts.
    - ``tool_height_mm`` is the height h of the tool above the axis, in mm.

    For a point at the distance rho from the axis, the tool is at X = -sqrt(rho² - h²), or at the positive
    value on the far side, after C has rotated the point under the tool.
    """

    c_start_deg: float
    tool_height_mm: float = 0.0
    is_far_side: bool = False

    @property
    def heading_deg(self) -> float:
        """Return the direction of mill X on the part, in degrees from the negative X side at C0."""
        return _heading(self.c_start_deg, far=self.is_far_side)

    def convert_to_lathe(self, points: FloatArray, polar_angles: FloatArray) -> FloatArray:
        """Convert mill points X, Y, Z (n, 3) to lathe X (radius), Z, C (n, 3), in mm and degrees.

        ``polar_angles`` (n,) is the continuous polar angle of the points in radians. A point closer to the
        axis than |h|, the tool height, cannot be reached and is treated as if it were at |h|.
        """
        rho = np.hypot(points[:, 0], points[:, 1])
        x = np.sqrt(np.maximum((rho - self.tool_height_mm) * (rho + self.tool_height_mm), 0.0))
        lead = (
            np.arctan2(np.full(len(x), self.tool_height_mm), x) if self.tool_height_mm else np.zeros(len(x))
        )
        return np.column_stack(
            [x if self.is_far_side else -x, points[:, 2], self.c_start_deg + np.degrees(lead - polar_angles)]
        )

    def convert_to_mill(self, machine: FloatArray) -> FloatArray:
        """Convert lathe X, Z, C (n, 3) to the mill points X, Y, Z (n, 3) under the tool."""
        x = machine[:, 0] if self.is_far_side else -machine[:, 0]
        rho = np.hypot(x, self.tool_height_mm)
        theta = np.arctan2(self.tool_height_mm, x) - np.radians(machine[:, 2] - self.c_start_deg)
        return np.column_stack([rho * np.cos(theta), rho * np.sin(theta), machine[:, 1]])


@dataclass(frozen=True, slots=True)
class SidePlane:
    """The ZC plane on the side of the part, unrolled at ``diameter_mm``.

    ``c_start_deg`` (degrees) and ``z_start_mm`` (mm) are C and lathe Z at mill X0 Y0. Mill X points toward
    the spindle, Y is measured at ``diameter_mm``, and Z is the radius of the tip. Lengths are in mm.
    """

    c_start_deg: float
    z_start_mm: float
    diameter_mm: float
    is_far_side: bool = False

    def convert_to_lathe(self, points: FloatArray) -> FloatArray:
        """Convert mill points X, Y, Z (n, 3) to lathe X (radius), Z, C (n, 3). Mill Z is a radius."""
        x, y, z = points.T
        c = self.c_start_deg - y * (360.0 / (math.pi * self.diameter_mm))
        return np.column_stack([z if self.is_far_side else -z, self.z_start_mm - x, c])

    def convert_to_mill(self, machine: FloatArray) -> FloatArray:
        """Convert lathe X, Z, C (n, 3) to mill points X, Y, Z (n, 3). Mill Z is a radius."""
        x, z, c = machine.T
        up = x if self.is_far_side else -x
        return np.column_stack(
            [self.z_start_mm - z, (self.c_start_deg - c) * (math.pi * self.diameter_mm / 360.0), up]
        )


def _heading(c0: float, *, far: bool) -> float:
    return 180.0 - c0 if far else -c0


MillPoint = tuple[float, float, float]

AXIS_TOLERANCE_MM = 1e-4  # mm; a path closer than this to the spindle axis passes through the axis
_SAMPLES = 721  # points of an arc at which its extent is sampled: 0.5 degree of a full circle


@dataclass(frozen=True, slots=True)
class PlaneMove:
    """A straight line or, with ``center``, an arc in the coordinates of the virtual mill, in mm.

    On the side of the part, Z is a radius. ``start_angle_rad`` is used only on the face. It is the
    continuous polar angle of the start in radians, so that C never jumps by a revolution. For a start on
    the axis, it is the direction of departure. The end of an arc is within the control's tolerance of its
    circle.
    """

    frame: FacePlane | SidePlane
    start: MillPoint
    end: MillPoint
    start_angle_rad: float = 0.0
    center: tuple[float, float] | None = None
    clockwise: bool = False

    @property
    def length(self) -> float:
        """Return the length of the mill's path, in mm."""
        if self.center is None:
            return math.dist(self.start, self.end)
        _, sweep = self._start_and_sweep()
        return self.radius * abs(sweep)

    @property
    def is_feed_in_degrees(self) -> bool:
        """Return False, because the feed is in mm."""
        return False

    @property
    def radius(self) -> float:
        """Return the radius of the arc in mm, or 0 for a line."""
        return 0.0 if self.center is None else math.dist(self.start[:2], self._adjusted_center())

    @property
    def is_on_side_plane(self) -> bool:
        """Return whether the move machines the side of the part."""
        return isinstance(self.frame, SidePlane)

    @property
    def is_straight(self) -> bool:
        """Return whether the lathe axes move in constant proportion to each other."""
        return self.center is None and isinstance(self.frame, SidePlane)

    def compute_mill_points(self, fractions: FloatArray) -> FloatArray:
        """Return the mill points (n, 3) in mm at the fractions (n,) of the path, from 0 to 1."""
        start, end = np.array(self.start), np.array(self.end)
        points = np.asarray(start + fractions[:, None] * (end - start), dtype=np.float64)
        if self.center is not None:
            first, sweep = self._start_and_sweep()
            angle = first + sweep * fractions
            cx, cy = self._adjusted_center()
            points[:, 0], points[:, 1] = cx + self.radius * np.cos(angle), cy + self.radius * np.sin(angle)
        return points

    def compute_machine_positions(self, fractions: FloatArray) -> FloatArray:
        """Return lathe X (radius), Z, C (n, 3) at fractions (n,) of the path, with continuous C."""
        points = self.compute_mill_points(fractions)
        if isinstance(self.frame, SidePlane):
            return self.frame.convert_to_lathe(points)
        return self.frame.convert_to_lathe(points, self.compute_polar_angles(points, fractions))

    def compute_workpiece_points(self, positions: FloatArray) -> FloatArray:
        """Convert lathe X, Z, C (n, 3) to mill points (n, 3)."""
        return self.frame.convert_to_mill(positions)

    def compute_polar_angles(self, points: FloatArray, fractions: FloatArray) -> FloatArray:
        """Return the continuous polar angles (n,) of ``points`` on this path in radians.

        The angles start at ``start_angle_rad``.
        """
        if self.center is None:
            x0, y0, _ = self.start if math.hypot(*self.start[:2]) > AXIS_TOLERANCE_MM else self.end
            at_centre = np.hypot(points[:, 0], points[:, 1]) <= AXIS_TOLERANCE_MM
            turned = np.arctan2(x0 * points[:, 1] - y0 * points[:, 0], x0 * points[:, 0] + y0 * points[:, 1])
            along: FloatArray = self.start_angle_rad + np.where(at_centre, 0.0, turned)
            return along
        both = np.array([0.0, 1.0])
        begin = self._continuous_angles(self.compute_mill_points(both), both)[0]
        wound: FloatArray = self.start_angle_rad - begin + self._continuous_angles(points, fractions)
        return wound

    def split_at_axis(self) -> list[PlaneMove]:
        """Return the move as a list of one move, or of two moves if it passes through the axis.

        C must rotate between the two moves.
        """
        if isinstance(self.frame, SidePlane) or self.length <= AXIS_TOLERANCE_MM:
            return [self]
        share = self.get_fastest_rotation_fraction()
        if self.compute_distance_from_axis(share) > AXIS_TOLERANCE_MM or any(
            math.hypot(*end[:2]) <= AXIS_TOLERANCE_MM for end in (self.start, self.end)
        ):
            return [self]
        z = float(self.compute_mill_points(np.array([share]))[0, 2])
        return [replace(self, end=(0.0, 0.0, z)), replace(self, start=(0.0, 0.0, z))]

    def find_start_rotation(self) -> float:
        """Return the change of the polar angle, in radians, before a move that starts on the axis.

        The change is in the shorter direction. It is 0 for a move that starts away from the axis.
        """
        if (
            isinstance(self.frame, SidePlane)
            or math.hypot(*self.start[:2]) > AXIS_TOLERANCE_MM
            or self.length <= AXIS_TOLERANCE_MM
        ):
            return 0.0
        x, y = self.compute_mill_points(np.array([0.0, 1.0]))[1][:2].tolist()
        if self.center is not None:
            i, j = self.center
            x, y = (-j, i) if self.clockwise else (j, -i)
        turn = (math.atan2(y, x) - self.start_angle_rad + math.pi) % (2 * math.pi) - math.pi
        if abs(abs(turn) - math.pi) < 1e-6:
            # The path passes straight through the axis. C decreases, as for a center on the left.
            return abs(turn)
        return turn

    def get_fastest_rotation_fraction(self) -> float:
        """Return the fraction of the path, from 0 to 1, at which it is closest to the axis."""
        if self.center is None:
            dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
            square = dx * dx + dy * dy
            foot = -(self.start[0] * dx + self.start[1] * dy) / square if square else 0.0
            return min(max(foot, 0.0), 1.0)
        return self._fraction_at_angle(math.atan2(-self._adjusted_center()[1], -self._adjusted_center()[0]))

    def compute_distance_from_axis(self, fraction: float) -> float:
        """Return the distance from the axis in mm at a fraction of the path."""
        x, y, _ = self.compute_mill_points(np.array([fraction]))[0].tolist()
        return math.hypot(x, y)

    def find_travel_range(self) -> tuple[FloatArray, FloatArray]:
        """Return the minimum and the maximum of lathe X, Z, C (3,) along the path."""
        count = 2 if self.is_straight else _SAMPLES
        table = self.compute_machine_positions(
            np.append(np.linspace(0.0, 1.0, count), self.get_fastest_rotation_fraction())
        )
        return table.min(axis=0), table.max(axis=0)

    def _fraction_at_angle(self, angle: float) -> float:
        """Return the fraction of the path at which the arc is at this angle around its center.

        If the angle is outside the arc, return the fraction of the end that is closer to the axis: 0 or 1.
        """
        first, sweep = self._start_and_sweep()
        turn = 2.0 * math.pi
        swept_angle = (angle - first) % turn if sweep > 0.0 else (first - angle) % turn
        share = swept_angle / abs(sweep)
        if share <= 1.0:
            return share
        return 0.0 if self.compute_distance_from_axis(0.0) <= self.compute_distance_from_axis(1.0) else 1.0

    def _adjusted_center(self) -> tuple[float, float]:
        """Return the center of the arc, moved so that both ends have the same distance from it.

        The arc then meets its end exactly.
        """
        assert self.center is not None
        (x0, y0, _), (x1, y1, _), (cx, cy) = self.start, self.end, self.center
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        if square < 1e-12:
            return cx, cy
        off = ((cx - 0.5 * (x0 + x1)) * dx + (cy - 0.5 * (y0 + y1)) * dy) / square
        return cx - off * dx, cy - off * dy

    def _start_and_sweep(self) -> tuple[float, float]:
        """Return the start angle and the signed sweep of the arc, in radians from X toward Y.

        A clockwise sweep is negative.
        """
        cx, cy = self._adjusted_center()
        (x0, y0, _), (x1, y1, _) = self.start, self.end
        # With Y up, the angle from X toward Y is counterclockwise.
        return compute_arc_sweep(y0, x0, y1, x1, cy, cx, not self.clockwise)

    def _continuous_angles(self, points: FloatArray, fractions: FloatArray) -> FloatArray:
        """Return continuous polar angles (n,) of points on the arc, up to a constant offset.

        Each result differs by less than 90 degrees from a reference direction. If the axis is inside the
        circle, this is the direction from the center of the arc to the point. Otherwise, it is the
        direction of the center from the axis.
        """
        cx, cy = self._adjusted_center()
        first, sweep = self._start_and_sweep()
        x, y = points[:, 0], points[:, 1]
        if math.hypot(cx, cy) < self.radius - AXIS_TOLERANCE_MM:
            round_centre = first + sweep * fractions
            ux, uy = np.cos(round_centre), np.sin(round_centre)
            inside: FloatArray = round_centre + np.arctan2(ux * y - uy * x, ux * x + uy * y)
            return inside
        towards = math.atan2(cy, cx)
        angle = towards + np.arctan2(cx * y - cy * x, cx * x + cy * y)
        side = -0.5 * math.pi if self.clockwise else 0.5 * math.pi
        limit = towards + np.where(fractions < 0.5, -side, side)
        return np.where(np.hypot(x, y) <= AXIS_TOLERANCE_MM, limit, angle)
