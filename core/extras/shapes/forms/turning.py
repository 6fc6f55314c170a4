"""Shapes for facing and turning.

Turning along a profile consists of roughing with G75 and a finishing pass along the contour.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from core.extras.shapes.common_fields import (
    check_feeds,
    check_rpm,
    make_diameter_reader,
    make_feed_field,
    make_rpm_field,
    make_surface_speed_field,
    make_tool_field,
    propose_bar_diameter,
)
from core.extras.shapes.contour import (
    POINT_TOLERANCE,
    ContourPoint,
    find_contour_errors,
    make_outline,
    make_point_label,
    resolve_contour_points,
)
from core.extras.shapes.cutting_data import (
    Operation,
    find_max_cutting_depth,
    propose_facing_depth,
    propose_finish_allowance,
    propose_roughing_depth,
)
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.lines.code_lines import CodeWriter, ContourTurning
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    number,
    text,
)
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import (
    Dimension,
    Sketch,
    make_cut_outline,
    make_part_outline,
    make_sketch,
    make_turned_outlines,
)

OUTSIDE, INSIDE = "OUTSIDE", "BORE"
_BESIDE = {False: 0.02, True: 0.5}  # by metric; clearance from the part at which a contour begins and ends


def _roughs(values: FieldValues) -> bool:
    return number(values, "ROUGH") > 0.0


LOWEST, HIGHEST = "LOWEST", "HIGHEST"
"""Names of the smallest and largest diameters that the points of a contour turn.

They are not fields, and proposals use them.
"""


def _extent(rows: Sequence[ContourPoint]) -> FieldValues:
    """Return the smallest and the largest turned diameter of a contour, as LOWEST and HIGHEST.

    Moves along X only are ignored. The result is empty if no other move exists, or if a move leads toward
    Z+, so that roughing along Z cannot cut the contour.
    """
    there = resolve_contour_points(rows)
    turned = [r for a, b in pairwise(there) if abs(a[0] - b[0]) > POINT_TOLERANCE for r in (a[1], b[1])]
    if not turned or any(b[0] > a[0] + POINT_TOLERANCE for a, b in pairwise(there)):
        return {}
    return {LOWEST: 2.0 * min(turned), HIGHEST: 2.0 * max(turned)}


def _stock_and_end(values: FieldValues) -> tuple[float, float]:
    """Return the diameter of the stock and the diameter of the deepest cut.

    If the bore (inside) or the smallest diameter (outside) is unknown, both are the largest diameter.
    """
    low = number(values, LOWEST) or number(values, "SMALL")
    high = max(number(values, each) for each in (HIGHEST, "LARGE", "DIAM"))
    if text(values, "SIDE") == INSIDE or "DIAM" in values:
        return number(values, "HOLE") or high, high
    if not {LOWEST, "SMALL"} & values.keys():
        return high, high
    return max(number(values, "FROM"), high), low


def _depth(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose a roughing depth, or 0 if two finishing passes are enough to remove the stock."""
    stock, end = _stock_and_end(values)
    depth = propose_roughing_depth(settings, number(values, "T"), max(stock, end), is_inside=end > stock)
    return (
        depth if abs(stock - end) / 4.0 > propose_finish_allowance(settings, depth) + POINT_TOLERANCE else 0.0
    )


def _leave(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return propose_finish_allowance(setting, number(values, "ROUGH"))


ROUGHING_DEPTH_FIELD = ShapeField(
    "ROUGH", "ROUGHING DEPTH OF CUT", FieldKind.LENGTH, _depth, allows_zero=True
)
ALLOWANCE_FIELD = ShapeField(
    "LEAVE", "FINISHING ALLOWANCE", FieldKind.LENGTH, _leave, allows_zero=True, applies_to=_roughs
)
Z_ALLOWANCE_FIELD = ShapeField(
    "ZLEAVE", "ALLOWANCE IN Z (0: SAME AS X)", FieldKind.LENGTH, 0.0, allows_zero=True, applies_to=_roughs
)
ROUGHING_FEED_FIELD = make_feed_field(Operation.TURN, "RFEED", "ROUGHING FEED", only=_roughs)
COMPENSATION_FIELD = ShapeField(
    "COMP", "NOSE COMPENSATION: D NUMBER", FieldKind.OFFSET, 0.0, allows_zero=True, maximum=32
)


def _next_label(_values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return float(setting.free_subroutine_number)


LABEL_FIELD = ShapeField(
    "LABEL", "CONTOUR NUMBER", FieldKind.COUNT, _next_label, maximum=9999, applies_to=_roughs
)
"""Field for the number of a contour that CYCLE95 finds by its labels."""


def write_spindle_start(
    filled_shape: ShapeInstance, settings: ProgramSettings, code: CodeWriter, x: float, z: float | None
) -> None:
    """Write the tool call, the spindle start and the approach.

    If a surface speed is specified, constant surface speed is turned on as well.
    """
    code.cutting_edge = filled_shape.get_number("COMP") or 1.0
    code.write_tool_start(filled_shape.get_number("T"), filled_shape.get_number("RPM"), x, z)
    if filled_shape.get_number("SURF"):
        code.write_surface_speed(
            filled_shape.get_number("SURF"), min(settings.shop.max_rpm, filled_shape.get_number("RPM"))
        )


def write_spindle_end(filled_shape: ShapeInstance, code: CodeWriter) -> None:
    """Write the retract to the tool change position and the switch back to constant rpm."""
    code.write_retract()
    if filled_shape.get_number("SURF"):
        code.write_constant_rpm()


# --- Turning a contour


def write_contour(
    filled_shape: ShapeInstance,
    settings: ProgramSettings,
    code: CodeWriter,
    rows: Sequence[ContourPoint],
    *,
    is_inside: bool,
) -> None:
    """Write all lines of a contour shape: tool call, spindle start, contour and retract.

    If a roughing depth is specified, roughing passes precede the contour.
    """
    there = resolve_contour_points(rows)
    clear_radius = _calculate_clear_radius(filled_shape, settings, there, is_inside=is_inside)
    rough, comp = filled_shape.get_number("ROUGH"), filled_shape.get_number("COMP")
    write_spindle_start(
        filled_shape, settings, code, clear_radius if rough else there[0][1], there[0][0] + settings.near
    )
    code.write_contour_turning(
        ContourTurning(
            rows,
            clear_radius,
            is_inside,
            filled_shape.get_number("FEED"),
            rough,
            filled_shape.get_number("LEAVE"),
            filled_shape.get_number("RFEED"),
            comp,
            filled_shape.get_number("LABEL"),
            filled_shape.get_number("ZLEAVE"),
        )
    )
    write_spindle_end(filled_shape, code)
    code.cancel_compensation(comp)


def _calculate_clear_radius(
    filled_shape: ShapeInstance,
    settings: ProgramSettings,
    there: Sequence[tuple[float, float]],
    *,
    is_inside: bool,
) -> float:
    """Return the radius, clear of the stock, at which roughing starts and the contour ends."""
    free, radii = _BESIDE[settings.metric], [r for _, r in there]
    if filled_shape.get_number("ZLEAVE"):
        free += filled_shape.get_number("LEAVE")  # the shifted contour also ends below this radius
    if is_inside:
        hole = filled_shape.get_number("HOLE") / 2.0 or min(radii)
        return max(0.0, min(hole, *radii) - free)
    stock = filled_shape.get_number("FROM") / 2.0
    return max(stock, *radii) + free


def _contour_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    inside = filled.get_text("SIDE") == INSIDE
    yield from find_contour_errors(filled.contour_points)
    yield from check_compensation(filled, setting)
    yield from check_cutting_data(filled, setting)
    there = resolve_contour_points(filled.contour_points)
    if filled.get_number("ROUGH"):
        for at, (before, here) in enumerate(pairwise(there), 2):
            if here[0] > before[0] + 1e-9:
                text_ = Message(
                    "Point {position} runs back toward the face, but roughing can move only toward "
                    "the chuck along Z.",
                    position=at,
                )
                yield FieldError(make_point_label(at), text_)
                break
        yield from _check_first_move(there, is_inside=inside)
        yield from _check_z_allowance(filled, setting, is_inside=inside)
    if (
        not inside
        and filled.get_number("FROM")
        and max((r for _, r in there), default=0.0) > filled.get_number("FROM") / 2 + 1e-9
    ):
        at = max(range(len(there)), key=lambda n: there[n][1])
        words = Message(
            "Point {position} is outside the stock diameter of {number}: enter a smaller X.",
            position=at + 1,
            number=f"{filled.get_number('FROM'):g}",
        )
        yield FieldError(make_point_label(at + 1), words)


def _check_z_allowance(
    filled: ShapeInstance, settings: ProgramSettings, *, is_inside: bool
) -> Iterator[FieldError]:
    """Yield an error if roughing cannot leave the separate allowance in Z.

    Roughing follows the shifted contour. If the contour falls toward the chuck, the shifted contour would
    cut into the part.
    """
    leave, side = filled.get_number("ZLEAVE"), -1.0 if is_inside else 1.0
    if leave > settings.near:
        yield FieldError(
            "ZLEAVE",
            Message(
                "An allowance of {leave} in Z is more than the approach distance of {near}: "
                "enter a smaller allowance.",
                leave=f"{leave:g}",
                near=f"{settings.near:g}",
            ),
        )
    radii = [side * radius for _, radius in make_outline(filled.contour_points)]
    if leave and any(b < a - POINT_TOLERANCE for a, b in pairwise(radii)):
        yield FieldError(
            "ZLEAVE",
            "A separate allowance in Z is not possible if the contour cuts deeper toward the chuck: enter 0.",
        )


def _check_first_move(there: Sequence[tuple[float, float]], *, is_inside: bool) -> Iterator[FieldError]:
    """Yield an error if the contour cuts deeper along X and toward Z- directly after its first point.

    The return moves of the roughing passes would cross such a contour.
    """
    side = -1.0 if is_inside else 1.0
    if (
        len(there) > 1
        and there[1][0] < there[0][0] - POINT_TOLERANCE
        and side * (there[0][1] - there[1][1]) > POINT_TOLERANCE
    ):
        yield FieldError(
            make_point_label(1),
            "The contour cuts deeper directly after its first point, and roughing cannot "
            "return past that point: add a point before the first point, at the same Z and "
            "at the lowest X.",
        )


def check_compensation(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield an error if nose compensation (G41) is used in a subroutine, where it has no effect."""
    if filled_shape.get_number("COMP") and settings.is_subroutine and settings.dialect is Dialect.OMNITURN:
        yield FieldError(
            "COMP",
            "G41 does not work in a subroutine, and a bar feed loop runs this shape in a "
            "subroutine: enter 0.",
        )


def check_cutting_data(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield errors for speeds, feeds and depths that the machine or the insert does not permit."""
    yield from check_rpm(filled_shape, settings)
    yield from check_feeds(filled_shape, settings, "FEED", "RFEED")
    rough, leave = filled_shape.get_number("ROUGH"), filled_shape.get_number("LEAVE")
    if rough and leave >= rough:
        yield FieldError(
            "LEAVE",
            Message(
                "A finishing allowance of {leave} is more than a pass of {rough}: enter a smaller allowance.",
                leave=f"{leave:g}",
                rough=f"{rough:g}",
            ),
        )
    stock, end = _stock_and_end(
        {**filled_shape.shape.calculate_extent(filled_shape.contour_points), **filled_shape.field_values}
    )
    if filled_shape.shape.find_field("ROUGH") is not None:
        yield from check_pass_depth(filled_shape, settings, "ROUGH", rough or abs(stock - end) / 2.0)


def check_pass_depth(
    filled_shape: ShapeInstance, settings: ProgramSettings, word: str, depth: float
) -> Iterator[FieldError]:
    """Yield an error if a pass is deeper than the insert permits."""
    most = find_max_cutting_depth(settings, filled_shape.get_number("T"))
    if depth > most + POINT_TOLERANCE:
        yield FieldError(
            word,
            Message(
                "A pass would be {depth} deep, but the insert of T{number} allows a depth of "
                "only {maximum}: enter a smaller depth of cut.",
                depth=f"{depth:.4g}",
                number=f"{filled_shape.get_number('T'):.0f}",
                maximum=f"{most:.4g}",
            ),
        )


def _turn(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    write_contour(filled, setting, code, filled.contour_points, is_inside=filled.get_text("SIDE") == INSIDE)


def _turn_sketch(filled: ShapeInstance) -> Sketch:
    rows = [row for row in filled.contour_points if not row.empty]
    drawn = make_outline(rows)
    if len(drawn) < 2:
        return make_sketch(make_part_outline((0, 0), (0, 5), (-12, 5), (-12, 0)))
    across = max(filled.get_number("FROM"), 2.0 * max(r for _, r in drawn))
    dims = tuple(Dimension(make_point_label(k), at) for k, at in enumerate(resolve_contour_points(rows), 1))
    if filled.get_text("SIDE") == INSIDE:
        back = min(z for z, _ in drawn)
        wall = 1.3 * max(r for _, r in drawn)
        solid = make_part_outline(
            (drawn[0][0], wall), *drawn, (back, 0.0), (1.3 * back, 0.0), (1.3 * back, wall)
        )
        return make_sketch(solid, make_cut_outline(*drawn), dimensions=dims)
    return make_sketch(*make_turned_outlines(drawn, across), dimensions=dims)


def _outside(values: FieldValues) -> bool:
    return text(values, "SIDE") != INSIDE


TURNING_SHAPE = Shape(
    "TURN",
    "a profile of points, corners and arcs, with or without roughing",
    (
        make_tool_field(ToolKind.TURNING, ToolKind.BORING),
        ShapeField("SIDE", "SIDE", FieldKind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        ShapeField(
            "FROM",
            "STOCK DIAMETER",
            FieldKind.DIAMETER,
            propose_bar_diameter,
            allows_zero=True,
            applies_to=_outside,
        ),
        ShapeField("HOLE", "HOLE DIAMETER", FieldKind.DIAMETER, None, applies_to=lambda v: not _outside(v)),
        ROUGHING_DEPTH_FIELD,
        ALLOWANCE_FIELD,
        Z_ALLOWANCE_FIELD,
        ROUGHING_FEED_FIELD,
        make_feed_field(Operation.FINISH),
        make_rpm_field(Operation.TURN, make_diameter_reader("FROM")),
        make_surface_speed_field(),
        COMPENSATION_FIELD,
    ),
    _turn,
    _turn_sketch,
    _contour_checks,
    has_point_table=True,
    calculate_extent=_extent,
)


# --- Face


def _face(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    at, stock, deep = filled.get_number("AT"), filled.get_number("STOCK"), filled.get_number("DEEP")
    start, end = filled.get_number("FROM") / 2.0 + _BESIDE[setting.metric], filled.get_number("TO") / 2.0
    passes = max(1, math.ceil(stock / deep - 1e-9)) if deep else 1
    write_spindle_start(filled, setting, code, start, at + stock + setting.near)
    for k in range(1, passes + 1):
        z = at + stock * (passes - k) / passes
        if k > 1:
            code.write_rapid(z=z + stock / passes + _BESIDE[setting.metric])
            code.write_rapid(x=start)
        code.write_rapid(z=z)
        code.write_cut(x=end, feed=filled.get_number("FEED"))
    write_spindle_end(filled, code)


def _past_axis(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose an end diameter of minus twice the nose radius, so that facing leaves no center pip."""
    shape = settings.tool(number(values, "T"))
    nose = shape.nose_radius / settings.mm if shape is not None else 0.0
    return -math.ceil(2000.0 * (nose or 0.4 / settings.mm)) / 1000.0


def _facing(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return propose_facing_depth(setting, number(values, "T"), number(values, "FROM"))


def _face_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    yield from check_pass_depth(
        filled, setting, "DEEP", min(filled.get_number("DEEP"), filled.get_number("STOCK"))
    )
    if filled.get_number("TO") >= filled.get_number("FROM"):
        yield FieldError(
            "TO",
            Message(
                "Facing starts at diameter {number} and runs inward: end diameter {number2} must be less.",
                number=f"{filled.get_number('FROM'):g}",
                number2=f"{filled.get_number('TO'):g}",
            ),
        )
    yield from check_rpm(filled, setting)
    yield from check_feeds(filled, setting, "FEED")


def _face_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline((0, 0), (0, 10), (-22, 10), (-22, 0))
    return make_sketch(
        solid,
        make_cut_outline((0, 10), (0, 1)),
        make_cut_outline((3, 10), (3, 0), (0, 0)),
        dimensions=(
            Dimension("FROM", (-16, -10), (-16, 10)),
            Dimension("TO", (0, 1), None),
            Dimension("STOCK", (0, 10), (3, 10), 4),
            Dimension("AT", (0, 5)),
        ),
    )


FACE = Shape(
    "FACE",
    "the end of the part faced square, in one or more passes",
    (
        make_tool_field(ToolKind.TURNING),
        ShapeField("FROM", "START DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("TO", "END DIAMETER", FieldKind.COORDINATE, _past_axis),
        ShapeField("AT", "FACE AT Z", FieldKind.COORDINATE, 0.0),
        ShapeField("STOCK", "STOCK ON THE FACE", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField(
            "DEEP", "DEPTH PER PASS", FieldKind.LENGTH, _facing, applies_to=lambda v: number(v, "STOCK") > 0
        ),
        make_feed_field(Operation.FINISH),
        make_rpm_field(Operation.TURN, make_diameter_reader("FROM")),
        make_surface_speed_field(),
    ),
    _face,
    _face_sketch,
    _face_checks,
)
