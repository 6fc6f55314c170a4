"""Drawing of the mill at one instant, as lines and faces in pixels.

Points in the workpiece system are transformed through the mill's chain of rotary axes. Faces are painted
from far to near, so that nearer faces cover farther ones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.working_plane.plane_scene import MillScene, MoveStyle

if TYPE_CHECKING:
    from app.working_plane.plane_instant import SceneInstant
    from core.geometry.rotary_axes import FrameTransform, Kinematics

FloatArray = npt.NDArray[np.float64]
_ZOOM_STEP = 1.25  # factor of one zoom step
_PAN_STEP = 0.15  # ratio of the picture's smaller side


@dataclass(frozen=True, slots=True)
class ViewDirection:
    """View direction in degrees.

    ``azimuth_deg`` is the rotation about Z from the front (negative Y) to the right. ``elevation_deg`` is
    the angle above the horizontal.
    """

    name: str
    azimuth_deg: float
    elevation_deg: float


VIEW_ASPECTS = (
    ViewDirection("3-D", 46.0, 36.0),
    ViewDirection("FRONT", 0.0, 0.0),
    ViewDirection("RIGHT", 90.0, 0.0),
    ViewDirection("TOP", 0.0, 90.0),
)


@dataclass(frozen=True, slots=True)
class Camera:
    """Camera that looks at ``center_mm``, in mm and in machine coordinates.

    At ``zoom_factor`` 1, a sphere with the radius ``view_radius_mm`` around the center fills the picture.
    """

    center_mm: tuple[float, float, float]
    view_radius_mm: float
    view_direction_index: int = 0
    zoom_factor: float = 1.0
    offset_right_fraction: float = 0.0  # offset as a ratio of the picture's smaller side
    offset_down_fraction: float = 0.0

    @property
    def view_direction(self) -> ViewDirection:
        """Return the selected view direction."""
        return VIEW_ASPECTS[self.view_direction_index % len(VIEW_ASPECTS)]

    def with_next_view_direction(self) -> Camera:
        """Return a camera with the next view direction, zoomed so that everything is visible."""
        return replace(
            self,
            view_direction_index=(self.view_direction_index + 1) % len(VIEW_ASPECTS),
            zoom_factor=1.0,
            offset_right_fraction=0.0,
            offset_down_fraction=0.0,
        )

    def with_full_view(self) -> Camera:
        """Return the camera zoomed and panned so that everything is visible."""
        return replace(self, zoom_factor=1.0, offset_right_fraction=0.0, offset_down_fraction=0.0)

    def with_zoom(self, step_count: int) -> Camera:
        """Return the camera zoomed in by ``step_count`` steps, or zoomed out if it is negative."""
        return replace(self, zoom_factor=min(40.0, max(0.2, self.zoom_factor * _ZOOM_STEP**step_count)))

    def with_pan(self, steps_right: int, steps_down: int) -> Camera:
        """Return the camera moved to the right and down by a number of steps."""
        return replace(
            self,
            offset_right_fraction=self.offset_right_fraction - _PAN_STEP * steps_right,
            offset_down_fraction=self.offset_down_fraction - _PAN_STEP * steps_down,
        )

    @property
    def view_axes(self) -> FloatArray:
        """Return the unit vectors right, down and towards the viewer, in machine coordinates.

        They are the rows of a matrix.
        """
        around, above = (
            math.radians(self.view_direction.azimuth_deg),
            math.radians(self.view_direction.elevation_deg),
        )
        ca, sa, ce, se = math.cos(around), math.sin(around), math.cos(above), math.sin(above)
        right, eye = (ca, sa, 0.0), (sa * ce, -ca * ce, se)
        down = (sa * se, -ca * se, -ce)
        return np.array((right, down, eye))

    def project_points(self, points: FloatArray, width: float, height: float) -> FloatArray:
        """Return pixel x, pixel y and depth of points in machine coordinates.

        The points and the result have the shape (n, 3). Depth increases towards the viewer.
        """
        size = min(width, height)
        scale = self.zoom_factor * size / (2.0 * self.view_radius_mm)
        found = (points - np.array(self.center_mm)) @ self.view_axes.T * scale
        found[:, 0] += width / 2.0 + self.offset_right_fraction * size
        found[:, 1] += height / 2.0 + self.offset_down_fraction * size
        return np.asarray(found)


# --- blank and table ----------------------------------------------------------------------------------


_RIM_POINTS = 48  # corners of a circle


def find_convex_outline(camera: Camera, points: FloatArray) -> FloatArray:
    """Return the convex outline of points (n, 3) as seen by the camera.

    The method is Andrew's monotone chain.
    """
    flat = points @ camera.view_axes[:2].T
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


def transform_points(system: FrameTransform, points: FloatArray) -> FloatArray:
    """Return the machine positions (n, 3), in mm, of points (n, 3) in the coordinate system ``system``."""
    return np.asarray(points @ np.array(system.rotation).T + np.array(system.translation))


def find_blank_corners(scene: MillScene) -> FloatArray:
    """Return the eight corners (8, 3) of the blank in the workpiece system.

    x varies fastest.
    """
    (x0, y0, z0), (x1, y1, z1) = scene.blank_corners
    return np.array([(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)])


def find_blank_center(scene: MillScene) -> tuple[float, float, float]:
    """Return the center of the blank in the workpiece system."""
    low, high = scene.blank_corners
    x, y, z = (0.5 * (a + b) for a, b in zip(low, high, strict=True))
    return x, y, z


def find_blank_diagonal_mm(scene: MillScene) -> float:
    """Return the diagonal of the blank in mm, from which the sizes of other objects are derived."""
    low, high = scene.blank_corners
    return max(1.0, math.dist(low, high))


def make_rotary_table_rim(scene: MillScene) -> FloatArray:
    """Return the rim of the table (n, 3) in machine coordinates with all axes at 0.

    The rim is a circle below the blank. It is centered on the axis of the first rotary table, and wide
    enough for the blank.
    """
    place = scene.kinematics.make_transform({}, scene.kinematics.workpiece_rotation)
    corners = transform_points(place, find_blank_corners(scene))
    centre = _find_table_center(scene.kinematics, corners.mean(axis=0))
    radius = 1.12 * float(np.hypot(*(corners[:, :2] - centre[:2]).T).max())
    turn = np.linspace(0.0, 2.0 * math.pi, _RIM_POINTS, endpoint=False)
    low = np.full(_RIM_POINTS, corners[:, 2].min())
    return np.column_stack((centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn), low))


def _find_table_center(kinematics: Kinematics, middle: FloatArray) -> FloatArray:
    """Return a point on a table axis parallel to Z, or the blank's center if there is no such axis."""
    for axis in kinematics.rotary_axes:
        if axis.is_table and abs(axis.direction[2]) > 0.5:
            return np.array(axis.point_on_axis)
    return middle


def convert_row_to_tuple(row: FloatArray) -> tuple[float, float, float]:
    """Return a row of an array as a tuple of three coordinates."""
    x, y, z = row.tolist()
    return x, y, z


_PLANE_SIZE_SHARE = (
    0.34  # ratio to the blank's diagonal: length of the plane's axes and half the side of its square
)
_TOOL_CORNERS = 12  # corners of the tool
_MAX_POINTS = 10_000  # maximum number of path points; longer paths are thinned out
_BLANK_FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
_TOP_FACE = 1  # index of the top face
_FACE_TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class DrawnFace:
    """Filled polygon with the corners ``points`` (n, 2).

    ``color_role`` is table, table-under, blank, blank-top, plane or tool.
    """

    color_role: str
    points: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class DrawnStroke:
    """Line through the points ``points`` (n, 2).

    ``color_role`` is rapid, cut, done, x, y, z, axis or edge. ``name`` is the label at its end.
    """

    color_role: str
    points: FloatArray
    name: str = ""


@dataclass(frozen=True, slots=True)
class SceneDrawing:
    """Faces and strokes of the scene, ready to be painted.

    The faces are painted before the strokes.
    """

    faces: tuple[DrawnFace, ...] = ()
    strokes: tuple[DrawnStroke, ...] = ()


def make_camera(scene: MillScene) -> Camera:
    """Return a camera that shows the whole table, with the blank and the tool, at any tilt."""
    table = make_rotary_table_rim(scene)
    at = scene.kinematics.make_transform({}).convert_to_machine_position(find_blank_center(scene))
    reach = float(np.linalg.norm(table - np.array(at), axis=1).max())
    return Camera((at[0], at[1], at[2] + 0.1 * reach), 1.1 * reach)


def draw_scene(
    scene: MillScene, instant: SceneInstant, camera: Camera, width: float, height: float
) -> SceneDrawing:
    """Return the drawing of a scene at an instant, for a picture of the given size in pixels."""
    picture = _ScenePicture(scene, instant, camera, width, height)
    return SceneDrawing(
        faces=tuple(
            sort_faces(
                [
                    *picture.make_table_faces(),
                    *picture.make_blank_faces(),
                    *picture.make_plane_faces(),
                    *picture.make_tool_faces(),
                ]
            )
        ),
        strokes=(
            *picture.make_path_strokes(),
            *picture.make_axis_strokes(),
            *picture.make_rotary_axis_strokes(),
        ),
    )


def sort_faces(faces: Sequence[tuple[float, DrawnFace]]) -> list[DrawnFace]:
    """Return the faces in painting order, with the farthest first."""
    return [face for _, face in sorted(faces, key=lambda pair: pair[0])]


class _ScenePicture:
    def __init__(
        self, scene: MillScene, instant: SceneInstant, camera: Camera, width: float, height: float
    ) -> None:
        self._scene, self._instant, self._camera = scene, instant, camera
        self._size = width, height
        chain = scene.kinematics
        self._angles = {axis.name: instant.axis_positions.get(axis.name, 0.0) for axis in chain.rotary_axes}
        # Workpiece position: a place includes the linear axes, and a tilted head moves them.
        self._tables = {axis.name: self._angles[axis.name] for axis in chain.rotary_axes if axis.is_table}
        self._part = chain.make_transform(self._tables, chain.workpiece_rotation)

    def make_table_faces(self) -> list[tuple[float, DrawnFace]]:
        """Return the disk of the rotary table as a face with its painting depth.

        The disk is painted first if its top is visible, and last if its underside is visible. The depth of
        its center would give a wrong order for a small blank near the far rim.
        """
        machine_parallel = self._scene.kinematics.make_transform(self._tables)
        zero = self._scene.kinematics.make_transform({})
        flat = transform_points(
            machine_parallel,
            np.array(
                [
                    zero.convert_to_frame_point(convert_row_to_tuple(row))
                    for row in make_rotary_table_rim(self._scene)
                ]
            ),
        )
        up = np.cross(flat[1] - flat[0], flat[2] - flat[1])
        if up @ self._camera.view_axes[2] > 0.0:
            return [(-math.inf, self._face("table", flat)[1])]
        return [(math.inf, self._face("table-under", flat)[1])]

    def make_blank_faces(self) -> list[tuple[float, DrawnFace]]:
        """Return the faces of the blank that face the viewer."""
        corners = transform_points(self._part, find_blank_corners(self._scene))
        middle = corners.mean(axis=0)
        eye = self._camera.view_axes[2]
        found = []
        for number, face in enumerate(_BLANK_FACES):
            shape = corners[list(face)]
            if (shape.mean(axis=0) - middle) @ eye > _FACE_TOLERANCE:
                found.append(self._face("blank-top" if number == _TOP_FACE else "blank", shape))
        return found

    def make_plane_faces(self) -> list[tuple[float, DrawnFace]]:
        """Return a square in the tilted working plane around its datum.

        Return no faces if the plane is not tilted.
        """
        swivel = self._instant.plane_position
        if swivel is None or not swivel.system.is_tilted:
            return []
        r, o = np.array(swivel.system.frame), np.array(swivel.system.datum)
        half = _PLANE_SIZE_SHARE * find_blank_diagonal_mm(self._scene)
        square = np.array([(half, half, 0), (-half, half, 0), (-half, -half, 0), (half, -half, 0)])
        return [self._face("plane", transform_points(self._part, o + square @ r.T))]

    def make_tool_faces(self) -> list[tuple[float, DrawnFace]]:
        """Return the faces of a cutter at the tool tip, aligned with the current tool axis."""
        chain, axes = self._scene.kinematics, self._instant.axis_positions
        length = (
            self._instant.plane_position.system.tool_length_mm
            if self._instant.plane_position is not None
            else 0.0
        )
        slides = axes["X"], axes["Y"], axes["Z"]
        tip = np.array(chain.compute_tip_position(self._angles, slides, length))
        along = np.array(chain.compute_tool_direction(self._angles))
        size = find_blank_diagonal_mm(self._scene)
        aside = np.cross(along, (1.0, 0.0, 0.0) if abs(along[0]) < 0.9 else (0.0, 1.0, 0.0))
        aside /= np.linalg.norm(aside)
        third = np.cross(along, aside)
        turn = np.linspace(0.0, 2.0 * math.pi, _TOOL_CORNERS, endpoint=False)[:, None]
        ring = np.cos(turn) * aside + np.sin(turn) * third
        faces = []
        for low, high, radius in ((0.0, 0.3, 0.03), (0.3, 0.55, 0.07)):
            ends = (
                tip + along * low * size + ring * radius * size,
                tip + along * high * size + ring * radius * size,
            )
            faces.append(self._face("tool", find_convex_outline(self._camera, np.vstack(ends))))
        return faces

    def make_path_strokes(self) -> list[DrawnStroke]:
        """Return the path of the tool tip on the workpiece.

        Completed and remaining moves are separate strokes.
        """
        scene = self._scene
        if not len(scene.tip_points):
            return []
        done = scene.count_finished_points(self._instant.active_block_number)
        keep = np.arange(0, len(scene.tip_points), max(1, len(scene.tip_points) // _MAX_POINTS))
        seen = self._seen(transform_points(self._part, scene.tip_points[keep]))
        ink, is_finished = scene.move_styles[keep], keep < done
        return [*_make_strokes(seen, ink, is_finished)]

    def make_axis_strokes(self) -> list[DrawnStroke]:
        """Return the axes of the working plane at its datum.

        If the plane is not tilted, these are the axes of the workpiece.
        """
        swivel = self._instant.plane_position
        r = np.array(swivel.system.frame) if swivel is not None else np.eye(3)
        o = np.array(swivel.system.datum) if swivel is not None else np.zeros(3)
        mark = "'" if swivel is not None and swivel.system.is_tilted else ""
        length = _PLANE_SIZE_SHARE * find_blank_diagonal_mm(self._scene)
        found = []
        for number, name in enumerate("xyz"):
            ends = np.array((o, o + length * r[:, number]))
            found.append(
                DrawnStroke(
                    name, self._seen(transform_points(self._part, ends))[:, :2], f"{name.upper()}{mark}"
                )
            )
        return found

    def make_rotary_axis_strokes(self) -> list[DrawnStroke]:
        """Return a line for the rotation axis of each rotary table, in its current position."""
        scene, found = self._scene, []
        reach = 0.75 * find_blank_diagonal_mm(scene)
        rotaries = scene.kinematics.rotary_axes
        for number, axis in enumerate(rotaries):
            if not axis.is_table:
                continue
            outer = {each.name: self._angles[each.name] for each in rotaries[number + 1 :] if each.is_table}
            place, zero = scene.kinematics.make_transform(outer), scene.kinematics.make_transform({})
            middle = np.array(zero.convert_to_machine_position(find_blank_center(scene)))
            along, point = np.array(axis.direction), np.array(axis.point_on_axis)
            foot = point + along * float((middle - point) @ along)
            ends = np.array((foot - reach * along, foot + reach * along))
            moved = transform_points(
                place, np.array([zero.convert_to_frame_point(convert_row_to_tuple(end)) for end in ends])
            )
            found.append(DrawnStroke("axis", self._seen(moved)[:, :2], axis.name))
        return found

    def _seen(self, points: FloatArray) -> FloatArray:
        return self._camera.project_points(points, *self._size)

    def _face(self, role: str, points: FloatArray) -> tuple[float, DrawnFace]:
        seen = self._seen(points)
        return float(seen[:, 2].mean()), DrawnFace(role, seen[:, :2])


def _make_strokes(
    seen: FloatArray, styles: npt.NDArray[np.int8], is_finished: npt.NDArray[np.bool_]
) -> list[DrawnStroke]:
    """Return the strokes of the tool path. A new stroke begins where the drawing style changes."""
    role = np.where(
        styles == MoveStyle.CUT, np.where(is_finished, 3, 2), np.where(styles == MoveStyle.RAPID, 1, 0)
    )
    starts = np.flatnonzero(np.diff(role, prepend=-1))
    names = {1: "rapid", 2: "cut", 3: "done"}
    found = []
    for start, end in zip(starts, [*starts[1:], len(role)], strict=True):
        kind = int(role[start])
        if kind:
            found.append(DrawnStroke(names[kind], seen[max(0, start - 1) : end, :2]))
    return found
