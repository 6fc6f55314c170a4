"""Plane switching: lines and arcs of a virtual mill, and the lathe positions X, Z and C along them.

XC mills on the face of the part. ZC mills on its side, unrolled at a diameter. The live tool is on the
negative X side of the lathe, or on the positive side if ``far`` is True. For a tool that looks at the part
from there, mill X points to the right and Y up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import arc_sweep

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Face:
    """The face plane XC. ``c0`` (degrees) is C at the entry, ``h`` (mm) the tool's height above the axis.

    A point (X, Y) of the part at the distance rho from the axis is under the tool if X is at -sqrt(rho² -
    h²), or at the positive value on the far side, and C has rotated the point there.
    """

    c0: float
    h: float = 0.0
    far: bool = False

    @property
    def heading(self) -> float:
        """The angle on the part at which mill X points, in degrees from the negative X side at C0."""
        return _heading(self.c0, far=self.far)

    def machine(self, points: FloatArray, theta: FloatArray) -> FloatArray:
        """Return lathe X (radius), Z, C (n, 3) of mill points X, Y, Z (n, 3), in mm and degrees.

        ``theta`` (n,) is the continuous polar angle of the points in radians. A point closer to the axis than
        |h| cannot be reached and is treated as if it were at |h|.
        """
        rho = np.hypot(points[:, 0], points[:, 1])
        x = np.sqrt(np.maximum((rho - self.h) * (rho + self.h), 0.0))
        lead = np.arctan2(np.full(len(x), self.h), x) if self.h else np.zeros(len(x))
        return np.column_stack([x if self.far else -x, points[:, 2], self.c0 + np.degrees(lead - theta)])

    def mill(self, machine: FloatArray) -> FloatArray:
        """Return the mill points X, Y, Z (n, 3) under the tool at lathe X, Z, C (n, 3)."""
        x = machine[:, 0] if self.far else -machine[:, 0]
        rho = np.hypot(x, self.h)
        theta = np.arctan2(self.h, x) - np.radians(machine[:, 2] - self.c0)
        return np.column_stack([rho * np.cos(theta), rho * np.sin(theta), machine[:, 1]])


@dataclass(frozen=True, slots=True)
class Side:
    """The side plane ZC, unrolled at ``diameter``.

    ``c0`` (degrees) and ``z0`` (mm) are C and lathe Z of X0 Y0. Mill X points toward the spindle, Y is
    measured at ``diameter``, and Z is the radius of the tip. Lengths are in mm.
    """

    c0: float
    z0: float
    diameter: float
    far: bool = False

    def machine(self, points: FloatArray) -> FloatArray:
        """Return lathe X (radius), Z, C (n, 3) of mill points X, Y, Z (n, 3), with mill Z as a radius."""
        x, y, z = points.T
        c = self.c0 - y * (360.0 / (math.pi * self.diameter))
        return np.column_stack([z if self.far else -z, self.z0 - x, c])

    def mill(self, machine: FloatArray) -> FloatArray:
        """Return mill points X, Y, Z (n, 3), with Z as a radius, of lathe X, Z, C (n, 3)."""
        x, z, c = machine.T
        up = x if self.far else -x
        return np.column_stack([self.z0 - z, (self.c0 - c) * (math.pi * self.diameter / 360.0), up])


def _heading(c0: float, *, far: bool) -> float:
    return 180.0 - c0 if far else -c0


Spot = tuple[float, float, float]

CENTRE = 1e-4  # mm; a path closer than this to the spindle axis passes through the axis
_SAMPLES = 721  # points of an arc at which its extent is sampled: 0.5 degree of a full circle


@dataclass(frozen=True, slots=True)
class PlaneMove:
    """A straight line, or with ``centre`` an arc, in the mill's frame, with X, Y, Z in mm.

    On the side of the part, Z is a radius. ``theta`` is the continuous polar angle of the start in radians,
    so that C never jumps by a revolution. It matters only on the face. If the start is the center, it is the
    direction of departure. The end of an arc is within the control's tolerance of its circle.
    """

    frame: Face | Side
    start: Spot
    end: Spot
    theta: float = 0.0
    centre: tuple[float, float] | None = None
    clockwise: bool = False

    @property
    def length(self) -> float:
        """Length of the mill's path, in mm."""
        if self.centre is None:
            return math.dist(self.start, self.end)
        _, sweep = self._circle()
        return self.radius * abs(sweep)

    @property
    def in_degrees(self) -> bool:
        """Always False, because the feed is in mm."""
        return False

    @property
    def radius(self) -> float:
        """Radius of the arc in mm, or 0 for a line."""
        return 0.0 if self.centre is None else math.dist(self.start[:2], self._settled())

    @property
    def on_side(self) -> bool:
        """True if the mill machines the side of the part."""
        return isinstance(self.frame, Side)

    @property
    def straight(self) -> bool:
        """True if the lathe axes move proportionally."""
        return self.centre is None and isinstance(self.frame, Side)

    def points(self, share: FloatArray) -> FloatArray:
        """Return mill points (n, 3) at fractions of the path (n,)."""
        start, end = np.array(self.start), np.array(self.end)
        points = np.asarray(start + share[:, None] * (end - start), dtype=np.float64)
        if self.centre is not None:
            first, sweep = self._circle()
            angle = first + sweep * share
            cx, cy = self._settled()
            points[:, 0], points[:, 1] = cx + self.radius * np.cos(angle), cy + self.radius * np.sin(angle)
        return points

    def machine(self, share: FloatArray) -> FloatArray:
        """Return lathe X (radius), Z, C (n, 3) at fractions of the path (n,), with continuous C."""
        points = self.points(share)
        if isinstance(self.frame, Side):
            return self.frame.machine(points)
        return self.frame.machine(points, self.thetas(points, share))

    def part(self, points: FloatArray) -> FloatArray:
        """Return mill points (n, 3) of lathe X, Z, C (n, 3)."""
        return self.frame.mill(points)

    def thetas(self, points: FloatArray, share: FloatArray) -> FloatArray:
        """Return continuous polar angles (n,) of ``points`` of this path, from ``theta`` on, in radians."""
        if self.centre is None:
            x0, y0, _ = self.start if math.hypot(*self.start[:2]) > CENTRE else self.end
            at_centre = np.hypot(points[:, 0], points[:, 1]) <= CENTRE
            turned = np.arctan2(x0 * points[:, 1] - y0 * points[:, 0], x0 * points[:, 0] + y0 * points[:, 1])
            along: FloatArray = self.theta + np.where(at_centre, 0.0, turned)
            return along
        both = np.array([0.0, 1.0])
        begin = self._winding(self.points(both), both)[0]
        wound: FloatArray = self.theta - begin + self._winding(points, share)
        return wound

    def parts(self) -> list[PlaneMove]:
        """Return the move, divided in two if it passes through the axis, where C must turn in between."""
        if isinstance(self.frame, Side) or self.length <= CENTRE:
            return [self]
        share = self.nearest()
        if self.rho(share) > CENTRE or any(math.hypot(*end[:2]) <= CENTRE for end in (self.start, self.end)):
            return [self]
        z = float(self.points(np.array([share]))[0, 2])
        return [replace(self, end=(0.0, 0.0, z)), replace(self, start=(0.0, 0.0, z))]

    def turn_at_start(self) -> float:
        """Return the change of the polar angle before a move that starts on the axis, in radians.

        The change is in the shorter direction.
        """
        if isinstance(self.frame, Side) or math.hypot(*self.start[:2]) > CENTRE or self.length <= CENTRE:
            return 0.0
        x, y = self.points(np.array([0.0, 1.0]))[1][:2].tolist()
        if self.centre is not None:
            i, j = self.centre
            x, y = (-j, i) if self.clockwise else (j, -i)
        turn = (math.atan2(y, x) - self.theta + math.pi) % (2 * math.pi) - math.pi
        if abs(abs(turn) - math.pi) < 1e-6:
            # The path passes straight through the axis. C decreases, as for a center on the left.
            return abs(turn)
        return turn

    def nearest(self) -> float:
        """Return the fraction of the path that is closest to the axis."""
        if self.centre is None:
            dx, dy = self.end[0] - self.start[0], self.end[1] - self.start[1]
            square = dx * dx + dy * dy
            foot = -(self.start[0] * dx + self.start[1] * dy) / square if square else 0.0
            return min(max(foot, 0.0), 1.0)
        return self._at_angle(math.atan2(-self._settled()[1], -self._settled()[0]))

    def rho(self, share: float) -> float:
        """Return the distance from the axis in mm at a fraction of the path."""
        x, y, _ = self.points(np.array([share]))[0].tolist()
        return math.hypot(x, y)

    def reach(self) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest lathe X, Z, C (3,) along the path."""
        count = 2 if self.straight else _SAMPLES
        table = self.machine(np.append(np.linspace(0.0, 1.0, count), self.nearest()))
        return table.min(axis=0), table.max(axis=0)

    def _at_angle(self, angle: float) -> float:
        """Return the fraction of the arc at this angle around its center.

        If the arc does not contain the angle, the end closer to the axis is returned.
        """
        first, sweep = self._circle()
        turn = 2.0 * math.pi
        way = (angle - first) % turn if sweep > 0.0 else (first - angle) % turn
        share = way / abs(sweep)
        if share <= 1.0:
            return share
        return 0.0 if self.rho(0.0) <= self.rho(1.0) else 1.0

    def _settled(self) -> tuple[float, float]:
        """Return the center moved to the bisector of the chord, so that the arc meets its end exactly."""
        assert self.centre is not None
        (x0, y0, _), (x1, y1, _), (cx, cy) = self.start, self.end, self.centre
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        if square < 1e-12:
            return cx, cy
        off = ((cx - 0.5 * (x0 + x1)) * dx + (cy - 0.5 * (y0 + y1)) * dy) / square
        return cx - off * dx, cy - off * dy

    def _circle(self) -> tuple[float, float]:
        """Return the start angle, from X toward Y, and the signed sweep in radians; clockwise is negative."""
        cx, cy = self._settled()
        (x0, y0, _), (x1, y1, _) = self.start, self.end
        # With Y up, the angle from X toward Y is counterclockwise.
        return arc_sweep(y0, x0, y1, x1, cy, cx, not self.clockwise)

    def _winding(self, points: FloatArray, share: FloatArray) -> FloatArray:
        """Return polar angles (n,) of points of the arc, continuous along it except for a constant.

        If the axis is inside the circle, the result is the angle around the center of the arc plus less than
        90 degrees. Otherwise it is the direction of the center plus less than 90 degrees.
        """
        cx, cy = self._settled()
        first, sweep = self._circle()
        x, y = points[:, 0], points[:, 1]
        if math.hypot(cx, cy) < self.radius - CENTRE:
            round_centre = first + sweep * share
            ux, uy = np.cos(round_centre), np.sin(round_centre)
            inside: FloatArray = round_centre + np.arctan2(ux * y - uy * x, ux * x + uy * y)
            return inside
        towards = math.atan2(cy, cx)
        angle = towards + np.arctan2(cx * y - cy * x, cx * x + cy * y)
        side = -0.5 * math.pi if self.clockwise else 0.5 * math.pi
        limit = towards + np.where(share < 0.5, -side, side)
        return np.where(np.hypot(x, y) <= CENTRE, limit, angle)
