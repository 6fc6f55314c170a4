"""Program for a profile, as a sequence of shapes: program head, face, turning (G75) and grooves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_placement import ContourProfile, ContourSide
from core.extras.drawings.turning_contour import (
    OmittedGroove,
    TurningContour,
    add_nose_fillets,
    calculate_tool_angle_limits,
    join_elements,
    make_turning_contour,
)
from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.editor_shape import Shape, ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import FieldError, FieldValue, FieldValues, ProgramSettings
from core.extras.shapes.shape_pieces import find_active_settings
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT
from core.geometry.lines_and_arcs import Arc, Element, Line, find_intersections
from core.language.source import Dialect
from core.message import Message
from core.part.insert_codes import decode_insert_code
from core.part.tool_shape import ToolShape
from core.tool_edges import TIP_DIRECTIONS

_SAME = 1e-3  # mm
_ROOM = 0.05  # mm, least finishing allowance at the deepest point of a falling contour


@dataclass(frozen=True, slots=True)
class UncutRange:
    """A range along Z in mm that no tool of the program cuts, with the reason."""

    back_z_mm: float
    front_z_mm: float
    reason: str


class NoseOffset(NamedTuple):
    """Offset that G41 and G42 use in the program, in mm with X as a radius.

    ``offset_number`` is the number of a secondary offset, or of a cutting edge if ``quadrant`` is not 0.
    """

    offset_number: int
    x: float
    z: float
    nose_radius: float
    quadrant: int = 0


@dataclass(frozen=True, slots=True)
class ProfileProgram:
    """Program for a profile: its shapes, its lines, and the ranges that remain uncut.

    Each shape is stored with the settings that are active before it.
    """

    shapes: tuple[tuple[ShapeInstance, ProgramSettings], ...]
    lines: tuple[str, ...]
    uncut_ranges: tuple[UncutRange, ...]
    contour: TurningContour
    errors: tuple[FieldError, ...] = ()
    nose_offset: NoseOffset | None = None
    nose_radius_mm: float = 0.0  # mm, nose radius of the turning tool
    tool_number: float = 0.0


def make_profile_program(
    profile: ContourProfile, entered_values: FieldValues, lines: Sequence[str], settings: ProgramSettings
) -> ProfileProgram:
    """Make the shapes for a profile, to be appended to ``lines``.

    If ``lines`` is empty, the program begins with a head. ``entered_values`` contains fields of HEAD, FACE,
    TURN and GROOVE by name:

    - UNIT, BAR and MATERIAL for the head, and T and BLADE for the tools
    - STOCK, FROM, HOLE, ROUGH, LEAVE, FEED, RFEED, RPM, SURF, COMP and WIDE
    - PAST, the distance by which the contour extends past the part, in the program's unit; without it,
      the nose radius determines the distance

    Raises DrawingError if the tool has a nose radius but no tip quadrant, if nothing remains to be turned,
    or if a shoulder is too steep for the tool.
    """
    writer = _Writer(list(lines), settings)
    if not lines:
        words = {key: entered_values[key] for key in ("UNIT", "MATERIAL", "BAR") if key in entered_values}
        writer.add("N", words)
    tool = settings.tool(float(entered_values.get("T", 0) or 0))
    _check_tip(tool, _number(entered_values, "T"), writer.current_settings)
    outside = profile.side is ContourSide.OUTSIDE
    mm = writer.current_settings.mm
    contour = make_turning_contour(profile, calculate_tool_angle_limits(tool, profile.side))
    if not outside:
        contour = replace(
            contour,
            elements=tuple(_cut_at_radius(contour.elements, _number(entered_values, "HOLE") * mm / 2)),
        )
    if _number(entered_values, "COMP"):
        reached = add_nose_fillets(contour.elements, find_nose_radius(tool), is_inside=not outside)
        contour = replace(contour, elements=reached)
    past = calculate_contour_extension(tool)
    if "PAST" in entered_values:
        past = _number(entered_values, "PAST") * mm
    beyond = [*_add_face_approach(contour.elements, outside=outside)]
    contour = replace(contour, elements=tuple(join_elements(_past(beyond, past, find_nose_radius(tool)))))
    if outside and _number(entered_values, "STOCK"):
        writer.add("F", _face(profile, entered_values, writer.current_settings))
    rows = tuple(make_contour_points(contour.elements, mm))
    writer.add("T", _turn(profile, contour, entered_values, writer.current_settings), rows)
    left = [UncutRange(*each) for each in contour.unreachable_ranges]
    for groove in contour.grooves:
        over = _find_blade_clearance(contour.elements, groove, 1.0 if outside else -1.0)
        left += writer.add_groove(
            _groove(groove, entered_values, writer.current_settings, over, outside=outside), groove
        )
    shapes, made = tuple(writer.shapes), tuple(writer.lines[len(lines) :])
    nose = make_nose_offset(tool, int(_number(entered_values, "COMP")), settings.dialect)
    return ProfileProgram(
        shapes,
        made,
        tuple(left),
        contour,
        tuple(writer.refusals),
        nose,
        find_nose_radius(tool),
        _number(entered_values, "T"),
    )


class _Writer:
    """Writer of consecutive shapes, each with the settings that earlier lines leave active."""

    def __init__(self, lines: list[str], settings: ProgramSettings) -> None:
        self.lines, self.shapes = lines, list[tuple[ShapeInstance, ProgramSettings]]()
        self.refusals: list[FieldError] = []
        self._new = settings

    @property
    def current_settings(self) -> ProgramSettings:
        """Return the settings that are active after the lines written so far."""
        return find_active_settings(self.lines, len(self.lines), self._new.shop, self._new)

    def _shape(self, key: str) -> Shape:
        return SHAPES_BY_DIALECT[self._new.dialect][key]

    def add(self, key: str, typed: FieldValues, rows: tuple[ContourPoint, ...] = ()) -> None:
        """Add the shape with this key, filled with the typed values, unless it has errors."""
        now = self.current_settings
        one = make_shape_instance(self._shape(key), typed, now, rows)
        refused = one.find_errors(now)
        self.refusals += refused
        if not refused:
            self._take(one, now)

    def _take(self, one: ShapeInstance, now: ProgramSettings) -> None:
        self.shapes.append((one, now))
        self.lines += one.make_lines(now)

    def add_groove(self, typed: FieldValues | str, groove: OmittedGroove) -> Iterator[UncutRange]:
        """Add a groove, or yield its range with the reason if it cannot be cut."""
        span = groove.back_edge[1], groove.front_edge[1]
        if isinstance(typed, str):
            yield UncutRange(*span, typed)
            return
        now = self.current_settings
        one = make_shape_instance(self._shape("G"), typed, now)
        refused = one.find_errors(now)
        if refused:
            yield UncutRange(*span, refused[0].message)
        else:
            self._take(one, now)


def _number(typed: FieldValues, word: str) -> float:
    value = typed.get(word, 0.0)
    return 0.0 if isinstance(value, str) else float(value)


def _given(typed: FieldValues, *words: str) -> dict[str, FieldValue]:
    return {word: typed[word] for word in words if word in typed}


def _face(profile: ContourProfile, typed: FieldValues, setting: ProgramSettings) -> dict[str, FieldValue]:
    return {
        **_given(typed, "T", "FROM", "STOCK", "FEED", "RPM", "SURF"),
        "AT": round(profile.front_z_mm / setting.mm, 5),
    }


def _turn(
    profile: ContourProfile, contour: TurningContour, typed: FieldValues, setting: ProgramSettings
) -> dict[str, FieldValue]:
    words = _given(typed, "T", "FROM", "HOLE", "ROUGH", "LEAVE", "FEED", "RFEED", "RPM", "SURF", "COMP")
    if "LEAVE" not in words:
        words |= _calculate_allowance(contour, typed, setting)
    return {**words, "SIDE": str(profile.side)}


def _calculate_allowance(
    contour: TurningContour, typed: FieldValues, settings: ProgramSettings
) -> dict[str, FieldValue]:
    """Return the finishing allowance that the nose radius requires.

    The result is empty unless it is larger than the usual allowance. G75 has no nose compensation. Where
    the contour falls toward the axis at the angle a, a nose of radius R cuts R (1 + sin a - cos a) too
    deep.
    """
    if settings.dialect is Dialect.SINUMERIK:
        return {}  # CYCLE95 compensates the nose radius
    tool, a = settings.tool(_number(typed, "T")), contour.steepest_angle_rad
    deep = find_nose_radius(tool) * (1.0 + math.sin(a) - math.cos(a)) if a > 0.0 else 0.0
    usual = 0.25 if settings.metric else 0.01
    need = (deep + _ROOM) / settings.mm
    if need <= usual:
        return {}
    step = 100.0 if settings.metric else 1000.0
    return {"LEAVE": math.ceil(need * step) / step}


def _check_tip(tool: ToolShape | None, number: float, settings: ProgramSettings) -> None:
    """Raise DrawingError if the tool has a nose radius but no tip quadrant.

    Otherwise the nose would be assumed to be centered on the control point, and the part would be too small
    by the nose radius.
    """
    if tool is not None and not tool.tip and (nose := find_nose_radius(tool)):
        raise DrawingError(
            Message(
                "T{number} has a nose radius of {nose}, but its tool data has no tip quadrant: "
                "enter the tip quadrant on the SHAPE page of the tool (F8, F8).",
                number=f"{number:.0f}",
                nose=f"{nose / settings.mm:.4g}",
            ),
            "no-tip-quadrant",
        )


def find_nose_radius(tool: ToolShape | None) -> float:
    """Return the nose radius in mm from the tool data, or from the insert code if not specified."""
    if tool is None or tool.nose_radius or not tool.insert:
        return tool.nose_radius if tool is not None else 0.0
    return decode_insert_code(tool.insert).nose_radius


def make_nose_offset(tool: ToolShape | None, number: int, dialect: Dialect) -> NoseOffset | None:
    """Return the offset with which a touched-off tip cuts to size.

    Return None without nose compensation or without a tool. On a SINUMERIK control, the cutting edge also
    contains the nose radius and the tip quadrant.
    """
    if not number or tool is None:
        return None
    if dialect is Dialect.SINUMERIK:
        return NoseOffset(number, 0.0, 0.0, find_nose_radius(tool), tool.tip)
    along, across = TIP_DIRECTIONS[tool.tip]
    r = find_nose_radius(tool)
    return NoseOffset(number, across * r, along * r, r)


def calculate_contour_extension(tool: ToolShape | None) -> float:
    """Return the distance in mm by which the contour must extend past the part.

    The extension is necessary because the nose leaves a fillet at the end of the contour.
    """
    return math.ceil(10.0 * (find_nose_radius(tool) + _ROOM)) / 10.0


def _add_face_approach(elements: Sequence[Element], *, outside: bool) -> Iterator[Element]:
    """Yield the contour, preceded by a move along X if the contour starts into the material.

    The material is toward the axis for an outside contour, and away from the axis in a bore. Roughing
    rejects a contour that starts in this direction, because the return path would cross the contour.
    """
    side = 1.0 if outside else -1.0
    r, z = elements[0].start
    lowest = side * min(side * p[0] for each in elements for p in (each.start, each.end))
    if side * (r - elements[0].end[0]) > _SAME and not _upright(elements[0]):
        yield Line((lowest, z), (r, z))
    yield from elements


def _past(elements: Sequence[Element], distance: float, nose_radius: float) -> Iterator[Element]:
    """Yield the contour, extended along Z by ``distance`` unless it ends in a wall.

    After a slope of angle a, a tool with the nose radius R leaves the contour only after a further travel
    of R tan (a / 2). Nose compensation needs this travel.
    """
    yield from elements
    (r, z), (dr, dz) = elements[-1].end, elements[-1].end_direction
    fall = abs(math.atan2(dr, -dz))
    distance += (
        math.ceil(10.0 * nose_radius * math.tan(min(fall, 1.5) / 2.0)) / 10.0 if distance > _SAME else 0.0
    )
    if distance > _SAME and not _upright(elements[-1]):
        yield Line((r, z), (r, z - distance))


def _cut_at_radius(elements: Iterable[Element], r: float) -> Iterator[Element]:
    """Yield the sections of a bore wall where the bore is wider than the drilled hole."""
    for each in elements:
        if each.end[0] >= r - _SAME:
            yield each
            continue
        hole = Line((r, each.start[1] + 1e4), (r, each.end[1] - 1e4))
        meet = find_intersections(hole, each)
        if meet:
            yield each.cut_section(each.start, meet[0])
        return


# --- Rows of a contour


def make_contour_points(elements: Iterable[Element], mm_per_unit: float) -> Iterator[ContourPoint]:
    """Yield the rows of a contour's point table.

    ``mm_per_unit`` is the size of the program's length unit in mm.
    """
    first = True
    for each in elements:
        if first:
            yield _row(each.start, mm_per_unit, 0.0)
            first = False
        arc = 0.0
        if isinstance(each, Arc):
            arc = each.radius / mm_per_unit if each.clockwise else -each.radius / mm_per_unit
        yield _row(each.end, mm_per_unit, arc)


def _row(point: tuple[float, float], mm: float, arc: float) -> ContourPoint:
    return ContourPoint(round(2.0 * point[0] / mm, 5) + 0.0, round(point[1] / mm, 5) + 0.0, arc=round(arc, 5))


# --- Grooves


def _find_blade_clearance(elements: Iterable[Element], groove: OmittedGroove, side: float) -> float:
    """Return the radius in mm of an obstacle between the face and the groove, or 0 if there is none."""
    before = [
        p[0] for each in elements for p in (each.start, each.end) if p[1] > groove.front_edge[1] - _SAME
    ]
    widest = side * max((side * r for r in before), default=0.0)
    return widest if before and side * (widest - groove.front_edge[0]) > _SAME else 0.0


def _groove(
    groove: OmittedGroove, typed: FieldValues, settings: ProgramSettings, over: float, *, outside: bool
) -> dict[str, FieldValue] | str:
    """Return the fields of a groove shape, or the reason why the groove cannot be cut.

    If the walls are curved, the widest square groove between them is used.
    """
    mm, blade = settings.mm, _blade(typed, settings)
    if blade is None:
        number = _number(typed, "BLADE")
        return (
            Message(
                "the groove cannot be cut because the width of T{number} is not defined",
                number=f"{number:.0f}",
            )
            if number
            else ("the groove cannot be cut because no grooving tool is specified")
        )
    wide = blade * mm
    leaning = _leaning(groove, wide)
    box = leaning[:4] if leaning else _square(groove, wide, 1.0 if outside else -1.0)
    if box is None:
        return Message("the groove is narrower than the {wide} mm blade", wide=f"{wide:.3g}")
    front, back, bottom, edge = box
    found: dict[str, FieldValue] = {
        "T": _number(typed, "BLADE"),
        "SIDE": "FRONT" if outside else "BORE",
        "TOP": round(2.0 * groove.front_edge[0] / mm, 5),
        "BOTTOM": round(2.0 * bottom / mm, 5),
        "AT": round(-front / mm, 5) + 0.0,
        "WIDE": blade,
        "LONG": round((front - back) / mm, 5),
        "EDGE": round(edge / mm, 5),
        "OVER": round(2.0 * over / mm, 5),
    }
    if leaning:
        found |= {"FANGLE": round(leaning.face_z, 3), "CANGLE": round(leaning.chuck_z, 3)}
    return found


class _SlopedGroove(NamedTuple):
    """A groove with two straight sloped walls.

    The Z of both edges and the r of the bottom are in mm, and the slopes are in degrees.
    """

    front_z: float
    back_z: float
    bottom_radius: float
    edge_radius: float
    face_z: float
    chuck_z: float


def _leaning(groove: OmittedGroove, width: float) -> _SlopedGroove | None:
    """Return a groove with straight sloped walls, or None if the groove is of another kind.

    It is None if the walls are square or curved, or if the bottom is narrower than the blade.
    """
    if len(groove.elements) != 3 or not all(isinstance(each, Line) for each in groove.elements):
        return None
    down, bottom, up = groove.elements
    if not _flat(bottom) or bottom.length < width - _SAME or (_upright(down) and _upright(up)):
        return None
    angles = (
        math.degrees(math.atan2(abs(each.end[1] - each.start[1]), abs(each.end[0] - each.start[0])))
        for each in (down, up)
    )
    return _SlopedGroove(groove.front_edge[1], groove.back_edge[1], bottom.start[0], 0.0, *angles)


def _blade(typed: FieldValues, settings: ProgramSettings) -> float | None:
    """Return the width of the blade in the program's unit, or None if it is not specified."""
    if not _number(typed, "BLADE"):
        return None
    shape = settings.tool(_number(typed, "BLADE"))
    sheet = round(shape.width / settings.mm, 5) if shape is not None and shape.width else 0.0
    return _number(typed, "WIDE") or sheet or None


def _square(groove: OmittedGroove, width: float, side: float) -> tuple[float, float, float, float] | None:
    """Return the dimensions of a square groove: Z of both walls, r of the bottom, and edge chamfer.

    The result is None if the blade does not fit.
    """
    inner = list(groove.elements)
    edge = _chamfer(inner, side)
    if edge:
        inner = inner[1:-1]
    if _upright(inner[0]) and _upright(inner[-1]) and len(inner) == 3 and _flat(inner[1]):
        front, back = inner[1].start[1], inner[1].end[1]
        return (front, back, inner[1].start[0], edge) if front - back >= width - _SAME else None
    flats = [each for each in inner if _flat(each) and each.length >= width - _SAME]
    if flats:
        deepest = min(flats, key=lambda each: side * each.start[0])
        return deepest.start[1], deepest.end[1], deepest.start[0], 0.0
    return _one_plunge(groove, width, side)


def _chamfer(inner: Sequence[Element], side: float) -> float:
    """Return the size of equal 45-degree chamfers on both edges, or 0 if there are none."""
    sizes = []
    for each in (inner[0], inner[-1]):
        dr, dz = abs(each.end[0] - each.start[0]), abs(each.end[1] - each.start[1])
        sizes.append(dz if isinstance(each, Line) and abs(dr - dz) < _SAME else 0.0)
    falls = side * (inner[0].end[0] - inner[0].start[0]) < 0.0
    return sizes[0] if len(inner) >= 5 and falls and abs(sizes[0] - sizes[1]) < _SAME else 0.0


def _upright(each: Element) -> bool:
    return isinstance(each, Line) and abs(each.end[1] - each.start[1]) < _SAME


def _flat(each: Element) -> bool:
    return isinstance(each, Line) and abs(each.end[0] - each.start[0]) < _SAME


def _one_plunge(groove: OmittedGroove, width: float, side: float) -> tuple[float, float, float, float] | None:
    """Return a single plunge at the deepest point, or None if the blade does not fit.

    The plunge is as deep as the corners of the blade permit.
    """
    front, back = groove.front_edge[1], groove.back_edge[1]
    if front - back < width - _SAME:
        return None
    ends = [p for each in groove.elements for p in (each.start, each.end)]
    middle = min(ends, key=lambda p: side * p[0])[1]
    low = min(max(middle - width / 2.0, back), front - width)
    bottom = side * max(side * r for r in _radii(groove.elements, low, low + width))
    if side * (groove.front_edge[0] - bottom) < 0.05:
        return None
    return low + width, low, bottom, 0.0


def _radii(elements: Iterable[Element], low: float, high: float) -> Iterator[float]:
    """Yield the radii of a contour at both ends of a Z range and at the element ends within it."""
    for each in elements:
        walls = (Line((-1e5, z), (1e5, z)) for z in (low, high))
        for point in (p for wall in walls for p in find_intersections(wall, each)):
            yield point[0]
        for point in (each.start, each.end):
            if low - _SAME <= point[1] <= high + _SAME:
                yield point[0]


def find_max_diameter(profile: ContourProfile) -> float:
    """Return the largest diameter of a profile in mm."""
    return 2.0 * max(each.bounding_box[1] for each in profile.elements)
