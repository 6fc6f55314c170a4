"""Facing, and turning along a profile: roughing with G75, then the contour."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from core.extras.shapes.contour import SAME, Row, contour_refusals, outline, points, row_word
from core.extras.shapes.cutting_data import Work, facing_depth, finish_depth, most_depth, rough_depth
from core.extras.shapes.lines.code_lines import Along, Code
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, number, text
from core.extras.shapes.usual_fields import (
    around,
    bar,
    feed_field,
    per_rev,
    rpm_field,
    surface_field,
    too_fast,
    tool_field,
)
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch, turned

OUTSIDE, INSIDE = "OUTSIDE", "BORE"
_BESIDE = {False: 0.02, True: 0.5}  # by metric; clearance from the part at which a contour begins and ends


def _roughs(values: Values) -> bool:
    return number(values, "ROUGH") > 0.0


LOWEST, HIGHEST = "LOWEST", "HIGHEST"
"""Diameters between which the points of a contour turn; they are no fields, proposals follow them."""


def _extent(rows: Sequence[Row]) -> Values:
    """Return LOWEST and HIGHEST of a contour, without moves square across the face.

    The result is empty if roughing along Z cannot cut the contour.
    """
    there = points(rows)
    turned = [r for a, b in pairwise(there) if abs(a[0] - b[0]) > SAME for r in (a[1], b[1])]
    if not turned or any(b[0] > a[0] + SAME for a, b in pairwise(there)):
        return {}
    return {LOWEST: 2.0 * min(turned), HIGHEST: 2.0 * max(turned)}


def _stock_and_end(values: Values) -> tuple[float, float]:
    """Return the diameters of the stock and of the deepest cut; equal if they are unknown."""
    low = number(values, LOWEST) or number(values, "SMALL")
    high = max(number(values, each) for each in (HIGHEST, "LARGE", "DIAM"))
    if text(values, "SIDE") == INSIDE or "DIAM" in values:
        return number(values, "HOLE") or high, high
    if not {LOWEST, "SMALL"} & values.keys():
        return high, high
    return max(number(values, "FROM"), high), low


def _depth(values: Values, setting: Setting) -> Value | None:
    """Propose roughing passes if the stock exceeds two finishing passes."""
    stock, end = _stock_and_end(values)
    depth = rough_depth(setting, number(values, "T"), max(stock, end), inside=end > stock)
    return depth if abs(stock - end) / 4.0 > finish_depth(setting, depth) + SAME else 0.0


def _leave(values: Values, setting: Setting) -> Value | None:
    return finish_depth(setting, number(values, "ROUGH"))


ROUGH = Field("ROUGH", "ROUGHING DEPTH OF CUT", Kind.LENGTH, _depth, zero=True)
LEAVE = Field("LEAVE", "FINISHING ALLOWANCE", Kind.LENGTH, _leave, zero=True, only=_roughs)
RFEED = feed_field(Work.TURN, "RFEED", "ROUGHING FEED", only=_roughs)
COMP = Field("COMP", "NOSE COMPENSATION: D NUMBER", Kind.OFFSET, 0.0, zero=True, most=32)


def _next_label(_values: Values, setting: Setting) -> Value | None:
    return float(setting.free_sub)


LABEL = Field("LABEL", "CONTOUR NUMBER", Kind.COUNT, _next_label, most=9999, only=_roughs)
"""Of a contour that CYCLE95 finds by its labels."""


def begin_spindle(filled: Filled, setting: Setting, code: Code, x: float, z: float | None) -> None:
    """Write tool, spindle and approach to the part, with constant surface speed if specified."""
    code.edge = filled.n("COMP") or 1.0
    code.begin(filled.n("T"), filled.n("RPM"), x, z)
    if filled.n("SURF"):
        code.surface_speed(filled.n("SURF"), min(setting.shop.max_rpm, filled.n("RPM")))


def end_spindle(filled: Filled, code: Code) -> None:
    """Write the retract to the tool change position, and the return to rpm."""
    code.away()
    if filled.n("SURF"):
        code.constant_speed()


# --- Turning a contour


def cut_contour(filled: Filled, setting: Setting, code: Code, rows: Sequence[Row], *, inside: bool) -> None:
    """Write tool and spindle, roughing if a depth is specified, the contour, and the retract."""
    there = points(rows)
    beside = _beside(filled, setting, there, inside=inside)
    rough, comp = filled.n("ROUGH"), filled.n("COMP")
    begin_spindle(filled, setting, code, beside if rough else there[0][1], there[0][0] + setting.near)
    code.along(
        Along(
            rows, beside, inside, filled.n("FEED"), rough, filled.n("LEAVE"), filled.n("RFEED"), comp,
            filled.n("LABEL"),
        )
    )  # fmt: skip
    end_spindle(filled, code)
    code.let_go(comp)


def _beside(filled: Filled, setting: Setting, there: Sequence[tuple[float, float]], *, inside: bool) -> float:
    """Return the radius clear of the material at which a contour ends and roughing begins."""
    free, radii = _BESIDE[setting.metric], [r for _, r in there]
    if inside:
        hole = filled.n("HOLE") / 2.0 or min(radii)
        return max(0.0, min(hole, *radii) - free)
    stock = filled.n("FROM") / 2.0
    return max(stock, *radii) + free


def _contour_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    inside = filled.t("SIDE") == INSIDE
    yield from contour_refusals(filled.rows)
    yield from compensated(filled, setting)
    yield from cutting_checks(filled, setting)
    there = points(filled.rows)
    if filled.n("ROUGH"):
        for at, (before, here) in enumerate(pairwise(there), 2):
            if here[0] > before[0] + 1e-9:
                text_ = Message(
                    "Point {position} runs back toward the face, but roughing can move only toward "
                    "the chuck along Z.",
                    position=at,
                )
                yield Refusal(row_word(at), text_)
                break
        yield from _falls_at_once(there, inside=inside)
    if (
        not inside
        and filled.n("FROM")
        and max((r for _, r in there), default=0.0) > filled.n("FROM") / 2 + 1e-9
    ):
        at = max(range(len(there)), key=lambda n: there[n][1])
        words = Message(
            "Point {position} is outside the stock diameter of {number}: enter a smaller X.",
            position=at + 1,
            number=f"{filled.n('FROM'):g}",
        )
        yield Refusal(row_word(at + 1), words)


def _falls_at_once(there: Sequence[tuple[float, float]], *, inside: bool) -> Iterator[Refusal]:
    """Yield an error if the contour leads into the material at its first point.

    The return path of roughing would cross such a contour.
    """
    side = -1.0 if inside else 1.0
    if len(there) > 1 and there[1][0] < there[0][0] - SAME and side * (there[0][1] - there[1][1]) > SAME:
        yield Refusal(
            row_word(1),
            "The contour cuts deeper directly after its first point, and roughing cannot "
            "return past that point: add a point before the first point, at the same Z and "
            "at the lowest X.",
        )


def compensated(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """Yield an error if G41 would not work."""
    if filled.n("COMP") and setting.called and setting.dialect is Dialect.OMNITURN:
        yield Refusal(
            "COMP",
            "G41 does not work in a subroutine, and a bar feed loop runs this shape in a "
            "subroutine: enter 0.",
        )


def cutting_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """Yield errors for speeds, feeds and depths that the machine or the insert does not permit."""
    yield from too_fast(filled, setting)
    yield from per_rev(filled, setting, "FEED", "RFEED")
    rough, leave = filled.n("ROUGH"), filled.n("LEAVE")
    if rough and leave >= rough:
        yield Refusal(
            "LEAVE",
            Message(
                "A finishing allowance of {leave} is more than a pass of {rough}: enter a smaller allowance.",
                leave=f"{leave:g}",
                rough=f"{rough:g}",
            ),
        )
    stock, end = _stock_and_end({**filled.shape.extent(filled.rows), **filled.values})
    if filled.shape.field("ROUGH") is not None:
        yield from too_deep_pass(filled, setting, "ROUGH", rough or abs(stock - end) / 2.0)


def too_deep_pass(filled: Filled, setting: Setting, word: str, deep: float) -> Iterator[Refusal]:
    """Yield an error if a pass is deeper than the insert permits."""
    most = most_depth(setting, filled.n("T"))
    if deep > most + SAME:
        yield Refusal(
            word,
            Message(
                "A pass would be {depth} deep, but the insert of T{number} allows a depth of "
                "only {maximum}: enter a smaller depth of cut.",
                depth=f"{deep:.4g}",
                number=f"{filled.n('T'):.0f}",
                maximum=f"{most:.4g}",
            ),
        )


def _turn(filled: Filled, setting: Setting, code: Code) -> None:
    cut_contour(filled, setting, code, filled.rows, inside=filled.t("SIDE") == INSIDE)


def _turn_sketch(filled: Filled) -> Sketch:
    rows = [row for row in filled.rows if not row.empty]
    drawn = outline(rows)
    if len(drawn) < 2:
        return sketch(part((0, 0), (0, 5), (-12, 5), (-12, 0)))
    across = max(filled.n("FROM"), 2.0 * max(r for _, r in drawn))
    dims = tuple(Dim(row_word(k), at) for k, at in enumerate(points(rows), 1))
    if filled.t("SIDE") == INSIDE:
        back = min(z for z, _ in drawn)
        wall = 1.3 * max(r for _, r in drawn)
        solid = part((drawn[0][0], wall), *drawn, (back, 0.0), (1.3 * back, 0.0), (1.3 * back, wall))
        return sketch(solid, cut(*drawn), dims=dims)
    return sketch(*turned(drawn, across), dims=dims)


def _outside(values: Values) -> bool:
    return text(values, "SIDE") != INSIDE


TURN = Shape(
    "TURN",
    "a profile of points, corners and arcs, with or without roughing",
    (
        tool_field(ToolKind.TURNING, ToolKind.BORING),
        Field("SIDE", "SIDE", Kind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        Field("FROM", "STOCK DIAMETER", Kind.DIAMETER, bar, zero=True, only=_outside),
        Field("HOLE", "HOLE DIAMETER", Kind.DIAMETER, None, only=lambda v: not _outside(v)),
        ROUGH,
        LEAVE,
        RFEED,
        feed_field(Work.FINISH),
        rpm_field(Work.TURN, around("FROM")),
        surface_field(),
        COMP,
    ),
    _turn,
    _turn_sketch,
    _contour_checks,
    contour=True,
    extent=_extent,
)


# --- Face


def _face(filled: Filled, setting: Setting, code: Code) -> None:
    at, stock, deep = filled.n("AT"), filled.n("STOCK"), filled.n("DEEP")
    start, end = filled.n("FROM") / 2.0 + _BESIDE[setting.metric], filled.n("TO") / 2.0
    passes = max(1, math.ceil(stock / deep - 1e-9)) if deep else 1
    begin_spindle(filled, setting, code, start, at + stock + setting.near)
    for k in range(1, passes + 1):
        z = at + stock * (passes - k) / passes
        if k > 1:
            code.rapid(z=z + stock / passes + _BESIDE[setting.metric])
            code.rapid(x=start)
        code.rapid(z=z)
        code.cut(x=end, feed=filled.n("FEED"))
    end_spindle(filled, code)


def _past_axis(values: Values, setting: Setting) -> Value | None:
    """Return the end diameter of two nose radii past the axis, because stopping earlier leaves a pip."""
    shape = setting.tool(number(values, "T"))
    nose = shape.nose_radius / setting.mm if shape is not None else 0.0
    return -math.ceil(2000.0 * (nose or 0.4 / setting.mm)) / 1000.0


def _facing(values: Values, setting: Setting) -> Value | None:
    return facing_depth(setting, number(values, "T"), number(values, "FROM"))


def _face_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from too_deep_pass(filled, setting, "DEEP", min(filled.n("DEEP"), filled.n("STOCK")))
    if filled.n("TO") >= filled.n("FROM"):
        yield Refusal(
            "TO",
            Message(
                "Facing starts at diameter {number} and runs inward: end diameter {number2} must be less.",
                number=f"{filled.n('FROM'):g}",
                number2=f"{filled.n('TO'):g}",
            ),
        )
    yield from too_fast(filled, setting)
    yield from per_rev(filled, setting, "FEED")


def _face_sketch(_filled: Filled) -> Sketch:
    solid = part((0, 0), (0, 10), (-22, 10), (-22, 0))
    return sketch(
        solid,
        cut((0, 10), (0, 1)),
        cut((3, 10), (3, 0), (0, 0)),
        dims=(
            Dim("FROM", (-16, -10), (-16, 10)),
            Dim("TO", (0, 1), None),
            Dim("STOCK", (0, 10), (3, 10), 4),
            Dim("AT", (0, 5)),
        ),
    )


FACE = Shape(
    "FACE",
    "the end of the part faced square, in one or more passes",
    (
        tool_field(ToolKind.TURNING),
        Field("FROM", "START DIAMETER", Kind.DIAMETER, bar),
        Field("TO", "END DIAMETER", Kind.COORDINATE, _past_axis),
        Field("AT", "FACE AT Z", Kind.COORDINATE, 0.0),
        Field("STOCK", "STOCK ON THE FACE", Kind.LENGTH, 0.0, zero=True),
        Field("DEEP", "DEPTH PER PASS", Kind.LENGTH, _facing, only=lambda v: number(v, "STOCK") > 0),
        feed_field(Work.FINISH),
        rpm_field(Work.TURN, around("FROM")),
        surface_field(),
    ),
    _face,
    _face_sketch,
    _face_checks,
)
