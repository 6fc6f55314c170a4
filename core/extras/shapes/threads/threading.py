"""Threads by series, size and class or by dimensions: outside, in a bore, tapered, multi-start."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

from core.extras.shapes.lines.code_lines import Code, figure, plain, rounded_up
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Setting, text
from core.extras.shapes.threads.thread_series import TAPERED, Series, classes, in_unit
from core.extras.shapes.threads.thread_values import (
    COARSE,
    INSIDE,
    LEFT,
    NO,
    OUTSIDE,
    RIGHT,
    YES,
    class_choices,
    coarse_step,
    filled_depth,
    from_limits,
    is_named,
    limits_of,
    proposed_class,
    proposed_infeed,
    proposed_length,
    proposed_passes,
    proposed_pitch,
    proposed_rpm,
    proposed_run_up,
    proposed_taper,
    series_of,
    thread_checks,
    unknown_name,
)
from core.extras.shapes.usual_fields import MOST_RPM, tool_field
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dim, Sketch, cut, part, sketch


def first_depth(filled: Filled) -> float:
    """Return the depth of the first pass per side for a constant chip area: the depth divided by √N."""
    return filled_depth(filled) / math.sqrt(max(1.0, filled.n("PASSES")))


def first_word(filled: Filled, setting: Setting) -> float:
    """Return the depth of the first pass, rounded up to the step of its word."""
    deep, coarse = first_depth(filled), coarse_step(filled, setting)
    return math.ceil(deep / coarse - 1e-6) * coarse if coarse else rounded_up(deep, metric=setting.metric)


def _cycle97(filled: Filled, _setting: Setting, code: Code) -> None:
    """Write a thread with CYCLE97, which stops at the end of the thread and therefore needs a relief."""
    crest, far = filled.n("CREST"), _far(filled)
    turns = "M04" if filled.t("HAND") == LEFT else "M03"
    inside = filled.t("SIDE") == INSIDE
    code.begin(filled.n("T"), filled.n("RPM"), 0.0 if inside else max(crest, far) / 2.0, None, turns)
    code.rapid(z=filled.n("RUNUP") - filled.n("AT"))
    write_cycle97(filled, code)
    code.away()


def _far(filled: Filled) -> float:
    """Return the diameter before threading at the far end of a tapered thread."""
    outwards = -1.0 if filled.t("SIDE") == INSIDE else 1.0
    return filled.n("CREST") + outwards * filled.n("TAPER") * filled.n("LONG")


def write_cycle97(filled: Filled, code: Code) -> None:
    """Write CYCLE97 with passes of equal chip area."""
    starts = max(1.0, filled.n("STARTS"))
    begin, end = -filled.n("AT"), -(filled.n("AT") + filled.n("LONG"))
    ends = (begin, end, filled.n("CREST"), _far(filled), filled.n("RUNUP"), 0.0)
    depth, angle, passes = filled_depth(filled), filled.n("INFEED"), math.ceil(filled.n("PASSES") - 1e-6)
    kind = 4.0 if filled.t("SIDE") == INSIDE else 3.0
    figures = (*ends, depth, 0.0, angle, 0.0, passes, 0.0, kind, starts)
    words = (figure(filled.n("PITCH") * starts, 6), "", *map(figure, figures))
    code.write(f"CYCLE97({', '.join(words)})")
    code.forget()


def _thread(filled: Filled, setting: Setting, code: Code) -> None:
    inside = filled.t("SIDE") == INSIDE
    outwards = -1.0 if inside else 1.0
    near = partial(_on_step, step=coarse_step(filled, setting))
    starts = max(1, int(filled.n("STARTS")))
    lead, first = filled.n("PITCH") * starts, first_word(filled, setting)
    begin, end = filled.n("RUNUP") - filled.n("AT"), -(filled.n("AT") + filled.n("LONG"))
    taper = filled.n("TAPER") / 2.0  # taper of the radius
    down = -outwards * taper * filled.n("RUNUP")  # radius change at the start of a pass
    crest, root = filled.n("CREST") / 2.0 + down, filled.n("ROOT") / 2.0 + down
    at, root, begin, end = near(crest - outwards * first), near(root), near(begin), near(end)
    turns = "M04" if filled.t("HAND") == LEFT else "M03"
    clear = near(at + outwards * 3.0 * first)
    code.begin(filled.n("T"), filled.n("RPM"), clear, begin, turns)
    coarse = lead * setting.mm / 25.4 > COARSE[0]
    for k in range(starts):
        start_z = near(begin + k * filled.n("PITCH"))
        on_cone = -outwards * taper * k * filled.n("PITCH")  # the same cone, started farther away
        code.rapid(near(at + on_cone), start_z if k else None)
        if coarse and k == 0:
            f2 = "F2" if lead * setting.mm / 25.4 > COARSE[1] else ""
            code.write(f"G35{f2}", f"G92{code.point(at, start_z)}")
        words = f"G33{code.x(near(root + on_cone))}{code.z(end)}{code.x(first, 'I')}K{plain(lead, 6)}"
        if taper:
            far = (begin + k * filled.n("PITCH") - end) * taper * outwards
            words += code.x(far, "A")
        words += "P" if filled.t("PULL") == YES else ""
        words += (
            ""
            if not filled.n("INFEED")
            else "C"
            if filled.n("INFEED") == 29.0
            else f"C{plain(filled.n('INFEED'))}"
        )
        code.write(words)
    if coarse:
        if starts > 1:
            code.rapid(z=begin)
        code.write("G36", f"G92{code.point(at, begin)}")
    code.forget()
    code.rapid(clear)
    code.away()


def _says(filled: Filled, setting: Setting) -> tuple[str, ...]:
    """Return notes about the measured diameters, and about the cone to be cut before a tapered thread."""
    known = limits_of(filled.values, setting)
    if known is None:
        return ()
    places = 3 if setting.metric else 4
    unit = in_unit(1.0, series_of(filled.values), metric=setting.metric)
    inside = filled.t("SIDE") == INSIDE
    pairs = (known.minor if inside else known.major, known.pitch)
    least, most, low, high = (plain(value * unit, places) for pair in pairs for value in pair)
    if series_of(filled.values) in TAPERED:
        far = plain(_far(filled), places)
        return (
            Message("pitch diameter {low} at the start of the thread", low=low),
            (
                Message(
                    "taper before threading: diameter {number} at the start, {distance} at the end",
                    number=plain(filled.n("CREST"), places),
                    distance=far,
                )
            ),
        )
    if inside:
        return (
            Message(
                "minor diameter {minimum} to {maximum}, pitch diameter {low} to {high}",
                minimum=least,
                maximum=most,
                low=low,
                high=high,
            ),
        )
    return (
        Message(
            "major diameter {minimum} to {maximum}, pitch diameter {low} to {high}",
            minimum=least,
            maximum=most,
            low=low,
            high=high,
        ),
    )


def _on_step(value: float, step: float) -> float:
    return round(value / step) * step if step else value


def _sketch(filled: Filled) -> Sketch:
    teeth: list[tuple[float, float]] = [(0.0, 6.6)]
    for k in range(7):
        teeth += [(-1.0 - 2 * k, 8.0), (-2.0 - 2 * k, 6.6)]
    relief = (
        [(-14.0, 6.0), (-17.0, 6.0), (-17.0, 10.0)]
        if filled.n("RELIEF")
        else [(-14.6, 8.0), (-17, 8.0), (-17, 10)]
    )
    inside = filled.t("SIDE") == INSIDE
    solid = (
        part((0, 0), *teeth, *relief, (-24, 10), (-24, 0))
        if not inside
        else part((0, 13), (0, 8), *((z, 14.6 - r) for z, r in teeth[1:]), (-15, 6.6), (-24, 6.6), (-24, 13))
    )
    crest, root = (6.6, 8.0) if inside else (8.0, 6.6)
    return sketch(
        solid,
        cut(*(teeth if not inside else [(z, 14.6 - r) for z, r in teeth])),
        dims=(
            Dim("CREST", (-5, -crest), (-5, crest)),
            Dim("ROOT", (-10, -root), (-10, root)),
            Dim("LONG", (-14, 13), (0, 13), 2),
            Dim("RUNUP", (0, 13), (5, 13), 2),
            Dim("PITCH", (-3, 9.6)),
            Dim("SIZE", (-19, 4)),
            *((Dim("RELIEF", (-15.5, 4.5)),) if filled.n("RELIEF") else ()),
        ),
    )


_ALL_CLASSES = tuple(
    dict.fromkeys(c for s in Series for inside in (False, True) for c in classes(s, inside=inside))
)

THREAD = Shape(
    "THREAD",
    "a thread defined by series, size and class (UNC, UNF, M, NPT, BSP, ACME) or by custom dimensions",
    (
        tool_field(ToolKind.THREADING),
        Field("SERIES", "SERIES", Kind.CHOICE, Series.UNC.value, tuple(each.value for each in Series)),
        Field("SIZE", "SIZE", Kind.NAME, None, only=is_named),
        Field("SIDE", "SIDE", Kind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        Field(
            "CLASS", "CLASS", Kind.CHOICE, proposed_class, _ALL_CLASSES, only=lambda v: bool(class_choices(v))
        ),
        Field("LONG", "LENGTH", Kind.LENGTH, proposed_length),
        Field("AT", "DISTANCE FROM Z0 TO START", Kind.LENGTH, 0.0, zero=True),
        Field("PULL", "PULL OUT WHILE FEEDING", Kind.CHOICE, YES, (YES, NO)),
        Field("RELIEF", "RELIEF WIDTH", Kind.LENGTH, 0.0, zero=True, only=lambda v: text(v, "PULL") == NO),
        Field("PITCH", "PITCH", Kind.LENGTH, proposed_pitch),
        Field("STARTS", "STARTS", Kind.COUNT, 1.0, most=24),
        Field("HAND", "HAND", Kind.CHOICE, RIGHT, (RIGHT, LEFT)),
        Field("CREST", "DIAMETER BEFORE THREADING", Kind.DIAMETER, from_limits("crest")),
        Field("ROOT", "DIAMETER AT LAST PASS", Kind.DIAMETER, from_limits("root")),
        Field("TAPER", "TAPER ON THE DIAMETER", Kind.RATIO, proposed_taper, zero=True, most=1.0),
        Field("PASSES", "PASSES", Kind.COUNT, proposed_passes, most=60),
        Field("INFEED", "INFEED ANGLE", Kind.ANGLE, proposed_infeed, most=30.0, zero=True),
        Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, proposed_rpm, most=MOST_RPM),
        Field("RUNUP", "RUN-UP", Kind.LENGTH, proposed_run_up),
    ),
    _thread,
    _sketch,
    thread_checks,
    first=unknown_name,
    says=_says,
)


def _of_cycle97(each: Field) -> Field:
    return replace(each, only=lambda _values: True) if each.word == "RELIEF" else each


SINUMERIK_THREAD = replace(
    THREAD,
    cut=_cycle97,
    fields=tuple(_of_cycle97(each) for each in THREAD.fields if each.word != "PULL"),
)
"""The same by CYCLE97, which does not pull out while it goes on."""
