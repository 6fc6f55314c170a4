"""Shapes for bar work: a bar feed loop, parting off, and the positioning of a grooving blade."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.common_fields import (
    check_feeds,
    check_rpm,
    find_next_tool_number,
    make_diameter_reader,
    make_feed_field,
    make_rpm_field,
    make_surface_speed_field,
    make_tool_field,
    propose_bar_diameter,
)
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.forms.turning import write_spindle_end, write_spindle_start
from core.extras.shapes.lines.code_lines import BarFeedLoop, CodeWriter, write_bar_feed_loop
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    make_length_proposal,
    number,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import (
    Dimension,
    Outline,
    Sketch,
    make_cut_outline,
    make_part_outline,
    make_sketch,
    make_tool_outline,
)

FRONT, REAR, INSIDE = "FRONT", "REAR", "BORE"
LEFT, RIGHT = "LEFT", "RIGHT"
_MOST_PECKS = 200
_SLOWER = 0.5  # proposed feed near the center, as a fraction of the feed
BLADE_CLEARANCE = {False: 0.02, True: 0.5}
"""Clearance between a blade and the diameter, in the program unit, by whether the program is metric."""


def _width(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    shape = setting.tool(number(values, "T"))
    return round(shape.width / setting.mm, 5) if shape is not None and shape.width else None


def _corner(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Return the corner of the blade with which it is touched off, according to the tool data.

    If the tool is unknown, the result is the corner nearest to the chuck.
    """
    shape = settings.tool(number(values, "T"))
    return RIGHT if shape is not None and shape.direction[0] > 0 else LEFT


def get_tool_side_sign(filled_shape: ShapeInstance) -> float:
    """Return the sign of X on the tool's side of the axis: -1 for a rear tool, otherwise 1."""
    return -1.0 if filled_shape.get_text("SIDE") == REAR else 1.0


BLADE_WIDTH_FIELD = ShapeField("WIDE", "BLADE WIDTH", FieldKind.LENGTH, _width, is_in_comment=True)
BLADE_CORNER_FIELD = ShapeField(
    "CORNER", "CORNER USED FOR TOUCH-OFF", FieldKind.CHOICE, _corner, (LEFT, RIGHT)
)


class BladeWriter:
    """Writer of moves that position one corner of a grooving or parting blade.

    ``start`` is the radius from which the blade approaches.
    """

    def __init__(self, filled_shape: ShapeInstance, code: CodeWriter, start: float = 0.0) -> None:
        self.width = filled_shape.get_number("WIDE")
        self.is_left_corner = filled_shape.get_text("CORNER") == LEFT
        self._side, self._code = get_tool_side_sign(filled_shape), code
        self._r, self._z = start, math.inf

    def _at(self, r: float | None, z: float | None) -> None:
        self._r = self._r if r is None else r
        self._z = self._z if z is None else z

    def calculate_z_at_chuck_corner(self, chuck: float) -> float:
        """Return the programmed Z that positions the chuck-side corner of the blade at ``chuck``."""
        return chuck if self.is_left_corner else chuck + self.width

    def calculate_z_at_face_corner(self, front: float) -> float:
        """Return the programmed Z that positions the face-side corner of the blade at ``front``."""
        return self.calculate_z_at_chuck_corner(front - self.width)

    def write_positioning_moves(self, z: float, r: float) -> None:
        """Write a move along Z at the current radius, then a move to radius ``r``.

        Unnecessary moves are omitted.
        """
        if z != self._z:
            self.write_rapid(z=z)
        if r != self._r:
            self.write_rapid(r)

    def write_rapid(self, r: float | None = None, z: float | None = None) -> None:
        """Write a rapid to a radius on the tool's side of the axis, and to a programmed Z."""
        self._at(r, z)
        self._code.write_rapid(None if r is None else self._side * r, z)

    def write_cut(self, r: float | None = None, z: float | None = None, feed: float = 0.0) -> None:
        """Write a feed move to a radius on the tool's side of the axis, and to a programmed Z."""
        self._at(r, z)
        self._code.write_cut(None if r is None else self._side * r, z, feed)

    def write_dwell(self, seconds: float) -> None:
        """Write a dwell, unless ``seconds`` is 0."""
        self._code.write_dwell(seconds)


def check_blade(
    filled_shape: ShapeInstance, settings: ProgramSettings, depth: float, word: str
) -> Iterator[FieldError]:
    """Yield errors if the blade is too short, or if its width differs from the tool data."""
    shape, wide, name = (
        settings.tool(filled_shape.get_number("T")),
        filled_shape.get_number("WIDE"),
        f"T{filled_shape.get_number('T'):.0f}",
    )
    if shape is None:
        return
    if shape.length and depth > shape.length / settings.mm + 1e-9:
        yield FieldError(
            word,
            Message(
                "Depth {depth} is more than the reach of {name}, which is {length}. Use a longer blade.",
                depth=f"{depth:.4g}",
                name=name,
                length=f"{shape.length / settings.mm:.4g}",
            ),
        )
    if shape.width and abs(shape.width / settings.mm - wide) > 0.001 / settings.mm * 25.4:
        yield FieldError(
            "WIDE",
            Message(
                "The blade width in the tool data of {name} is {width}: enter that width.",
                name=name,
                width=f"{shape.width / settings.mm:.4g}",
            ),
        )


def _part_off(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    free = BLADE_CLEARANCE[setting.metric]
    bar_r, back, feed = filled.get_number("FROM") / 2.0, -filled.get_number("LONG"), filled.get_number("FEED")
    blade = BladeWriter(filled, code)
    kerf = blade.calculate_z_at_face_corner(back)
    write_spindle_start(filled, setting, code, get_tool_side_sign(filled) * (bar_r + free), None)
    blade.write_rapid(z=kerf)
    own, following = filled.get_number("BACK"), filled.get_number("NEXT")
    if own or following:
        blade.write_cut(bar_r - max(own, following) - free, feed=feed)
        blade.write_rapid(bar_r + free)
    if following:
        blade.write_rapid(z=kerf - following - free)
        blade.write_cut(bar_r - following, kerf, feed=feed)
        blade.write_rapid(bar_r + free)
    if own:
        blade.write_rapid(z=kerf + own + free)
        blade.write_cut(bar_r - own, kerf, feed=feed)
    _write_parting_cut(filled, blade, bar_r, free)
    write_spindle_end(filled, code)


def _write_parting_cut(filled: ShapeInstance, blade: BladeWriter, bar_r: float, free: float) -> None:
    """Write the cut to the end diameter, with pecks and a lower feed near the center if specified.

    After each peck, the blade leaves the cut, so that the chips fall out. It returns to ``free`` before the
    bottom of the cut.
    """
    end, peck = filled.get_number("TO") / 2.0, filled.get_number("PECK")
    slow_r = filled.get_number("SLOW") / 2.0
    count = math.ceil((bar_r - end) / peck - 1e-9) if peck else 1
    for k in range(1, count + 1):
        start, goal = bar_r - (k - 1) * peck, end if k == count else bar_r - k * peck
        if k > 1:
            blade.write_rapid(min(start + free, bar_r + free))
        if start > slow_r:
            blade.write_cut(max(goal, slow_r), feed=filled.get_number("FEED"))
        if goal < slow_r:
            blade.write_cut(goal, feed=filled.get_number("CFEED"))
        blade.write_rapid(bar_r + free)


def _part_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    top, end = filled.get_number("FROM"), filled.get_number("TO")
    if end >= top:
        yield FieldError(
            "TO",
            Message(
                "Parting off starts at diameter {top} and runs inward: end diameter {end} must be less.",
                top=f"{top:g}",
                end=f"{end:g}",
            ),
        )
    for word in ("BACK", "NEXT"):
        if filled.get_number(word) >= (top - end) / 2.0 > 0.0:
            yield FieldError(
                word,
                Message(
                    "A chamfer of {word} removes the whole wall: enter a smaller chamfer.",
                    word=f"{filled.get_number(word):g}",
                ),
            )
    if filled.get_number("BACK") > filled.get_number("LONG"):
        yield FieldError("BACK", "The chamfer is longer than the part: enter a smaller chamfer.")
    yield from _check_parting_cut(filled)
    yield from check_blade(filled, setting, (top - end) / 2.0, "FROM")
    yield from check_rpm(filled, setting)
    yield from check_feeds(filled, setting, "FEED")


def _check_parting_cut(filled: ShapeInstance) -> Iterator[FieldError]:
    """Yield errors of the pecks and of the lower feed near the center."""
    top, end, peck, slow = (filled.get_number(word) for word in ("FROM", "TO", "PECK", "SLOW"))
    if peck >= (top - end) / 2.0 > 0.0:
        yield FieldError(
            "PECK",
            Message(
                "A peck of {peck} reaches the end of the cut at once: enter a smaller peck depth, or 0.",
                peck=f"{peck:g}",
            ),
        )
    if peck and (top - end) / 2.0 > _MOST_PECKS * peck:
        yield FieldError(
            "PECK",
            Message(
                "With a peck depth of {peck}, the cut needs more than {count} pecks: enter a larger depth.",
                peck=f"{peck:g}",
                count=_MOST_PECKS,
            ),
        )
    if slow and not end < slow < top:
        yield FieldError(
            "SLOW",
            Message(
                "The feed cannot change at diameter {slow}, because the cut runs from {top} to {end}: "
                "enter a diameter between them, or 0.",
                slow=f"{slow:g}",
                top=f"{top:g}",
                end=f"{end:g}",
            ),
        )
    if slow and filled.get_number("CFEED") > filled.get_number("FEED"):
        yield FieldError("CFEED", "The feed near the center is higher than FEED: enter a lower feed.")


def _part_sketch(_filled: ShapeInstance) -> Sketch:
    solid = make_part_outline(
        (0, 0), (0, 10), (-13, 10), (-14, 9), (-14, 0.4), (-17, 0.4), (-17, 9), (-18, 10), (-27, 10), (-27, 0)
    )
    return make_sketch(
        solid,
        make_cut_outline((-13, 10), (-14, 9), (-14, 0.4), (-17, 0.4), (-17, 9), (-18, 10)),
        make_tool_outline((-17, 16), (-17, 10.5), (-14, 10.5), (-14, 16)),
        dimensions=(
            Dimension("FROM", (-24, -10), (-24, 10)),
            Dimension("TO", (-14, 0.4)),
            Dimension("LONG", (-14, 10), (0, 10), 3),
            Dimension("WIDE", (-17, 16), (-14, 16), 2),
            Dimension("BACK", (-12.4, 9)),
            Dimension("NEXT", (-20.5, 9)),
        ),
    )


def _slows_down(values: FieldValues) -> bool:
    return number(values, "SLOW") > 0.0


def _propose_center_feed(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
    return round(_SLOWER * number(values, "FEED"), 5) or None


PARTING_SHAPE = Shape(
    "PART OFF",
    "parts off to the center or to a bore, with chamfers on both sides of the cut, "
    "pecks, and a lower feed near the center",
    (
        make_tool_field(ToolKind.PARTING, ToolKind.GROOVING),
        ShapeField("SIDE", "SIDE", FieldKind.CHOICE, FRONT, (FRONT, REAR)),
        ShapeField("FROM", "DIAMETER", FieldKind.DIAMETER, propose_bar_diameter),
        ShapeField("TO", "END DIAMETER", FieldKind.DIAMETER, 0.0, allows_zero=True),
        ShapeField("LONG", "PART LENGTH", FieldKind.LENGTH),
        BLADE_WIDTH_FIELD,
        BLADE_CORNER_FIELD,
        ShapeField("BACK", "CHAMFER ON THE PART", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("NEXT", "CHAMFER ON THE BAR", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("PECK", "PECK DEPTH", FieldKind.LENGTH, 0.0, allows_zero=True),
        make_feed_field(Operation.PART_OFF),
        ShapeField("SLOW", "LOWER FEED FROM DIAMETER", FieldKind.DIAMETER, 0.0, allows_zero=True),
        ShapeField(
            "CFEED", "FEED NEAR THE CENTER", FieldKind.FEED, _propose_center_feed, applies_to=_slows_down
        ),
        make_rpm_field(Operation.PART_OFF, make_diameter_reader("FROM")),
        make_surface_speed_field(),
    ),
    _part_off,
    _part_sketch,
    _part_checks,
)


EACH, ONCE = "EACH PART", "ONCE"


def _sub(_values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return float(setting.free_subroutine_number)


def _loop(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    write_bar_feed_loop(
        code,
        BarFeedLoop(
            int(filled.get_number("COUNT")),
            filled.get_number("LONG"),
            filled.get_text("FEEDS") == EACH,
            filled.get_number("STOP"),
            filled.get_number("STOCK"),
            filled.get_number("RATE"),
            int(filled.get_number("SUB")),
        ),
    )


def _checks(_filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    if setting.is_subroutine:
        yield FieldError(
            "COUNT",
            "A bar feed loop cannot be inside another bar feed loop: write this shape "
            "before or after the other loop.",
        )


def _sketch(_filled: ShapeInstance) -> Sketch:
    bar = make_part_outline((0, 0), (0, 7), (-30, 7), (-30, 0))
    cuts = [Outline(((z, 0.0), (z, 7.0)), "cut") for z in (-8, -16, -24)]
    return make_sketch(
        bar,
        *cuts,
        make_tool_outline((1, -3), (1, 3), (4, 3), (4, -3)),
        dimensions=(
            Dimension("LONG", (-16, 7), (-8, 7), 3),
            Dimension("COUNT", (-20, -4)),
            Dimension("STOCK", (0, 10)),
            Dimension("STOP", (5, -5)),
        ),
    )


def _tail(filled: ShapeInstance) -> tuple[str, ...]:
    return f"}}{filled.get_number('SUB'):.0f}", "M99"


BAR_LOOP_SHAPE = Shape(
    "BAR LOOP",
    "feeds the bar to a stop and repeats the following lines for a number of "
    "parts; these lines make the part",
    (
        ShapeField("COUNT", "PARTS", FieldKind.COUNT, None, maximum=100_000),
        ShapeField("LONG", "BAR LENGTH PER PART + CUT-OFF", FieldKind.LENGTH),
        ShapeField("FEEDS", "FEED THE BAR", FieldKind.CHOICE, EACH, (EACH, ONCE)),
        ShapeField(
            "STOP",
            "TOOL USED AS STOP",
            FieldKind.TOOL,
            lambda _v, s: float(find_next_tool_number(s)),
            maximum=32,
        ),
        ShapeField(
            "STOCK", "FACING ALLOWANCE", FieldKind.LENGTH, make_length_proposal(0.025, 0.6), allows_zero=True
        ),
        ShapeField("RATE", "BAR FEED PER MINUTE", FieldKind.RATE, make_length_proposal(50.0, 1200.0)),
        ShapeField("SUB", "PART SUBROUTINE NUMBER", FieldKind.COUNT, _sub, maximum=9999),
    ),
    _loop,
    _sketch,
    _checks,
    make_program_end_lines=_tail,
)


def check_chuck_codes(settings: ProgramSettings, word: str) -> Iterator[FieldError]:
    """Yield an error if a SINUMERIK program cannot open the chuck of this machine.

    ``word`` is the name of the field for which the error is reported.
    """
    if settings.shop.chuck_codes is None:
        yield FieldError(
            word,
            "This machine has no M codes that open and close the chuck: assign two M codes "
            "to the output named collet under [m_codes] in the machine file.",
        )


def _sinumerik_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    yield from check_chuck_codes(setting, "FEEDS")
    yield from _checks(filled, setting)


def _sinumerik_tail(filled: ShapeInstance) -> tuple[str, ...]:
    return f"%_N_PART_{filled.get_number('SUB'):.0f}_SPF", "M17"


SINUMERIK_BAR_LOOP_SHAPE = replace(
    BAR_LOOP_SHAPE, find_field_conflicts=_sinumerik_checks, make_program_end_lines=_sinumerik_tail
)
"""Bar loop for SINUMERIK, with a subprogram and the machine's own M codes for the chuck."""
