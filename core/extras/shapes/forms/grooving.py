"""Groove shape, cut by plunging with a blade.

The walls are square or sloped, and the edges may be chamfered. A shape may contain several equally spaced
grooves.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.common_fields import (
    check_feeds,
    check_rpm,
    make_diameter_reader,
    make_feed_field,
    make_rpm_field,
    make_tool_field,
    propose_bar_diameter,
)
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.forms.bar_work import (
    BLADE_CLEARANCE,
    BLADE_CORNER_FIELD,
    BLADE_WIDTH_FIELD,
    FRONT,
    INSIDE,
    REAR,
    BladeWriter,
    check_blade,
    get_tool_side_sign,
)
from core.extras.shapes.forms.turning import write_spindle_end, write_spindle_start
from core.extras.shapes.lines.code_lines import CodeWriter, format_short_number, format_sinumerik_number
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValues,
    ProgramSettings,
    ShapeField,
    number,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch, make_tool_outline

_OVERLAP = 0.8  # distance between plunges as a fraction of the blade width


def _plunges(filled: ShapeInstance) -> int:
    over = filled.get_number("LONG") - filled.get_number("WIDE")
    return 1 + math.ceil(over / (_OVERLAP * filled.get_number("WIDE")) - 1e-9) if over > 1e-9 else 1


def _slants(filled_shape: ShapeInstance) -> tuple[float, float]:
    """Return the Z travel per unit of depth for the two walls: face side, then chuck side."""
    return math.tan(math.radians(filled_shape.get_number("FANGLE"))), math.tan(
        math.radians(filled_shape.get_number("CANGLE"))
    )


def _groove(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    free = (
        -BLADE_CLEARANCE[setting.metric]
        if filled.get_text("SIDE") == INSIDE
        else BLADE_CLEARANCE[setting.metric]
    )
    outer = filled.get_number("TOP") / 2.0 + free
    over = filled.get_number("OVER") / 2.0 + free if filled.get_number("OVER") else outer
    blade, chuck = BladeWriter(filled, code, over), -filled.get_number("AT") - filled.get_number("LONG")
    many, slanted = int(filled.get_number("COUNT")), any(_slants(filled))
    write_spindle_start(filled, setting, code, get_tool_side_sign(filled) * over, None)
    plain_ones = _plunges(filled) == 1 and not filled.get_number("EDGE") and not slanted and over == outer
    if many > 1 and plain_ones and code.supports_loops and not setting.is_subroutine:
        _loop(filled, code, outer, blade.calculate_z_at_chuck_corner(chuck))
    else:
        one = _slanted_groove if slanted else _one_groove
        for k in range(max(many, 1)):
            one(filled, blade, outer, chuck - k * filled.get_number("PITCH"), free)
    if over != outer:
        blade.write_rapid(over)
    write_spindle_end(filled, code)


def _loop(filled_shape: ShapeInstance, code: CodeWriter, outer: float, first: float) -> None:
    """Write a loop of incremental moves that cuts several equal grooves, one plunge per groove."""
    deep = get_tool_side_sign(filled_shape) * (outer - filled_shape.get_number("BOTTOM") / 2.0)
    code.write_rapid(z=first)
    code.append_lines(
        "G91",
        f"LS{filled_shape.get_number('COUNT'):.0f}",
        f"G95F{format_short_number(filled_shape.get_number('FEED'), 6)}{code.format_x(-deep)}",
    )
    code.write_dwell(filled_shape.get_number("DWELL"))
    code.append_lines(
        f"G00{code.format_x(deep)}", code.format_z(-filled_shape.get_number("PITCH")), "LF", "G90"
    )


def _one_groove(filled: ShapeInstance, blade: BladeWriter, outer: float, chuck: float, free: float) -> None:
    count, feed, bottom = _plunges(filled), filled.get_number("FEED"), filled.get_number("BOTTOM") / 2.0
    front = chuck + filled.get_number("LONG")
    steps = [
        front - blade.width + (chuck - front + blade.width) * k / max(count - 1, 1) for k in range(count)
    ]
    for at in steps if count > 1 else [chuck]:
        blade.write_positioning_moves(blade.calculate_z_at_chuck_corner(at), outer)
        blade.write_cut(bottom, feed=feed)
        if at == steps[-1] and count > 1:
            blade.write_cut(z=blade.calculate_z_at_face_corner(front))  # cut along the bottom
        else:
            blade.write_dwell(filled.get_number("DWELL"))
        blade.write_rapid(outer)
    edge, sign = filled.get_number("EDGE"), math.copysign(1.0, free)
    if edge:
        top = filled.get_number("TOP") / 2.0
        for z, inner in (
            (blade.calculate_z_at_face_corner(front) + edge, blade.calculate_z_at_face_corner(front)),
            (blade.calculate_z_at_chuck_corner(chuck) - edge, blade.calculate_z_at_chuck_corner(chuck)),
        ):
            out = math.copysign(abs(free), z - inner)
            blade.write_rapid(z=z + out)
            blade.write_cut(top - sign * edge, inner, feed=feed)
            blade.write_rapid(outer)


def _slanted_groove(
    filled_shape: ShapeInstance, blade: BladeWriter, outer: float, chuck: float, free: float
) -> None:
    """Write the moves of a groove with sloped walls: plunges, both walls and the bottom.

    The plunges end before the corners of the blade reach a wall.
    """
    feed, top, bottom = (
        filled_shape.get_number("FEED"),
        filled_shape.get_number("TOP") / 2.0,
        filled_shape.get_number("BOTTOM") / 2.0,
    )
    deep, front, count = abs(top - bottom), chuck + filled_shape.get_number("LONG"), _plunges(filled_shape)
    at_face, at_chuck = _slants(filled_shape)
    for k in range(count):
        at = front - blade.width + (chuck - front + blade.width) * k / max(count - 1, 1)
        walls = [(front - blade.width - at) / at_face if at_face else deep]
        walls.append((at - chuck) / at_chuck if at_chuck else deep)
        here = min(deep, *walls)
        if here > abs(free):
            blade.write_positioning_moves(blade.calculate_z_at_chuck_corner(at), outer)
            blade.write_cut(top - math.copysign(here, free), feed=feed)
            blade.write_rapid(outer)
    back = blade.calculate_z_at_chuck_corner(chuck + deep * at_chuck)
    blade.write_positioning_moves(blade.calculate_z_at_face_corner(front + abs(free) * at_face), outer)
    blade.write_cut(bottom, blade.calculate_z_at_face_corner(front - deep * at_face), feed=feed)
    blade.write_cut(z=back)
    blade.write_rapid(outer)
    blade.write_rapid(z=blade.calculate_z_at_chuck_corner(chuck - abs(free) * at_chuck))
    blade.write_cut(bottom, back, feed=feed)
    blade.write_rapid(outer)


def _groove_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    top, bottom, wide, long = (filled.get_number(word) for word in ("TOP", "BOTTOM", "WIDE", "LONG"))
    inside = filled.get_text("SIDE") == INSIDE
    if wide > long + 1e-9:
        yield FieldError(
            "LONG",
            Message(
                "The groove is {long} wide, but the blade is {wide} wide: use a narrower blade.",
                long=f"{long:g}",
                wide=f"{wide:g}",
            ),
        )
    if inside and bottom <= top:
        yield FieldError(
            "BOTTOM",
            Message(
                "A groove in a bore of {top} is cut outward, so bottom diameter {bottom} is too small.",
                top=f"{top:g}",
                bottom=f"{bottom:g}",
            ),
        )
    if not inside and bottom >= top:
        yield FieldError(
            "BOTTOM",
            Message(
                "The groove bottom diameter {bottom} must be less than {top}, the diameter at "
                "which the groove starts.",
                bottom=f"{bottom:g}",
                top=f"{top:g}",
            ),
        )
    yield from check_blade(filled, setting, abs(top - bottom) / 2.0, "BOTTOM")
    if filled.get_number("COUNT") > 1 and filled.get_number("PITCH") < long:
        words = Message(
            "Grooves of width {long} overlap at a pitch of {number}: enter a larger pitch.",
            long=f"{long:g}",
            number=f"{filled.get_number('PITCH'):g}",
        )
        yield FieldError("PITCH", words)
    if filled.get_number("EDGE") >= abs(top - bottom) / 2.0:
        yield FieldError("EDGE", "The chamfer is at least as deep as the groove: enter a smaller chamfer.")
    over = filled.get_number("OVER")
    if inside and over > top:
        yield FieldError(
            "OVER",
            Message(
                "Diameter {excess} is more than the bore diameter of {top}, so the tool has "
                "nothing to clear: enter 0.",
                excess=f"{over:g}",
                top=f"{top:g}",
            ),
        )
    if not inside and 0.0 < over < top:
        yield FieldError(
            "OVER",
            Message(
                "Diameter {excess} is less than diameter {top}, so the tool has nothing to clear: enter 0.",
                excess=f"{over:g}",
                top=f"{top:g}",
            ),
        )
    yield from _slant_checks(filled, abs(top - bottom) / 2.0)
    yield from check_rpm(filled, setting)
    yield from check_feeds(filled, setting, "FEED")


def _slant_checks(filled: ShapeInstance, deep: float) -> Iterator[FieldError]:
    wide, long = filled.get_number("WIDE"), filled.get_number("LONG")
    for word in ("FANGLE", "CANGLE"):
        if filled.get_number(word) < 0.0:
            yield FieldError(
                word, "A blade cannot reach under a wall that overhangs the groove: enter 0 or more."
            )
            return
    if not any(_slants(filled)):
        return
    bottom = long - deep * sum(_slants(filled))
    if bottom < wide - 1e-9:
        yield FieldError(
            "LONG",
            Message(
                "With these walls, the groove bottom is {bottom} wide, but the blade is {wide} "
                "wide: use a narrower blade, or check the angles.",
                bottom=f"{bottom:.4g}",
                wide=f"{wide:g}",
            ),
        )
    if filled.get_number("EDGE"):
        yield FieldError("EDGE", "Edges of sloped walls cannot be chamfered in this shape: enter 0.")


def _groove_sketch(filled: ShapeInstance) -> Sketch:
    slanted = any(_slants(filled)) and filled.get_number("FANGLE") >= 0.0 <= filled.get_number("CANGLE")
    front, back = (-8.0 + 1.5 * bool(slanted), -14.0 - 1.5 * bool(slanted))
    walls = ((front, 10), (-8, 6), (-14, 6), (back, 10))
    solid = make_part_outline((0, 0), (0, 10), *walls, (-26, 10), (-26, 0))
    blade = make_tool_outline((-14, 14), (-14, 6.2), (-11, 6.2), (-11, 14))
    return make_sketch(
        solid,
        make_cut_outline(*walls),
        blade,
        dimensions=(
            Dimension("TOP", (-22, -10), (-22, 10)),
            Dimension("BOTTOM", (-9.5, -6), (-9.5, 6)),
            Dimension("AT", (front, 10), (0, 10), 2),
            Dimension("LONG", (back, 3), (front, 3), 0),
            Dimension("WIDE", (-14, 14), (-11, 14), 2),
            *((Dimension("FANGLE", (-5, 8)), Dimension("CANGLE", (-18, 8))) if slanted else ()),
            *((Dimension("PITCH", (-22, 14)),) if filled.get_number("COUNT") > 1 else ()),
        ),
    )


def _several(values: FieldValues) -> bool:
    return number(values, "COUNT") > 1.0


GROOVE_SHAPE = Shape(
    "GROOVE",
    "one or more grooves on the outside, in a bore or with a rear tool, with "
    "chamfered edges and square or sloped walls",
    (
        make_tool_field(ToolKind.GROOVING),
        ShapeField("SIDE", "SIDE", FieldKind.CHOICE, FRONT, (FRONT, REAR, INSIDE)),
        ShapeField("TOP", "DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("BOTTOM", "BOTTOM DIAMETER", FieldKind.DIAMETER),
        ShapeField("AT", "DISTANCE FROM Z0 TO START", FieldKind.LENGTH, allows_zero=True),
        BLADE_WIDTH_FIELD,
        ShapeField("LONG", "GROOVE WIDTH", FieldKind.LENGTH, lambda v, _s: number(v, "WIDE") or None),
        BLADE_CORNER_FIELD,
        ShapeField("EDGE", "CHAMFER AT BOTH EDGES", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("COUNT", "NUMBER OF GROOVES", FieldKind.COUNT, 1.0, maximum=1000),
        ShapeField("PITCH", "PITCH", FieldKind.LENGTH, None, applies_to=_several),
        ShapeField("DWELL", "DWELL AT BOTTOM", FieldKind.SECONDS, 0.1, allows_zero=True, maximum=60),
        ShapeField("FANGLE", "SLOPE OF FACE-SIDE WALL", FieldKind.ANGLE, 0.0, maximum=80.0, allows_zero=True),
        ShapeField(
            "CANGLE", "SLOPE OF CHUCK-SIDE WALL", FieldKind.ANGLE, 0.0, maximum=80.0, allows_zero=True
        ),
        ShapeField("OVER", "DIAMETER TO CLEAR", FieldKind.DIAMETER, 0.0, allows_zero=True),
        make_feed_field(Operation.GROOVE),
        make_rpm_field(Operation.GROOVE, make_diameter_reader("TOP")),
    ),
    _groove,
    _groove_sketch,
    _groove_checks,
)


# --- SINUMERIK: CYCLE93 if the tool has two cutting edges


def _by_cycle(values: FieldValues) -> bool:
    return number(values, "DN") > 0.0


def _sinumerik_groove(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    if not _by_cycle(filled.field_values):
        _groove(filled, setting, code)
        return
    inside, top = filled.get_text("SIDE") == INSIDE, filled.get_number("TOP")
    free = -BLADE_CLEARANCE[setting.metric] if inside else BLADE_CLEARANCE[setting.metric]
    over, deep = (filled.get_number("OVER") or top) / 2.0 + free, abs(top - filled.get_number("BOTTOM")) / 2.0
    write_spindle_start(filled, setting, code, over, None)
    code.write_rapid(
        z=BladeWriter(filled, code).calculate_z_at_chuck_corner(
            -filled.get_number("AT") - filled.get_number("LONG")
        )
    )
    code.write_feed_line(filled.get_number("FEED"))
    across, width, depth, dwell = (
        format_sinumerik_number(v) for v in (top, filled.get_number("LONG"), deep, filled.get_number("DWELL"))
    )
    kind = "7" if inside else "5"
    for k in range(int(filled.get_number("COUNT"))):
        begin = format_sinumerik_number(-filled.get_number("AT") - k * filled.get_number("PITCH"))
        words = (
            across,
            begin,
            width,
            depth,
            *[""] * 10,
            dwell,
            kind,
            "",
            format_sinumerik_number(filled.get_number("DN")),
        )
        code.append_lines("CYCLE93(" + ", ".join(words) + ")")
    code.clear_modal_state()
    if filled.get_number("OVER"):
        code.write_rapid(over)
    write_spindle_end(filled, code)


def _sinumerik_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    yield from _groove_checks(filled, setting)
    if not _by_cycle(filled.field_values):
        return
    if filled.get_number("DN") == 1.0:
        yield FieldError(
            "DN",
            "D1 is the cutting corner of the blade: enter the D number of the other "
            "corner, or 0 to use G1 instead of CYCLE93.",
        )
    if filled.get_text("SIDE") == REAR:
        yield FieldError(
            "SIDE",
            "CYCLE93 does not support a tool at negative X: to use G1 instead, enter 0 as the D "
            "number of the other blade corner.",
        )
    if filled.get_number("EDGE"):
        yield FieldError(
            "EDGE",
            "CYCLE93 cannot chamfer these edges: enter 0 for the chamfer or, to use G1 instead, "
            "enter 0 as the D number of the other blade corner.",
        )
    if any(_slants(filled)):
        yield FieldError(
            "FANGLE",
            "CYCLE93 can cut only square walls in this shape: enter 0 for the slope or, to use "
            "G1 instead, enter 0 as the D number of the other blade corner.",
        )


SINUMERIK_GROOVE_SHAPE = replace(
    GROOVE_SHAPE,
    write_lines=_sinumerik_groove,
    find_field_conflicts=_sinumerik_checks,
    fields=(
        *GROOVE_SHAPE.fields,
        ShapeField("DN", "CYCLE93: D OF OTHER CORNER", FieldKind.OFFSET, 0.0, maximum=9, allows_zero=True),
    ),
)
"""Groove form for SINUMERIK.

CYCLE93 derives the blade width from the offsets of two cutting edges, which the form does not set.
"""
