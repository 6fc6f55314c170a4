"""Drawing of a touch-off in millimeters: the part, the touched surface and the tool at two offsets.

Points are (z, x), with X as a radius and part zero at the origin. The axes are at rest during a touch-off.
Therefore, the tool tip is at the entered size according to the new offset, and at another position
according to the old offset. The part is an example that has the entered size. Only the measured axis is to
scale with the machine: across it, the tool is drawn at a suitable place of the example.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from functools import lru_cache

import numpy as np

from core.part.tool_outline import ToolOutline, make_tool_outline
from core.part.tool_shape import ToolShape
from core.sketch import Point
from core.tool_edges import TIP_DIRECTIONS

Polygon = tuple[Point, ...]
Bounds = tuple[float, float, float, float]  # Lowest and highest Z, then lowest and highest X.
_FAR_MM = 2000.0  # mm: the example part continues to the edge of the picture.
_MIN_SIZE_MM, _MAX_SIZE_MM = 4.0, 20.0  # mm: limits of the size that the picture is based on.
_NEAR = 5.0  # Sizes: distance up to which the picture contains the zero point of the dimension.
_TOUCH_TOLERANCE_MM = 1e-6
_CENTER_TOLERANCE_MM = 0.01  # Largest distance of a tool that is on the spindle centerline.


class TouchedSurface(Enum):
    """The surface of the part that a tool touches."""

    OUTSIDE_DIAMETER = auto()
    BORE = auto()
    FACE = auto()
    CENTERLINE = auto()  # The control point of the tool is on the spindle centerline.
    NONE = auto()  # A part of the tool is on the centerline, so the tool cannot touch a diameter.


@dataclass(frozen=True, slots=True)
class ToolAtPart:
    """A tool that touches a diameter or a face.

    - ``side`` is 1 if the tool works at positive X, and -1 if it works at negative X.
    - ``new_position_mm`` is X (as a radius) or Z of the tip according to the entered size. It is None
      until the entry is a number.
    - ``old_position_mm`` is the same position according to the old offset. It is None for a new tool.
    - ``is_skim_cut`` means that the tool has cut the surface that was measured.
    """

    shape: ToolShape
    side: int
    is_internal: bool
    is_diameter: bool
    new_position_mm: float | None = None
    old_position_mm: float | None = None
    is_skim_cut: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class TouchOffScene:
    """Outlines and dimension of a touch-off in mm.

    - ``tool_outline`` is relative to the tip, which is at ``new_tip`` and ``old_tip``.
    - ``dimension`` extends across the diameter, or from part zero to the control point of the tool.
    - ``visible_area`` is the area that the picture must contain.
    """

    surface: TouchedSurface
    part_outlines: tuple[Polygon, ...]
    touched_edge: tuple[Point, Point] | None
    tool_outline: ToolOutline
    new_tip: Point | None
    old_tip: Point | None
    dimension: tuple[Point, Point]
    visible_area: Bounds


def _find_sign(*positions_mm: float | None) -> int:
    """Return the sign of the first position that is known and not on the centerline, or else 0."""
    signs = (
        int(math.copysign(1, x)) for x in positions_mm if x is not None and abs(x) > _CENTER_TOLERANCE_MM
    )
    return next(signs, 0)


def find_working_side(
    shape: ToolShape, old_x_mm: float | None, new_x_mm: float | None = None
) -> tuple[int, bool]:
    """Return the side of the part on which a tool works, and whether it works in a bore.

    The side is 1 for positive X. A rotating tool can work on both sides, so it is assumed to remain on its
    side. ``old_x_mm`` and ``new_x_mm`` are X of the tip according to the old offset and to the entry.
    """
    if not shape.is_rotating:
        return -1 if shape.is_rear_tool else 1, shape.internal
    points_to_positive_x = TIP_DIRECTIONS[shape.tip] == (0, 1)
    return -1 if points_to_positive_x else _find_sign(old_x_mm, new_x_mm) or 1, False


def assume_working_side(
    quadrant: int, old_x_mm: float | None, new_x_mm: float | None = None
) -> tuple[int, bool]:
    """Return the assumed side and whether the tool works in a bore, if its shape is not stored.

    The old offset can be wrong. Therefore, it does not decide that the tool works in a bore. A tool that
    points to negative X is an outside tool at positive X, unless the entry confirms the other side.
    """
    across = TIP_DIRECTIONS[quadrant][1]
    old, new = _find_sign(old_x_mm), _find_sign(new_x_mm)
    if across < 0 and (not new or new != (old or new)):
        return 1, False
    side = new or old or 1
    return side, across * side > 0


@lru_cache(maxsize=16)
def _find_outline(shape: ToolShape) -> ToolOutline:
    return make_tool_outline(shape)


def make_touch_off_scene(tool: ToolAtPart) -> TouchOffScene:
    """Return the drawing of a touch-off.

    Raises InsertCodeError or PartError if the shape of the tool cannot be drawn.
    """
    outline = _find_outline(tool.shape)
    return _draw_diameter(tool, outline) if tool.is_diameter else _draw_face(tool, outline)


def find_reference_size(outline: ToolOutline) -> float:
    """Return the size in mm that the part and the visible area are based on.

    It is the size of the cutting edge, or the diameter of a round tool and half of it.
    """
    extent = np.ptp(np.concatenate(outline.cutting_outlines), axis=0)
    size = 1.5 * extent.min() if outline.is_axially_symmetric else extent.max()
    return float(np.clip(size, _MIN_SIZE_MM, _MAX_SIZE_MM))


def _find_edge_distance(outline: ToolOutline, axis: int, direction: int) -> float:
    """Return the distance from the control point to the outermost edge in a direction, in mm.

    ``axis`` is 0 for Z and 1 for X. The distance is 0 if the control point is on the edge, as for a tip
    quadrant that points in this direction.
    """
    distance = max(float((direction * each[:, axis]).max()) for each in outline.cutting_outlines)
    return distance if abs(distance) > _TOUCH_TOLERANCE_MM else 0.0


def _is_near(position: float, size: float) -> bool:
    return abs(position) <= _NEAR * size


def _list_known(*positions: float | None) -> tuple[float, ...]:
    return tuple(each for each in positions if each is not None)


def _mirror(profile: Sequence[Point], *, is_hollow: bool) -> tuple[Polygon, ...]:
    """Return the section of a part with the given profile above the axis.

    The profile of a hollow part is a closed polygon. That of a solid part begins and ends at the same end
    of the section as the axis.
    """
    other = tuple((z, -x) for z, x in profile)
    return (tuple(profile), other) if is_hollow else ((*profile, *reversed(other)),)


# --- a diameter ----------------------------------------------------------------------------------------


def _draw_diameter(tool: ToolAtPart, outline: ToolOutline) -> TouchOffScene:
    size = find_reference_size(outline)
    known = _list_known(tool.new_position_mm, tool.old_position_mm)
    x = known[0] if known else 1.2 * size * tool.side
    toward = tool.side if tool.is_internal else -tool.side  # The part is on this side of the tool.
    edge = _find_edge_distance(outline, 1, toward)
    radius = abs(x) + (edge if tool.is_internal else -edge)
    is_touching = radius > _TOUCH_TOLERANCE_MM
    if not is_touching:
        part = _mirror(((-_FAR_MM, size), (0.0, size)), is_hollow=False)
        is_centered = abs(x) <= _CENTER_TOLERANCE_MM
        surface = TouchedSurface.CENTERLINE if is_centered else TouchedSurface.NONE
    else:
        part = _make_turned_part(tool, radius, size)
        surface = TouchedSurface.BORE if tool.is_internal else TouchedSurface.OUTSIDE_DIAMETER
    return TouchOffScene(
        surface,
        part,
        _find_touched_line(tool, radius, size) if is_touching else None,
        outline,
        (0.0, x) if tool.new_position_mm is not None or not known else None,
        (0.0, tool.old_position_mm) if tool.old_position_mm is not None else None,
        ((-1.3 * size, -x), (-1.3 * size, x)),
        _find_diameter_area(tool, known or (x,), radius, size),
    )


def _make_turned_part(tool: ToolAtPart, radius: float, size: float) -> tuple[Polygon, ...]:
    """Return a bar or a tube whose touched diameter has the given radius.

    After a skim cut, the material that was not cut has a step at the tip.
    """
    depth = 0.0
    if tool.is_skim_cut:
        depth = 0.2 * size if not tool.is_internal else -min(0.2 * size, 0.5 * radius)
    cuts_to_right = tool.shape.direction[0] > 0
    left, right = (radius, radius + depth) if cuts_to_right else (radius + depth, radius)
    line = [(-_FAR_MM, left), (0.0, left), (0.0, right), (size, right)]
    if not tool.is_internal:
        return _mirror(line, is_hollow=False)
    wall = radius + 0.8 * size
    return _mirror([*line, (size, wall), (-_FAR_MM, wall)], is_hollow=True)


def _find_touched_line(tool: ToolAtPart, radius: float, size: float) -> tuple[Point, Point]:
    """Return the touched line of the surface, which is on the side on which the tool works."""
    x = tool.side * radius
    if not tool.is_skim_cut:
        return (-size, x), (size, x)
    return ((-size, x), (0.0, x)) if tool.shape.direction[0] > 0 else ((0.0, x), (size, x))


def _find_diameter_area(tool: ToolAtPart, positions: Iterable[float], radius: float, size: float) -> Bounds:
    """Return the visible area, with the tool at all positions and the centerline if it is near."""
    body = -tool.shape.direction[1] or (0 if tool.shape.is_rotating else tool.side)
    points = [each for x in positions for each in (x - 0.3 * size, x + 0.3 * size, x + 1.5 * size * body)]
    if tool.is_internal:
        points += [math.copysign(radius + size, x) for x in positions]
        points.append(tool.side * (radius + 0.3 * size))  # A wrong tip is opposite the touched line.
    if tool.shape.is_rotating:
        points += [-1.2 * size, 1.2 * size]
    elif all(_is_near(x, size) for x in positions):
        points.append(-0.4 * size * tool.side)
    return -2.0 * size, 2.0 * size, min(points), max(points)


# --- a face --------------------------------------------------------------------------------------------


def _draw_face(tool: ToolAtPart, outline: ToolOutline) -> TouchOffScene:
    size = find_reference_size(outline)
    known = _list_known(tool.new_position_mm, tool.old_position_mm)
    z = known[0] if known else 0.0
    toward = 1 if tool.shape.direction[0] > 0 else -1  # The part is on this side of the tool.
    face = z + toward * _find_edge_distance(outline, 0, toward)
    x = 0.0 if outline.is_axially_symmetric else tool.side * size
    return TouchOffScene(
        TouchedSurface.FACE,
        _make_faced_part(tool, face, toward, abs(x), size),
        _find_touched_face(tool, face, x, size),
        outline,
        (z, x) if tool.new_position_mm is not None or not known else None,
        (tool.old_position_mm, x) if tool.old_position_mm is not None else None,
        ((0.0, -0.6 * size * tool.side), (z, -0.6 * size * tool.side)),
        _find_face_area(tool, known or (z,), x, size),
    )


def _make_faced_part(
    tool: ToolAtPart, face: float, toward: int, tip_x: float, size: float
) -> tuple[Polygon, ...]:
    """Return a part whose touched face is at ``face``, and which is on the side ``toward`` of the face."""
    end, rim = face + toward * _FAR_MM, 1.8 * size
    if tool.is_internal:
        bore = [(end, 0.5 * size), (face, 0.5 * size)]
        if toward < 0:
            return _mirror([*bore, (face, rim), (end, rim)], is_hollow=True)
        wall = [(face, rim - 0.3 * size), (-_FAR_MM, rim - 0.3 * size), (-_FAR_MM, rim), (end, rim)]
        return _mirror([*bore, *wall], is_hollow=True)
    if toward > 0:  # A shoulder that faces the chuck.
        return _mirror(
            ((face - _FAR_MM, 0.4 * size), (face, 0.4 * size), (face, rim), (end, rim)), is_hollow=False
        )
    line = [(end, rim), (face, rim)]
    if tool.is_skim_cut and tip_x:
        line += [(face, tip_x), (face + 0.2 * size, tip_x)]
    return _mirror(line, is_hollow=False)


def _find_touched_face(tool: ToolAtPart, face: float, tip_x: float, size: float) -> tuple[Point, Point]:
    rim = 1.8 * size * tool.side
    if not tip_x:
        return (face, -rim), (face, rim)
    inner = tip_x if tool.is_skim_cut else 0.5 * size * tool.side
    return (face, inner), (face, rim)


def _find_face_area(tool: ToolAtPart, positions: Sequence[float], tip_x: float, size: float) -> Bounds:
    """Return the visible area, with the tool at all positions and part zero if it is near."""
    ends = [*positions, *([0.0] if all(_is_near(z, size) for z in positions) else [])]
    rows = sorted((-size * tool.side, tip_x + 1.6 * size * tool.side))
    return min(ends) - 1.8 * size, max(ends) + 2.0 * size, rows[0], rows[1]
