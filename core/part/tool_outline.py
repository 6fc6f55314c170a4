"""Outlines of tools in the XZ plane: cutting edges and bodies, by tool kind and dimensions.

Every tool is drawn in one orientation, in which it points to the chuck and the axis (quadrant 3, 8 for a
symmetrical tool, 7 for a drill). It is then mirrored to the quadrant of its tip. The sign of X is not
changed: the holder of a front tool is at X+ of its tip, and the holder of a rear tool is at X−. A boring
bar may extend across the axis, where |X| applies. Standard holder dimensions replace dimensions that are
not specified, and the names of these dimensions are listed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from core.part.insert_codes import (
    CuttingInsert,
    ToolHolder,
    decode_insert_code,
    make_insert,
    make_standard_shank,
    parse_holder,
)
from core.part.tool_polygons import (
    MAX_BODY_CHORD_ERROR_MM,
    MAX_NOSE_CHORD_ERROR_MM,
    FloatArray,
    find_convex_hull,
    find_max_corner_radius,
    find_nose_center,
    make_circle,
    make_polygon,
    make_polygon_from_edges,
    make_rectangle,
    orient_counterclockwise,
    round_corners,
    split_into_convex_pieces,
)
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.tool_edges import TIP_DIRECTIONS

# Entering angles of the usual holders, ISO 5608: MCLN, DDJN, MVJN, MTJN, MWLN, MSRN, CKJN and the like.
ENTERING_ANGLES: Mapping[str, float] = {
    **{"C": 95.0, "W": 95.0, "D": 93.0, "V": 93.0, "T": 93.0, "K": 93.0, "S": 75.0, "E": 95.0, "M": 90.0},
    **{"P": 60.0, "H": 50.0, "O": 40.0},
}
BORING_ENTERING_ANGLES: Mapping[str, float] = {**ENTERING_ANGLES, "T": 91.0}  # STFC
DEFAULT_NOSE_RADIUS_MM = 0.4  # mm, nose radius of an unknown insert
# Bars of ISO 5609: diameter → tip to axis, mm.
_BARS = (
    (0.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0, 40.0),
    (0.0, 6.0, 7.0, 9.0, 11.0, 13.0, 17.0, 22.0, 27.0),
)
_INSERT_OVERHANG_FRACTION = (
    0.1  # fraction of the inscribed circle by which an insert extends from its seat, at most 1 mm
)
_BLADE = 0.8  # fraction of the width of the edge
_TAP_LEAD = 3.0  # pitches
_POINTS = {ToolKind.DRILL: 118.0, ToolKind.CENTER_DRILL: 60.0, ToolKind.THREADING: 60.0}


@dataclass(frozen=True, slots=True)
class ToolOutline:
    """Convex polygons (k, 2) of (z, r) about the control point, in mm, counterclockwise.

    ``cutting_outlines`` remove material, and ``body_outlines`` must not touch any material.
    ``is_axially_symmetric`` means that the tool is rotationally symmetrical about an axis parallel to Z.
    ``assumed_fields`` lists the fields of the shape for which a standard size is used.
    """

    cutting_outlines: tuple[FloatArray, ...]
    body_outlines: tuple[FloatArray, ...] = ()
    is_axially_symmetric: bool = False
    assumed_fields: tuple[str, ...] = ()


@dataclass(slots=True)
class _OutlineDrawing:
    """The outline of one tool while it is drawn, in the standard orientation of all tools."""

    shape: ToolShape
    cutting_outlines: list[FloatArray] = field(default_factory=list)
    body_outlines: list[FloatArray] = field(default_factory=list)
    assumed_fields: list[str] = field(default_factory=list)

    def get_dimension(self, name: str, usual: float) -> float:
        """Return a dimension of the shape, or the standard size ``usual`` if it is not specified.

        The names of the dimensions with standard sizes are recorded.
        """
        stated = float(getattr(self.shape, name))
        if stated > 0.0:
            return stated
        self.assumed_fields.append(name)
        return usual

    @property
    def tool_holder(self) -> ToolHolder:
        """Return the tool holder, as far as it is specified."""
        return parse_holder(self.shape.holder) or ToolHolder()

    def make_shank(self, usual: float) -> ToolHolder:
        """Return the specified shank, or the usual shank of the width ``usual``."""
        holder = self.tool_holder
        if holder.shank_width_mm:
            return holder
        self.assumed_fields.append("holder")
        return make_standard_shank(usual)

    @property
    def is_tip_in_quadrant(self) -> bool:
        """Return whether the tip is in one of the quadrants 1 to 4, not on an axis direction."""
        return 0 not in self.shape.direction

    @property
    def tip_position(self) -> FloatArray:
        """Return the tip position relative to the nose center, in nose radii.

        The position applies to the standard orientation of the drawing.
        """
        if self.shape.tip in {0, 9}:
            return np.zeros(2)
        return np.array([-1.0 if self.is_tip_in_quadrant else 0.0, -1.0])


def make_tool_outline(shape: ToolShape) -> ToolOutline:
    """Return the outline of a tool.

    Raises InsertCodeError for an invalid code, and PartError for an outline of the holder or of a form tool
    that crosses itself. Check the shape for these and other contradictions with ``core.part.shape_rules``
    first.
    """
    drawing = _OutlineDrawing(shape)
    _DRAW[shape.kind](drawing)
    if pieces := drawing.tool_holder.outline:
        drawing.body_outlines = []
    pose = _rotate_to_direction if shape.is_rotating else _mirror_to_quadrant
    placed = _as_drawn if shape.kind is ToolKind.FORM else pose
    return ToolOutline(
        tuple(placed(each, shape.direction) for each in drawing.cutting_outlines),
        (
            *(placed(each, shape.direction) for each in drawing.body_outlines),
            *(split_into_convex_pieces(pieces) if pieces else ()),
        ),
        shape.is_rotating and shape.direction[1] == 0,
        tuple(dict.fromkeys(drawing.assumed_fields)),
    )


def make_nose_circle(radius: float, tip: int) -> ToolOutline:
    """Return the nose circle as the outline of a tool without a specified shape.

    If ``radius`` is 0, a very small circle is used.
    """
    size = radius or MAX_NOSE_CHORD_ERROR_MM * 10.0
    z, r = TIP_DIRECTIONS[tip]
    return ToolOutline(
        (make_circle(size) - size * np.array([z, r], dtype=np.float64),), assumed_fields=("kind",)
    )


# --- poses: mirroring to the side of the tip ----------------------------------------------------------------


def _as_drawn(points: FloatArray, _direction: tuple[int, int]) -> FloatArray:
    return points


def _mirror_to_quadrant(points: FloatArray, direction: tuple[int, int]) -> FloatArray:
    """Return the points mirrored from quadrant 3 or 8 to the quadrant of ``direction``."""
    z, r = direction
    if r == 0:  # quadrants 7 and 5: the end points along the axis instead of to it
        return orient_counterclockwise(points[:, ::-1] * np.array([-z, 1.0]))
    return orient_counterclockwise(points * np.array([-z or 1.0, -r]))


def _rotate_to_direction(points: FloatArray, direction: tuple[int, int]) -> FloatArray:
    """Return the points of a round tool, rotated from quadrant 7 to ``direction``."""
    z, r = direction
    if z == 0:
        return orient_counterclockwise(points[:, ::-1] * np.array([1.0, -r]))
    return orient_counterclockwise(points * np.array([-z, 1.0]))


# --- turning and boring -------------------------------------------------------------------------------------


def _insert(drawing: _OutlineDrawing, usual_circle: float) -> CuttingInsert:
    shape = drawing.shape
    if not shape.insert.strip():
        drawing.assumed_fields.append("insert")
        return make_insert("C", usual_circle, shape.nose_radius or DEFAULT_NOSE_RADIUS_MM)
    insert = decode_insert_code(shape.insert)
    if not insert.corner_angles:
        return insert
    return make_insert(insert.shape, insert.inscribed_circle, shape.nose_radius or insert.nose_radius)


def _edge_heading(drawing: _OutlineDrawing, insert: CuttingInsert, usual: Mapping[str, float]) -> float:
    """Return the direction of the insert's end cutting edge from the tip, in degrees from +z to +r."""
    shape, holder, point = drawing.shape, drawing.tool_holder, insert.point_angle
    entry = shape.entry or holder.entering_angle_deg
    if not entry and (not drawing.is_tip_in_quadrant or shape.hand is ToolHand.NEUTRAL):
        return 90.0 - point / 2.0
    if holder.is_angle_for_facing and not shape.entry and not shape.internal:
        return entry - 90.0
    return 180.0 - (entry or usual[insert.shape]) - point


def _seat_insert(
    drawing: _OutlineDrawing, insert: CuttingInsert, usual: Mapping[str, float]
) -> tuple[FloatArray, FloatArray]:
    """Return the outlines of the insert and of its seated part, relative to the control point.

    The seated part is the insert without the overhang at its edges.
    """
    radius = insert.nose_radius
    seat = 1.0 - 2.0 * min(1.0, _INSERT_OVERHANG_FRACTION * insert.inscribed_circle) / insert.inscribed_circle
    if not insert.corner_angles:
        nose = make_circle(radius)
        return nose - drawing.tip_position * radius, nose * seat - drawing.tip_position * radius
    sharp = make_polygon_from_edges(
        insert.corner_angles, insert.edge_lengths, _edge_heading(drawing, insert, usual)
    )
    radius = min(radius, 0.99 * find_max_corner_radius(sharp))
    shift = -radius * drawing.tip_position - (find_nose_center(sharp, radius) if radius else sharp[0])
    chords = [MAX_NOSE_CHORD_ERROR_MM] + [MAX_BODY_CHORD_ERROR_MM] * (len(sharp) - 1)
    middle = sharp.mean(axis=0)
    nosed = round_corners(sharp, [radius] * len(sharp), chords)
    return nosed + shift, middle + (
        round_corners(sharp, [radius] * len(sharp), [MAX_BODY_CHORD_ERROR_MM] * len(sharp)) - middle
    ) * seat + shift


def _turning(drawing: _OutlineDrawing) -> None:
    insert = _insert(drawing, 12.7)
    cutting, seat = _seat_insert(drawing, insert, ENTERING_ANGLES)
    drawing.cutting_outlines.append(cutting)
    across = insert.inscribed_circle
    head = max(2.5 * across, 2.0 * max(insert.edge_lengths, default=across))
    holder = drawing.make_shank(next(wide for least, wide in _SHANKS if across >= least))
    centred = not drawing.is_tip_in_quadrant or drawing.shape.hand is ToolHand.NEUTRAL
    far = holder.shank_width_mm / 2.0 if centred else holder.reach_mm
    _add_shank(drawing, seat, (far - holder.shank_width_mm, far), head)


_SHANKS = ((18.0, 32.0), (15.0, 25.0), (12.0, 20.0), (9.0, 16.0), (0.0, 12.0))  # inscribed circle → width, mm


def _add_shank(drawing: _OutlineDrawing, seat: FloatArray, side: tuple[float, float], head: float) -> None:
    """Add the holder's head between insert seat and shank, and the shank up to the stick-out length."""
    drawing.body_outlines.append(find_convex_hull(np.concatenate([seat, [(side[0], head), (side[1], head)]])))
    end = drawing.shape.stick_out or head + 3.0 * (side[1] - side[0])
    if end > head:
        drawing.body_outlines.append(make_rectangle(side, (head, end)))


def _boring(drawing: _OutlineDrawing) -> None:
    shape = drawing.shape
    bar = shape.diameter or drawing.tool_holder.bar_diameter_mm
    insert = _insert(drawing, next(circle for least, circle in _BAR_INSERTS if bar >= least))
    cutting, seat = _seat_insert(drawing, insert, BORING_ENTERING_ANGLES)
    drawing.cutting_outlines.append(cutting)
    if not bar:
        bar = next(wide for least, wide in _INSERT_BARS if insert.inscribed_circle >= least)
        drawing.assumed_fields.append("diameter")
    axis = float(np.interp(bar, *_BARS)) if bar < _BARS[0][-1] else 0.7 * bar
    _add_bar(drawing, seat, bar, axis, min(insert.inscribed_circle, bar) / 2.0)


_BAR_INSERTS = ((26.0, 12.7), (17.0, 9.525), (0.0, 6.35))  # bar → inscribed circle, mm
_INSERT_BARS = ((12.0, 32.0), (9.0, 20.0), (6.0, 12.0), (0.0, 8.0))  # inscribed circle → bar, mm


def _add_bar(drawing: _OutlineDrawing, seat: FloatArray, bar: float, axis: float, head: float) -> None:
    """Add a boring bar toward +z, with its axis at the distance ``axis`` from the tip.

    For back boring, z is mirrored.
    """
    back = -1.0 if drawing.shape.direction[0] > 0 else 1.0
    away = np.array([back, 1.0])
    low, high = axis - bar / 2.0, axis + bar / 2.0
    start = min(head, float((seat * away)[:, 0].max()))
    end = drawing.get_dimension("stick_out", 4.0 * bar)
    drawing.body_outlines.append(
        find_convex_hull(np.concatenate([seat * away, [(start, low), (start, high)]])) * away
    )
    if end > start:
        drawing.body_outlines.append(make_rectangle((start, end), (low, high)) * away)
    if drawing.shape.stick_out:
        drawing.body_outlines.append(make_rectangle((end, end + 2.0 * bar), (axis - bar, axis + bar)) * away)


# --- grooving, parting, threading: edge, blade, then shank or bar -------------------------------------------


def _grooving(drawing: _OutlineDrawing) -> None:
    shape = drawing.shape
    width = drawing.get_dimension("width", 3.0)
    nose = min(shape.nose_radius, 0.49 * width)
    depth = shape.length or (0.0 if shape.internal else shape.stick_out) or _usual_depth(shape, width)
    high = max(min(depth, max(1.5 * width, 2.0)), nose + MAX_NOSE_CHORD_ERROR_MM)
    left = _left_edge_end(drawing, width, nose)
    sharp = make_rectangle((left, left + width), (0.0, high)) - np.array(
        [0.0, nose * (1.0 + drawing.tip_position[1])]
    )
    drawing.cutting_outlines.append(
        round_corners(sharp, [nose, nose, 0.0, 0.0], [MAX_NOSE_CHORD_ERROR_MM] * 4)
    )
    thin = (1.0 - _BLADE) / 2.0 * width
    _blade_behind(drawing, (left + thin, left + width - thin), high, depth)


def _left_edge_end(drawing: _OutlineDrawing, width: float, nose: float) -> float:
    """Return the z of the left end of the cutting edge, relative to the control point.

    The control point is the corner of the edge, its middle or a nose center.
    """
    if not drawing.is_tip_in_quadrant:
        return -width / 2.0
    return -nose * (1.0 + float(drawing.tip_position[0]))


def _usual_depth(shape: ToolShape, width: float) -> float:
    return 1.5 * width if shape.internal else max(12.0 * width, 25.0)


def _blade_behind(drawing: _OutlineDrawing, side: tuple[float, float], high: float, depth: float) -> None:
    shape = drawing.shape
    if depth > high:
        drawing.body_outlines.append(make_rectangle(side, (high, depth)))
    if shape.internal:
        bar = drawing.get_dimension("diameter", 12.0)
        _add_bar(drawing, make_rectangle(side, (depth, depth + bar)), bar, depth + bar / 2.0, side[0])
    elif shape.length or shape.stick_out:
        wide = drawing.make_shank(20.0).shank_width_mm
        end = max(shape.stick_out, depth + 2.0 * wide)
        drawing.body_outlines.append(make_rectangle((side[0], side[0] + wide), (depth, end)))
    else:
        drawing.assumed_fields.append("length")


def _draw_threading(drawing: _OutlineDrawing) -> None:
    """Draw the V-shaped point of a threading tool, with a nose radius or a 1/8 pitch flat (ISO 68-1)."""
    shape = drawing.shape
    angle = math.radians(drawing.get_dimension("point", _POINTS[ToolKind.THREADING]))
    high = shape.length or max(shape.pitch, 3.0)
    flat = 0.0 if shape.nose_radius else shape.pitch / 8.0
    half = flat / 2.0 + high * math.tan(angle / 2.0)
    if flat:
        points = [(-flat / 2.0, 0.0), (flat / 2.0, 0.0), (half, high), (-half, high)]
        drawing.cutting_outlines.append(
            make_polygon(points) - np.array([drawing.tip_position[0] * flat / 2.0, 0.0])
        )
    else:
        sharp = make_polygon([(0.0, 0.0), (half, high), (-half, high)])
        nose = min(shape.nose_radius, 0.5 * find_max_corner_radius(sharp))
        shift = -nose * drawing.tip_position - (find_nose_center(sharp, nose) if nose else sharp[0])
        drawing.cutting_outlines.append(
            round_corners(sharp, [nose, 0.0, 0.0], [MAX_NOSE_CHORD_ERROR_MM] * 3) + shift
        )
    top = drawing.cutting_outlines[0][:, 1].max()
    left = float(drawing.cutting_outlines[0][:, 0].min())
    _blade_behind(drawing, (left, left + 2.0 * half), top, top + 2.0 * half)


# =


def _cylinder(start: float, end: float, radius: float) -> FloatArray:
    return make_rectangle((start, end), (-radius, radius))


def _mirror_half(upper: list[tuple[float, float]]) -> FloatArray:
    """Return the convex polygon whose upper half (r ≥ 0), ordered along z, is ``upper``."""
    return find_convex_hull(np.array([*upper, *((z, -r) for z, r in upper)], dtype=np.float64))


def _add_round_shank(drawing: _OutlineDrawing, length: float, diameter: float) -> None:
    """Add the shank of a round tool up to the tool clamp, and the clamp if its position is specified."""
    end = drawing.shape.stick_out or length + 2.0 * diameter
    if end > length:
        drawing.body_outlines.append(_cylinder(length, end, diameter / 2.0))
    if drawing.shape.stick_out:
        drawing.body_outlines.append(_cylinder(end, end + 2.0 * diameter + 10.0, diameter / 2.0 + 5.0))


def _drill(drawing: _OutlineDrawing) -> None:
    diameter = drawing.get_dimension("diameter", 6.0)
    radius = diameter / 2.0
    length = drawing.get_dimension("length", 8.0 * diameter)
    cone = radius / math.tan(math.radians(drawing.get_dimension("point", _POINTS[ToolKind.DRILL]) / 2.0))
    length = max(length, cone)
    point = [(0.0, 0.0)] if cone > MAX_NOSE_CHORD_ERROR_MM else []  # a flat drill has no point
    drawing.cutting_outlines.append(
        _mirror_half([*point, (cone if point else 0.0, radius), (length, radius)])
    )
    _add_round_shank(drawing, length, diameter)


def _draw_center_drill(drawing: _OutlineDrawing) -> None:
    """Draw a center drill of DIN 333 form A: a pilot of 0.4 body diameters, a 120° point, then the cone.

    If the ``width`` of the shape is specified, it is the diameter of the pilot.
    """
    diameter = drawing.get_dimension("diameter", 6.0)
    pilot = drawing.shape.width or 0.4 * diameter
    tip = pilot / 2.0 / math.tan(math.radians(60.0))
    root = 1.2 * pilot
    angle = math.radians(drawing.get_dimension("point", _POINTS[ToolKind.CENTER_DRILL]) / 2.0)
    end = root + (diameter - pilot) / 2.0 / math.tan(angle)
    drawing.cutting_outlines.append(_mirror_half([(0.0, 0.0), (tip, pilot / 2.0), (root, pilot / 2.0)]))
    drawing.cutting_outlines.append(
        _mirror_half([(root, pilot / 2.0), (end, diameter / 2.0), (end + 0.5, diameter / 2.0)])
    )
    _add_round_shank(drawing, end + 0.5, diameter)


def _reamer(drawing: _OutlineDrawing) -> None:
    diameter = drawing.get_dimension("diameter", 6.0)
    length = drawing.get_dimension("length", 5.0 * diameter)
    lead = min(0.1 * diameter, 0.5)  # at 45°
    radius = diameter / 2.0
    drawing.cutting_outlines.append(_mirror_half([(0.0, radius - lead), (lead, radius), (length, radius)]))
    _add_round_shank(drawing, length, diameter)


def _draw_tap(drawing: _OutlineDrawing) -> None:
    """Draw a tap with a chamfer of three pitches that starts below the core diameter (ISO 68-1)."""
    diameter = drawing.get_dimension("diameter", 6.0)
    pitch = drawing.get_dimension("pitch", diameter / 6.0)
    length = drawing.get_dimension("length", 2.5 * diameter + _TAP_LEAD * pitch)
    end = max(diameter - 1.2 * pitch, 0.5 * diameter) / 2.0
    lead = min(_TAP_LEAD * pitch, length)
    drawing.cutting_outlines.append(
        _mirror_half([(0.0, end), (lead, diameter / 2.0), (length, diameter / 2.0)])
    )
    _add_round_shank(drawing, length, diameter)


def _end_mill(drawing: _OutlineDrawing) -> None:
    diameter = drawing.get_dimension("diameter", 6.0)
    length = drawing.get_dimension("length", 3.0 * diameter)
    nose = min(drawing.shape.nose_radius, diameter / 2.0)
    radii = [nose, 0.0, 0.0, nose]
    body = _cylinder(0.0, length, diameter / 2.0)
    drawing.cutting_outlines.append(
        round_corners(body, radii, [MAX_NOSE_CHORD_ERROR_MM] * 4) if nose else body
    )
    _add_round_shank(drawing, length, diameter)


def _form(drawing: _OutlineDrawing) -> None:
    shape = drawing.shape
    if shape.profile:
        drawing.cutting_outlines.extend(split_into_convex_pieces(shape.profile))
    else:
        drawing.assumed_fields.append("profile")
        drawing.cutting_outlines.extend(make_nose_circle(shape.nose_radius, shape.tip).cutting_outlines)


_DRAW: Mapping[ToolKind, Callable[[_OutlineDrawing], None]] = {
    ToolKind.TURNING: _turning,
    ToolKind.BORING: _boring,
    ToolKind.GROOVING: _grooving,
    ToolKind.PARTING: _grooving,
    ToolKind.THREADING: _draw_threading,
    ToolKind.DRILL: _drill,
    ToolKind.CENTER_DRILL: _draw_center_drill,
    ToolKind.REAMER: _reamer,
    ToolKind.TAP: _draw_tap,
    ToolKind.END_MILL: _end_mill,
    ToolKind.FORM: _form,
}
