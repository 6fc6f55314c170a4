"""Groove shape: plunges of a blade, square or sloped walls, chamfered edges, several at one pitch."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.cutting_data import Work
from core.extras.shapes.forms.bar_work import (
    BLADE_FIELD,
    CORNER_FIELD,
    FREE,
    FRONT,
    INSIDE,
    REAR,
    Blade,
    reach,
    side_of,
)
from core.extras.shapes.forms.turning import begin_spindle, end_spindle
from core.extras.shapes.lines.code_lines import Code, figure, plain
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Values, number
from core.extras.shapes.usual_fields import around, bar, feed_field, per_rev, rpm_field, too_fast, tool_field
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch, tool

_OVERLAP = 0.8  # distance between plunges as a fraction of the blade width


def _plunges(filled: Filled) -> int:
    over = filled.n("LONG") - filled.n("WIDE")
    return 1 + math.ceil(over / (_OVERLAP * filled.n("WIDE")) - 1e-9) if over > 1e-9 else 1


def _slants(filled: Filled) -> tuple[float, float]:
    """Return the slopes of the walls at the face and at the chuck, per unit of depth."""
    return math.tan(math.radians(filled.n("FANGLE"))), math.tan(math.radians(filled.n("CANGLE")))


def _groove(filled: Filled, setting: Setting, code: Code) -> None:
    free = -FREE[setting.metric] if filled.t("SIDE") == INSIDE else FREE[setting.metric]
    outer = filled.n("TOP") / 2.0 + free
    over = filled.n("OVER") / 2.0 + free if filled.n("OVER") else outer
    blade, chuck = Blade(filled, code, over), -filled.n("AT") - filled.n("LONG")
    many, slanted = int(filled.n("COUNT")), any(_slants(filled))
    begin_spindle(filled, setting, code, side_of(filled) * over, None)
    plain_ones = _plunges(filled) == 1 and not filled.n("EDGE") and not slanted and over == outer
    if many > 1 and plain_ones and code.loops and not setting.called:
        _loop(filled, code, outer, blade.at(chuck))
    else:
        one = _slanted_groove if slanted else _one_groove
        for k in range(max(many, 1)):
            one(filled, blade, outer, chuck - k * filled.n("PITCH"), free)
    if over != outer:
        blade.rapid(over)
    end_spindle(filled, code)


def _loop(filled: Filled, code: Code, outer: float, first: float) -> None:
    """Write grooves of one plunge each as a loop with incremental moves."""
    deep = side_of(filled) * (outer - filled.n("BOTTOM") / 2.0)
    code.rapid(z=first)
    code.write("G91", f"LS{filled.n('COUNT'):.0f}", f"G95F{plain(filled.n('FEED'), 6)}{code.x(-deep)}")
    code.dwell(filled.n("DWELL"))
    code.write(f"G00{code.x(deep)}", code.z(-filled.n("PITCH")), "LF", "G90")


def _one_groove(filled: Filled, blade: Blade, outer: float, chuck: float, free: float) -> None:
    count, feed, bottom = _plunges(filled), filled.n("FEED"), filled.n("BOTTOM") / 2.0
    front = chuck + filled.n("LONG")
    steps = [front - blade.wide + (chuck - front + blade.wide) * k / max(count - 1, 1) for k in range(count)]
    for at in steps if count > 1 else [chuck]:
        blade.over(blade.at(at), outer)
        blade.cut(bottom, feed=feed)
        if at == steps[-1] and count > 1:
            blade.cut(z=blade.face(front))  # cut along the bottom
        else:
            blade.dwell(filled.n("DWELL"))
        blade.rapid(outer)
    edge, sign = filled.n("EDGE"), math.copysign(1.0, free)
    if edge:
        top = filled.n("TOP") / 2.0
        for z, inner in (
            (blade.face(front) + edge, blade.face(front)),
            (blade.at(chuck) - edge, blade.at(chuck)),
        ):
            out = math.copysign(abs(free), z - inner)
            blade.rapid(z=z + out)
            blade.cut(top - sign * edge, inner, feed=feed)
            blade.rapid(outer)


def _slanted_groove(filled: Filled, blade: Blade, outer: float, chuck: float, free: float) -> None:
    """Write plunges limited by the corners of the blade, then cuts down each wall and along the bottom."""
    feed, top, bottom = filled.n("FEED"), filled.n("TOP") / 2.0, filled.n("BOTTOM") / 2.0
    deep, front, count = abs(top - bottom), chuck + filled.n("LONG"), _plunges(filled)
    at_face, at_chuck = _slants(filled)
    for k in range(count):
        at = front - blade.wide + (chuck - front + blade.wide) * k / max(count - 1, 1)
        walls = [(front - blade.wide - at) / at_face if at_face else deep]
        walls.append((at - chuck) / at_chuck if at_chuck else deep)
        here = min(deep, *walls)
        if here > abs(free):
            blade.over(blade.at(at), outer)
            blade.cut(top - math.copysign(here, free), feed=feed)
            blade.rapid(outer)
    back = blade.at(chuck + deep * at_chuck)
    blade.over(blade.face(front + abs(free) * at_face), outer)
    blade.cut(bottom, blade.face(front - deep * at_face), feed=feed)
    blade.cut(z=back)
    blade.rapid(outer)
    blade.rapid(z=blade.at(chuck - abs(free) * at_chuck))
    blade.cut(bottom, back, feed=feed)
    blade.rapid(outer)


def _groove_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    top, bottom, wide, long = (filled.n(word) for word in ("TOP", "BOTTOM", "WIDE", "LONG"))
    inside = filled.t("SIDE") == INSIDE
    if wide > long + 1e-9:
        yield Refusal(
            "LONG",
            Message(
                "The groove is {long} wide, but the blade is {wide} wide: use a narrower blade.",
                long=f"{long:g}",
                wide=f"{wide:g}",
            ),
        )
    if inside and bottom <= top:
        yield Refusal(
            "BOTTOM",
            Message(
                "A groove in a bore of {top} is cut outward, so bottom diameter {bottom} is too small.",
                top=f"{top:g}",
                bottom=f"{bottom:g}",
            ),
        )
    if not inside and bottom >= top:
        yield Refusal(
            "BOTTOM",
            Message(
                "The groove bottom diameter {bottom} must be less than {top}, the diameter at "
                "which the groove starts.",
                bottom=f"{bottom:g}",
                top=f"{top:g}",
            ),
        )
    yield from reach(filled, setting, abs(top - bottom) / 2.0, "BOTTOM")
    if filled.n("COUNT") > 1 and filled.n("PITCH") < long:
        words = Message(
            "Grooves of width {long} overlap at a pitch of {number}: enter a larger pitch.",
            long=f"{long:g}",
            number=f"{filled.n('PITCH'):g}",
        )
        yield Refusal("PITCH", words)
    if filled.n("EDGE") >= abs(top - bottom) / 2.0:
        yield Refusal("EDGE", "The chamfer is at least as deep as the groove: enter a smaller chamfer.")
    over = filled.n("OVER")
    if inside and over > top:
        yield Refusal(
            "OVER",
            Message(
                "Diameter {excess} is more than the bore diameter of {top}, so the tool has "
                "nothing to clear: enter 0.",
                excess=f"{over:g}",
                top=f"{top:g}",
            ),
        )
    if not inside and 0.0 < over < top:
        yield Refusal(
            "OVER",
            Message(
                "Diameter {excess} is less than diameter {top}, so the tool has nothing to clear: enter 0.",
                excess=f"{over:g}",
                top=f"{top:g}",
            ),
        )
    yield from _slant_checks(filled, abs(top - bottom) / 2.0)
    yield from too_fast(filled, setting)
    yield from per_rev(filled, setting, "FEED")


def _slant_checks(filled: Filled, deep: float) -> Iterator[Refusal]:
    wide, long = filled.n("WIDE"), filled.n("LONG")
    for word in ("FANGLE", "CANGLE"):
        if filled.n(word) < 0.0:
            yield Refusal(
                word, "A blade cannot reach under a wall that overhangs the groove: enter 0 or more."
            )
            return
    if not any(_slants(filled)):
        return
    bottom = long - deep * sum(_slants(filled))
    if bottom < wide - 1e-9:
        yield Refusal(
            "LONG",
            Message(
                "With these walls, the groove bottom is {bottom} wide, but the blade is {wide} "
                "wide: use a narrower blade, or check the angles.",
                bottom=f"{bottom:.4g}",
                wide=f"{wide:g}",
            ),
        )
    if filled.n("EDGE"):
        yield Refusal("EDGE", "Edges of sloped walls cannot be chamfered in this shape: enter 0.")


def _groove_sketch(filled: Filled) -> Sketch:
    slanted = any(_slants(filled)) and filled.n("FANGLE") >= 0.0 <= filled.n("CANGLE")
    front, back = (-8.0 + 1.5 * bool(slanted), -14.0 - 1.5 * bool(slanted))
    walls = ((front, 10), (-8, 6), (-14, 6), (back, 10))
    solid = part((0, 0), (0, 10), *walls, (-26, 10), (-26, 0))
    blade = tool((-14, 14), (-14, 6.2), (-11, 6.2), (-11, 14))
    return sketch(
        solid,
        cut(*walls),
        blade,
        dims=(
            Dim("TOP", (-22, -10), (-22, 10)),
            Dim("BOTTOM", (-9.5, -6), (-9.5, 6)),
            Dim("AT", (front, 10), (0, 10), 2),
            Dim("LONG", (back, 3), (front, 3), 0),
            Dim("WIDE", (-14, 14), (-11, 14), 2),
            *((Dim("FANGLE", (-5, 8)), Dim("CANGLE", (-18, 8))) if slanted else ()),
            *((Dim("PITCH", (-22, 14)),) if filled.n("COUNT") > 1 else ()),
        ),
    )


def _several(values: Values) -> bool:
    return number(values, "COUNT") > 1.0


GROOVE = Shape(
    "GROOVE",
    "one or more grooves on the outside, in a bore or with a rear tool, with "
    "chamfered edges and square or sloped walls",
    (
        tool_field(ToolKind.GROOVING),
        Field("SIDE", "SIDE", Kind.CHOICE, FRONT, (FRONT, REAR, INSIDE)),
        Field("TOP", "DIAMETER", Kind.DIAMETER, bar),
        Field("BOTTOM", "BOTTOM DIAMETER", Kind.DIAMETER),
        Field("AT", "DISTANCE FROM Z0 TO START", Kind.LENGTH, zero=True),
        BLADE_FIELD,
        Field("LONG", "GROOVE WIDTH", Kind.LENGTH, lambda v, _s: number(v, "WIDE") or None),
        CORNER_FIELD,
        Field("EDGE", "CHAMFER AT BOTH EDGES", Kind.LENGTH, 0.0, zero=True),
        Field("COUNT", "NUMBER OF GROOVES", Kind.COUNT, 1.0, most=1000),
        Field("PITCH", "PITCH", Kind.LENGTH, None, only=_several),
        Field("DWELL", "DWELL AT BOTTOM", Kind.SECONDS, 0.1, zero=True, most=60),
        Field("FANGLE", "SLOPE OF FACE-SIDE WALL", Kind.ANGLE, 0.0, most=80.0, zero=True),
        Field("CANGLE", "SLOPE OF CHUCK-SIDE WALL", Kind.ANGLE, 0.0, most=80.0, zero=True),
        Field("OVER", "DIAMETER TO CLEAR", Kind.DIAMETER, 0.0, zero=True),
        feed_field(Work.GROOVE),
        rpm_field(Work.GROOVE, around("TOP")),
    ),
    _groove,
    _groove_sketch,
    _groove_checks,
)


# --- SINUMERIK: CYCLE93 if the tool has two cutting edges


def _by_cycle(values: Values) -> bool:
    return number(values, "DN") > 0.0


def _sinumerik_groove(filled: Filled, setting: Setting, code: Code) -> None:
    if not _by_cycle(filled.values):
        _groove(filled, setting, code)
        return
    inside, top = filled.t("SIDE") == INSIDE, filled.n("TOP")
    free = -FREE[setting.metric] if inside else FREE[setting.metric]
    over, deep = (filled.n("OVER") or top) / 2.0 + free, abs(top - filled.n("BOTTOM")) / 2.0
    begin_spindle(filled, setting, code, over, None)
    code.rapid(z=Blade(filled, code).at(-filled.n("AT") - filled.n("LONG")))
    code.set_feed(filled.n("FEED"))
    across, width, depth, dwell = (figure(v) for v in (top, filled.n("LONG"), deep, filled.n("DWELL")))
    kind = "7" if inside else "5"
    for k in range(int(filled.n("COUNT"))):
        begin = figure(-filled.n("AT") - k * filled.n("PITCH"))
        words = (across, begin, width, depth, *[""] * 10, dwell, kind, "", figure(filled.n("DN")))
        code.write("CYCLE93(" + ", ".join(words) + ")")
    code.forget()
    if filled.n("OVER"):
        code.rapid(over)
    end_spindle(filled, code)


def _sinumerik_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from _groove_checks(filled, setting)
    if not _by_cycle(filled.values):
        return
    if filled.n("DN") == 1.0:
        yield Refusal(
            "DN",
            "D1 is the cutting corner of the blade: enter the D number of the other "
            "corner, or 0 to use G1 instead of CYCLE93.",
        )
    if filled.t("SIDE") == REAR:
        yield Refusal(
            "SIDE",
            "CYCLE93 does not support a tool at negative X: to use G1 instead, enter 0 as the D "
            "number of the other blade corner.",
        )
    if filled.n("EDGE"):
        yield Refusal(
            "EDGE",
            "CYCLE93 cannot chamfer these edges: enter 0 for the chamfer or, to use G1 instead, "
            "enter 0 as the D number of the other blade corner.",
        )
    if any(_slants(filled)):
        yield Refusal(
            "FANGLE",
            "CYCLE93 can cut only square walls in this shape: enter 0 for the slope or, to use "
            "G1 instead, enter 0 as the D number of the other blade corner.",
        )


SINUMERIK_GROOVE = replace(
    GROOVE,
    cut=_sinumerik_groove,
    checks=_sinumerik_checks,
    fields=(
        *GROOVE.fields,
        Field("DN", "CYCLE93: D OF OTHER CORNER", Kind.OFFSET, 0.0, most=9, zero=True),
    ),
)
"""The same; CYCLE93 takes the width of the blade from two cutting edges, of which the form sets none."""
