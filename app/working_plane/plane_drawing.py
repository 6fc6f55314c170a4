"""Drawing of the mill at one instant, as lines and faces in pixels.

Points in the workpiece system pass through the chain of axes at the angles of the instant. The faces are
sorted with the farthest first, so that nearer faces cover them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.working_plane.plane_scene import Ink, Scene

if TYPE_CHECKING:
    from app.working_plane.plane_instant import Instant
    from core.geometry.rotary_axes import Kinematics, Place

FloatArray = npt.NDArray[np.float64]
_STEP = 1.25  # factor of one zoom step
_PAN = 0.15  # ratio of the picture's smaller side


@dataclass(frozen=True, slots=True)
class Aspect:
    """View direction in degrees.

    ``around`` is the rotation about Z from the front (negative Y) to the right, and ``above`` is the
    elevation.
    """

    name: str
    around: float
    above: float


ASPECTS = (
    Aspect("3-D", 46.0, 36.0),
    Aspect("FRONT", 0.0, 0.0),
    Aspect("RIGHT", 90.0, 0.0),
    Aspect("TOP", 0.0, 90.0),
)


@dataclass(frozen=True, slots=True)
class Camera:
    """View of ``centre`` (mm, machine).

    A ``radius`` in mm around it fills the picture at ``nearness`` 1.
    """

    centre: tuple[float, float, float]
    radius: float
    aspect: int = 0
    nearness: float = 1.0
    across: float = 0.0  # offset as a ratio of the picture's smaller side
    down: float = 0.0

    @property
    def shown(self) -> Aspect:
        """Selected view direction."""
        return ASPECTS[self.aspect % len(ASPECTS)]

    def following(self) -> Camera:
        """Return the camera for the next view direction, showing everything."""
        return replace(self, aspect=(self.aspect + 1) % len(ASPECTS), nearness=1.0, across=0.0, down=0.0)

    def fitted(self) -> Camera:
        """Return the camera that shows everything."""
        return replace(self, nearness=1.0, across=0.0, down=0.0)

    def zoomed(self, steps: int) -> Camera:
        """Return the camera zoomed in by ``steps``."""
        return replace(self, nearness=min(40.0, max(0.2, self.nearness * _STEP**steps)))

    def panned(self, across: int, down: int) -> Camera:
        """Return the camera moved to the right and down by a number of steps."""
        return replace(self, across=self.across - _PAN * across, down=self.down - _PAN * down)

    @property
    def axes(self) -> FloatArray:
        """Unit vectors right, down and towards the viewer as rows, in machine coordinates."""
        around, above = math.radians(self.shown.around), math.radians(self.shown.above)
        ca, sa, ce, se = math.cos(around), math.sin(around), math.cos(above), math.sin(above)
        right, eye = (ca, sa, 0.0), (sa * ce, -ca * ce, se)
        down = (sa * se, -ca * se, -ce)
        return np.array((right, down, eye))

    def seen(self, points: FloatArray, width: float, height: float) -> FloatArray:
        """Return pixel x, pixel y and depth towards the viewer (n, 3) of machine points (n, 3)."""
        size = min(width, height)
        scale = self.nearness * size / (2.0 * self.radius)
        found = (points - np.array(self.centre)) @ self.axes.T * scale
        found[:, 0] += width / 2.0 + self.across * size
        found[:, 1] += height / 2.0 + self.down * size
        return np.asarray(found)


# --- blank and table ----------------------------------------------------------------------------------


_ROUND = 48  # corners of a circle


def outline(camera: Camera, points: FloatArray) -> FloatArray:
    """Return the convex outline of points (n, 3) as seen by the camera (Andrew's monotone chain)."""
    flat = points @ camera.axes[:2].T
    order = np.lexsort((flat[:, 1], flat[:, 0])).tolist()
    half: list[list[int]] = []
    for run in (order, order[::-1]):
        hull: list[int] = []
        for each in run:
            while len(hull) > 1 and _turns_back(flat, hull[-2], hull[-1], each):
                hull.pop()
            hull.append(each)
        half.append(hull[:-1])
    return np.asarray(points[half[0] + half[1]])


def _turns_back(flat: FloatArray, a: int, b: int, c: int) -> bool:
    u, v = flat[b] - flat[a], flat[c] - flat[a]
    return float(u[0] * v[1] - u[1] * v[0]) <= 0.0


def carried(place: Place, points: FloatArray) -> FloatArray:
    """Return the machine positions (n, 3) of points (n, 3) in the system of ``place``, in mm."""
    return np.asarray(points @ np.array(place.turn).T + np.array(place.shift))


def corners_of(scene: Scene) -> FloatArray:
    """Return the eight corners (8, 3) of the blank in the workpiece system, with x varying fastest."""
    (x0, y0, z0), (x1, y1, z1) = scene.corners
    return np.array([(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)])


def middle_of(scene: Scene) -> tuple[float, float, float]:
    """Return the center of the blank in the workpiece system."""
    low, high = scene.corners
    x, y, z = (0.5 * (a + b) for a, b in zip(low, high, strict=True))
    return x, y, z


def diagonal_of(scene: Scene) -> float:
    """Return the diagonal of the blank in mm, which scales all other sizes."""
    low, high = scene.corners
    return max(1.0, math.dist(low, high))


def table_rim(scene: Scene) -> FloatArray:
    """Return the rim of the table (n, 3) in machine coordinates with all axes at 0.

    The rim is a circle below the blank, around the axis of the first table and wide enough for the blank.
    """
    place = scene.kinematics.place({}, scene.kinematics.basic)
    corners = carried(place, corners_of(scene))
    centre = _foot(scene.kinematics, corners.mean(axis=0))
    radius = 1.12 * float(np.hypot(*(corners[:, :2] - centre[:2]).T).max())
    turn = np.linspace(0.0, 2.0 * math.pi, _ROUND, endpoint=False)
    low = np.full(_ROUND, corners[:, 2].min())
    return np.column_stack((centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn), low))


def _foot(kinematics: Kinematics, middle: FloatArray) -> FloatArray:
    """Return a point on a table axis parallel to Z, or the center of the blank without such an axis."""
    for axis in kinematics.rotaries:
        if axis.table and abs(axis.direction[2]) > 0.5:
            return np.array(axis.point)
    return middle


def spot(row: FloatArray) -> tuple[float, float, float]:
    """Return one row as a tuple of coordinates."""
    x, y, z = row.tolist()
    return x, y, z


_SHARE = 0.34  # ratio to the blank's diagonal: length of the plane's axes and half the side of its square
_TOOL = 12  # corners of the tool
_MOST_POINTS = 10_000  # maximum number of path points; longer paths are thinned out
_FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
_TOP = 1  # index of the top face
_SIDE_ONLY = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """Filled polygon (n, 2). ``role`` is table, table-under, blank, blank-top, plane or tool."""

    role: str
    points: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Stroke:
    """Line (n, 2). ``role`` is rapid, cut, done, x, y, z, axis or edge, and ``name`` labels its end."""

    role: str
    points: FloatArray
    name: str = ""


@dataclass(frozen=True, slots=True)
class Figure:
    """Picture that is ready to paint: faces, then strokes."""

    faces: tuple[Face, ...] = ()
    strokes: tuple[Stroke, ...] = ()


def camera_for(scene: Scene) -> Camera:
    """Return a camera that shows the whole table with the blank and the tool at any tilt."""
    table = table_rim(scene)
    at = scene.kinematics.place({}).machine(middle_of(scene))
    reach = float(np.linalg.norm(table - np.array(at), axis=1).max())
    return Camera((at[0], at[1], at[2] + 0.1 * reach), 1.1 * reach)


def figure(scene: Scene, instant: Instant, camera: Camera, width: float, height: float) -> Figure:
    """Return the drawing of a scene at an instant, for a picture of this size in pixels."""
    picture = _Picture(scene, instant, camera, width, height)
    return Figure(
        faces=tuple(sorted_faces([*picture.table(), *picture.blank(), *picture.plane(), *picture.tool()])),
        strokes=(*picture.path(), *picture.axes(), *picture.lines_of_rotation()),
    )


def sorted_faces(faces: Sequence[tuple[float, Face]]) -> list[Face]:
    """Return the faces in painting order, with the farthest first."""
    return [face for _, face in sorted(faces, key=lambda pair: pair[0])]


class _Picture:
    def __init__(self, scene: Scene, instant: Instant, camera: Camera, width: float, height: float) -> None:
        self._scene, self._instant, self._camera = scene, instant, camera
        self._size = width, height
        chain = scene.kinematics
        self._angles = {axis.name: instant.axes.get(axis.name, 0.0) for axis in chain.rotaries}
        # Workpiece position: a place includes the linear axes, and a tilted head moves them.
        self._tables = {axis.name: self._angles[axis.name] for axis in chain.rotaries if axis.table}
        self._part = chain.place(self._tables, chain.basic)

    def table(self) -> list[tuple[float, Face]]:
        """Return the table disc: painted first when seen from above, and last when seen from below.

        The depth of its center is not sufficient, because a small blank near the far rim is farther away.
        """
        machine_parallel = self._scene.kinematics.place(self._tables)
        zero = self._scene.kinematics.place({})
        flat = carried(machine_parallel, np.array([zero.point(spot(row)) for row in table_rim(self._scene)]))
        up = np.cross(flat[1] - flat[0], flat[2] - flat[1])
        if up @ self._camera.axes[2] > 0.0:
            return [(-math.inf, self._face("table", flat)[1])]
        return [(math.inf, self._face("table-under", flat)[1])]

    def blank(self) -> list[tuple[float, Face]]:
        """Return the faces of the blank that are turned towards the viewer."""
        corners = carried(self._part, corners_of(self._scene))
        middle = corners.mean(axis=0)
        eye = self._camera.axes[2]
        found = []
        for number, face in enumerate(_FACES):
            shape = corners[list(face)]
            if (shape.mean(axis=0) - middle) @ eye > _SIDE_ONLY:
                found.append(self._face("blank-top" if number == _TOP else "blank", shape))
        return found

    def plane(self) -> list[tuple[float, Face]]:
        """Return a square of the working plane around its datum."""
        swivel = self._instant.swivel
        if swivel is None or not swivel.system.tilted:
            return []
        r, o = np.array(swivel.system.frame), np.array(swivel.system.datum)
        half = _SHARE * diagonal_of(self._scene)
        square = np.array([(half, half, 0), (-half, half, 0), (-half, -half, 0), (half, -half, 0)])
        return [self._face("plane", carried(self._part, o + square @ r.T))]

    def tool(self) -> list[tuple[float, Face]]:
        """Return a cutter at the tool tip along the present tool axis."""
        chain, axes = self._scene.kinematics, self._instant.axes
        length = self._instant.swivel.system.tool_length if self._instant.swivel is not None else 0.0
        slides = axes["X"], axes["Y"], axes["Z"]
        tip = np.array(chain.tip(self._angles, slides, length))
        along = np.array(chain.tool_axis(self._angles))
        size = diagonal_of(self._scene)
        aside = np.cross(along, (1.0, 0.0, 0.0) if abs(along[0]) < 0.9 else (0.0, 1.0, 0.0))
        aside /= np.linalg.norm(aside)
        third = np.cross(along, aside)
        turn = np.linspace(0.0, 2.0 * math.pi, _TOOL, endpoint=False)[:, None]
        ring = np.cos(turn) * aside + np.sin(turn) * third
        faces = []
        for low, high, radius in ((0.0, 0.3, 0.03), (0.3, 0.55, 0.07)):
            ends = (
                tip + along * low * size + ring * radius * size,
                tip + along * high * size + ring * radius * size,
            )
            faces.append(self._face("tool", outline(self._camera, np.vstack(ends))))
        return faces

    def path(self) -> list[Stroke]:
        """Return the path of the tip on the workpiece, with finished and remaining moves separate."""
        scene = self._scene
        if not len(scene.points):
            return []
        done = scene.done(self._instant.block)
        keep = np.arange(0, len(scene.points), max(1, len(scene.points) // _MOST_POINTS))
        seen = self._seen(carried(self._part, scene.points[keep]))
        ink, behind = scene.ink[keep], keep < done
        return [*_ways(seen, ink, behind)]

    def axes(self) -> list[Stroke]:
        """Return the axes of the working plane at its datum.

        Without a tilted plane, they are the axes of the workpiece.
        """
        swivel = self._instant.swivel
        r = np.array(swivel.system.frame) if swivel is not None else np.eye(3)
        o = np.array(swivel.system.datum) if swivel is not None else np.zeros(3)
        mark = "'" if swivel is not None and swivel.system.tilted else ""
        length = _SHARE * diagonal_of(self._scene)
        found = []
        for number, name in enumerate("xyz"):
            ends = np.array((o, o + length * r[:, number]))
            found.append(Stroke(name, self._seen(carried(self._part, ends))[:, :2], f"{name.upper()}{mark}"))
        return found

    def lines_of_rotation(self) -> list[Stroke]:
        """Return the rotation axes of the tables in their present position."""
        scene, found = self._scene, []
        reach = 0.75 * diagonal_of(scene)
        rotaries = scene.kinematics.rotaries
        for number, axis in enumerate(rotaries):
            if not axis.table:
                continue
            outer = {each.name: self._angles[each.name] for each in rotaries[number + 1 :] if each.table}
            place, zero = scene.kinematics.place(outer), scene.kinematics.place({})
            middle = np.array(zero.machine(middle_of(scene)))
            along, point = np.array(axis.direction), np.array(axis.point)
            foot = point + along * float((middle - point) @ along)
            ends = np.array((foot - reach * along, foot + reach * along))
            moved = carried(place, np.array([zero.point(spot(end)) for end in ends]))
            found.append(Stroke("axis", self._seen(moved)[:, :2], axis.name))
        return found

    def _seen(self, points: FloatArray) -> FloatArray:
        return self._camera.seen(points, *self._size)

    def _face(self, role: str, points: FloatArray) -> tuple[float, Face]:
        seen = self._seen(points)
        return float(seen[:, 2].mean()), Face(role, seen[:, :2])


def _ways(seen: FloatArray, ink: npt.NDArray[np.int8], behind: npt.NDArray[np.bool_]) -> list[Stroke]:
    """Return the lines of the path, split where the drawing style changes."""
    role = np.where(ink == Ink.CUT, np.where(behind, 3, 2), np.where(ink == Ink.RAPID, 1, 0))
    starts = np.flatnonzero(np.diff(role, prepend=-1))
    names = {1: "rapid", 2: "cut", 3: "done"}
    found = []
    for start, end in zip(starts, [*starts[1:], len(role)], strict=True):
        kind = int(role[start])
        if kind:
            found.append(Stroke(names[kind], seen[max(0, start - 1) : end, :2]))
    return found
