"""Threads by series, size and class, or by their figures: outside, in a bore, tapered, several starts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind
from core.shapes.code_lines import Code
from core.shapes.cutting_data import Work, rpm
from core.shapes.number_words import figure, plain, rounded_up
from core.shapes.shape import Filled, Shape
from core.shapes.shape_fields import Field, Kind, Proposal, Refusal, Value, Values, number, text
from core.shapes.shape_setting import Setting
from core.shapes.sketch import Dim, Sketch, cut, part, sketch
from core.shapes.thread_limits import Limits, angle_of, classes, in_unit, limits, pipe_length
from core.shapes.thread_series import TAPERED, Series, size_of
from core.shapes.usual_fields import MOST_RPM, too_fast, tool_field

OUTSIDE, INSIDE = "OUTSIDE", "BORE"
RIGHT, LEFT = "RIGHT", "LEFT"
YES, NO = "YES", "NO"
_MOST_RPM = 1000.0  # of a thread on a small lathe: the slide has to follow
_COARSE = (0.2, 1.0, 2.0)  # in/rev: without G35, under G35, under G35F2
_TURNS_BEFORE = 3.0  # of run-up, where nobody knows the slide's acceleration
_TAPER = 1.0 / 16.0


# --- what the standards say


def series_of(values: Values) -> Series:
    """The series that is chosen."""
    return Series(text(values, "SERIES") or Series.OWN)


def limits_of(values: Values, setting: Setting) -> Limits | None:
    """Limits by series, size and class in the unit of the series; None where they are not known."""
    series, inside = series_of(values), text(values, "SIDE") == INSIDE
    found = size_of(series, text(values, "SIZE"))
    if found is None:
        return None
    shape = setting.tool(number(values, "T"))
    nose = shape.nose_radius / in_unit(1.0, series, metric=True) if shape is not None else 0.0
    allowed = classes(series, inside=inside)
    chosen = text(values, "CLASS")
    if allowed and chosen not in allowed:
        return None
    return limits(series, found, chosen, inside=inside, nose=nose)


def _from_limits(of: str) -> Proposal:
    def proposed(values: Values, setting: Setting) -> Value | None:
        known = limits_of(values, setting)
        if known is None:
            return None
        value = known.crest if of == "crest" else known.root
        return round(in_unit(value, series_of(values), metric=setting.metric), 4 if not setting.metric else 3)

    return proposed


def _pitch(values: Values, setting: Setting) -> Value | None:
    series = series_of(values)
    found = size_of(series, text(values, "SIZE"))
    if found is None:
        return None
    return round(in_unit(found.pitch, series, metric=setting.metric), 6)


def _class(values: Values, _setting: Setting) -> Value | None:
    allowed = classes(series_of(values), inside=text(values, "SIDE") == INSIDE)
    return allowed[0] if allowed else ""


def class_choices(values: Values) -> tuple[str, ...]:
    """The classes that this series has on this side."""
    return classes(series_of(values), inside=text(values, "SIDE") == INSIDE)


def _named(values: Values) -> bool:
    return series_of(values) is not Series.OWN


def _taper(values: Values, _setting: Setting) -> Value | None:
    return _TAPER if series_of(values) in TAPERED else 0.0


def _long(values: Values, setting: Setting) -> Value | None:
    series = series_of(values)
    found = size_of(series, text(values, "SIZE"))
    long = pipe_length(series, found) if found is not None else 0.0
    return round(in_unit(long, series, metric=setting.metric), 3) if long else None


def _passes(values: Values, setting: Setting) -> Value | None:
    """As makers of inserts have it: by pitch, four for the finest and sixteen for the coarsest."""
    pitch = number(values, "PITCH") * setting.mm / 25.4
    return float(min(16, max(4, round(4 + 80 * pitch)))) if pitch else None


def flank_angle(values: Values, setting: Setting) -> float:
    """Between both flanks, by the series; of a thread of its own figures by the sheet of its tool."""
    shape = setting.tool(number(values, "T"))
    point = shape.point if shape is not None and shape.kind is ToolKind.THREADING else 0.0
    return angle_of(series_of(values)) or point or 60.0


def _infeed(values: Values, setting: Setting) -> Value | None:
    """Along a flank, less half a degree at least: 29 of 60°, as the control has it by itself."""
    return math.ceil(flank_angle(values, setting) / 2.0) - 1.0


def _rpm(values: Values, setting: Setting) -> Value | None:
    lead = number(values, "PITCH") * number(values, "STARTS")
    across = number(values, "CREST")
    if not lead or not across:
        return None
    most = min(rpm(Work.THREAD, across, setting), _MOST_RPM)
    fastest = 60.0 * 25.4 / setting.mm / lead  # in/min that a slide reaches in a short run-up
    return max(10.0, 10.0 * math.floor(min(most, fastest) / 10.0))


def _run_up(values: Values, setting: Setting) -> Value | None:
    """What the slide needs to reach the lead, twice, and never less than two pitches."""
    lead, turns = number(values, "PITCH") * number(values, "STARTS"), number(values, "RPM")
    if not lead or not turns:
        return None
    accel = setting.shop.slide_accel / setting.mm
    needed = (lead * turns / 60.0) ** 2 / accel if accel else _TURNS_BEFORE * lead
    return round(max(needed, 2.0 * number(values, "PITCH"), setting.near), 2 if not setting.metric else 1)


# --- lines


def first_depth(filled: Filled) -> float:
    """Per side: constant chip area, so the depth of N passes over the root of N."""
    return filled_depth(filled) / math.sqrt(max(1.0, filled.n("PASSES")))


def first_word(filled: Filled, setting: Setting) -> float:
    """The same as it is written."""
    deep, coarse = first_depth(filled), _coarse_step(filled, setting)
    return math.ceil(deep / coarse - 1e-6) * coarse if coarse else rounded_up(deep, metric=setting.metric)


def filled_depth(filled: Filled) -> float:
    """Of the thread, per side."""
    return abs(filled.n("CREST") - filled.n("ROOT")) / 2.0


def _cycle97(filled: Filled, _setting: Setting, code: Code) -> None:
    """It stops where the thread ends, so it needs a relief there."""
    crest, far = filled.n("CREST"), _far(filled)
    turns = "M04" if filled.t("HAND") == LEFT else "M03"
    inside = filled.t("SIDE") == INSIDE
    code.begin(filled.n("T"), filled.n("RPM"), 0.0 if inside else max(crest, far) / 2.0, None, turns)
    code.rapid(z=filled.n("RUNUP") - filled.n("AT"))
    write_cycle97(filled, code)
    code.away()


def _far(filled: Filled) -> float:
    """The diameter before it is cut where a tapered thread ends."""
    outwards = -1.0 if filled.t("SIDE") == INSIDE else 1.0
    return filled.n("CREST") + outwards * filled.n("TAPER") * filled.n("LONG")


def write_cycle97(filled: Filled, code: Code) -> None:
    """CYCLE97 in passes of equal chip."""
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
    near = partial(_on_step, step=_coarse_step(filled, setting))
    starts = max(1, int(filled.n("STARTS")))
    lead, first = filled.n("PITCH") * starts, first_word(filled, setting)
    begin, end = filled.n("RUNUP") - filled.n("AT"), -(filled.n("AT") + filled.n("LONG"))
    taper = filled.n("TAPER") / 2.0  # of the radius
    down = -outwards * taper * filled.n("RUNUP")  # at the start of a pass
    crest, root = filled.n("CREST") / 2.0 + down, filled.n("ROOT") / 2.0 + down
    at, root, begin, end = near(crest - outwards * first), near(root), near(begin), near(end)
    turns = "M04" if filled.t("HAND") == LEFT else "M03"
    clear = near(at + outwards * 3.0 * first)
    code.begin(filled.n("T"), filled.n("RPM"), clear, begin, turns)
    coarse = lead * setting.mm / 25.4 > _COARSE[0]
    for k in range(starts):
        start_z = near(begin + k * filled.n("PITCH"))
        on_cone = -outwards * taper * k * filled.n("PITCH")  # the same cone, begun farther away
        code.rapid(near(at + on_cone), start_z if k else None)
        if coarse and k == 0:
            f2 = "F2" if lead * setting.mm / 25.4 > _COARSE[1] else ""
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
    """What it is measured by, and the cone that is turned or bored before a tapered one."""
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


def _coarse_step(filled: Filled, setting: Setting) -> float:
    """Of the slide, in the unit of the program, under the G35 or G35F2 that a lead needs; 0 without."""
    lead = filled.n("PITCH") * max(1.0, filled.n("STARTS")) * setting.mm / 25.4
    inch = 0.0 if lead <= _COARSE[0] else 0.00025 if lead <= _COARSE[1] else 0.0005
    return inch * 25.4 / setting.mm


def _on_step(value: float, step: float) -> float:
    return round(value / step) * step if step else value


def _checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    inside = filled.t("SIDE") == INSIDE
    crest, root, pitch = filled.n("CREST"), filled.n("ROOT"), filled.n("PITCH")
    if inside and root <= crest:
        yield Refusal(
            "ROOT",
            Message(
                "An internal thread is cut outward, so the diameter at the last pass, {root}, "
                "must be larger than the diameter before threading, {crest}.",
                root=f"{root:g}",
                crest=f"{crest:g}",
            ),
        )
    if not inside and root >= crest:
        yield Refusal(
            "ROOT",
            Message(
                "An external thread is cut inward, so the diameter at the last pass, {root}, "
                "must be smaller than the diameter before threading, {crest}.",
                root=f"{root:g}",
                crest=f"{crest:g}",
            ),
        )
    sharp = pitch / 2.0 / math.tan(math.radians(flank_angle(filled.values, setting) / 2.0))
    if filled_depth(filled) > 1.02 * sharp:
        yield Refusal(
            "ROOT",
            Message(
                "The thread is {filled} deep, but at a pitch of {pitch} its flanks meet at a "
                "depth of {sharp}. Check both diameters.",
                filled=f"{filled_depth(filled):.4f}",
                pitch=f"{pitch:.5g}",
                sharp=f"{sharp:.4f}",
            ),
        )
    if setting.dialect is Dialect.OMNITURN:
        yield from _lead_checks(filled, setting)
    pulls = filled.t("PULL") == YES or filled.shape.field("RELIEF") is None
    if not pulls:
        yield from _relief(filled)
    yield from _flank_checks(filled, setting)
    yield from _by_sheet(filled, setting)
    yield from too_fast(filled, setting)


def _flank_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """Passes that come in flatter than the flank cut away what the last one leaves."""
    angle, flank = filled.n("INFEED"), flank_angle(filled.values, setting) / 2.0
    if angle > flank + 1e-9:
        yield Refusal(
            "INFEED",
            Message(
                "An infeed angle of {angle}° is more than the flank angle of {flank}°, so the "
                "first passes would cut into the flank. Enter {limit} or less.",
                angle=f"{angle:g}",
                flank=f"{flank:g}",
                limit=f"{math.floor(flank):g}",
            ),
        )


def _lead_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    lead = filled.n("PITCH") * filled.n("STARTS")
    inch = lead * setting.mm / 25.4
    if inch > _COARSE[2]:
        yield Refusal(
            "PITCH",
            Message(
                "A lead of {lead} is more than the maximum that the control can cut, {coarse}.",
                lead=f"{lead:g}",
                coarse=f"{_COARSE[2] / setting.mm * 25.4:g}",
            ),
        )
    speed = inch * filled.n("RPM")
    if speed > 300.0:
        slow = math.floor(300.0 / inch)
        yield Refusal(
            "RPM",
            Message(
                "At S{number} the axis needs {speed} in/min, but the axis limit is 300 in/min: "
                "enter S{slow} or less.",
                number=f"{filled.n('RPM'):g}",
                speed=f"{speed:.0f}",
                slow=slow,
            ),
        )


def _relief(filled: Filled) -> Iterator[Refusal]:
    """A pass that ends without pulling out while it goes on needs a groove to end in."""
    lead = filled.n("PITCH") * filled.n("STARTS")
    relief = filled.n("RELIEF")
    if relief <= 0.0:
        text_ = (
            "Thread relief missing: the tool cuts a ring where it stops. Enter the relief width, "
            "or set pull-out to YES."
        )
        if filled.t("PULL") != NO:  # of a language in which no pass pulls out
            text_ = "Thread relief missing: the tool cuts a ring where it stops. Enter the relief width."
        yield Refusal("RELIEF", text_)
    elif relief < 1.5 * lead:
        yield Refusal(
            "RELIEF",
            Message(
                "A relief width of {relief} is less than {lead}, which is 1.5 times the lead.",
                relief=f"{relief:g}",
                lead=f"{1.5 * lead:.4g}",
            ),
        )


def _by_sheet(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    shape, name = setting.tool(filled.n("T")), f"T{filled.n('T'):.0f}"
    if shape is None:
        return
    angle = flank_angle(filled.values, setting)
    if shape.kind is ToolKind.THREADING and shape.point and abs(shape.point - angle) > 0.5:
        words = Message(
            "{name} cuts a thread angle of {point}°, but this thread needs {angle}°: use another insert.",
            name=name,
            point=f"{shape.point:g}",
            angle=f"{angle:g}",
        )
        yield Refusal("T", words)
    if shape.pitch and abs(shape.pitch / setting.mm - filled.n("PITCH")) > 0.02 * filled.n("PITCH"):
        yield Refusal(
            "T",
            Message(
                "{name} is made for a pitch of {pitch}, not {needed}: use another insert.",
                name=name,
                pitch=f"{shape.pitch / setting.mm:.5g}",
                needed=f"{filled.n('PITCH'):.5g}",
            ),
        )
    if filled.t("SIDE") == INSIDE and shape.diameter and shape.diameter / setting.mm > filled.n("CREST"):
        yield Refusal(
            "T",
            Message(
                "The bar of {name} does not fit into a bore of {number}.",
                name=name,
                number=f"{filled.n('CREST'):g}",
            ),
        )


def unknown_name(filled: Filled, _setting: Setting) -> Iterator[Refusal]:
    """A size or a class that the series has not: nothing is proposed then."""
    series, allowed = series_of(filled.values), class_choices(filled.values)
    size, tolerance = filled.t("SIZE"), filled.t("CLASS")
    if series is not Series.OWN and size and size_of(series, size) is None:
        yield Refusal(
            "SIZE",
            Message(
                "{series} does not include size {size}: choose a size with the arrows.",
                series=series,
                size=size,
            ),
        )
    elif filled.shape.field("CLASS") is not None and allowed and tolerance not in allowed:
        yield Refusal(
            "CLASS",
            Message(
                "CLASS {tolerance} is not valid: choose one of {allowed}.",
                tolerance=tolerance,
                allowed=", ".join(allowed),
            ),
        )


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
        Field("SIZE", "SIZE", Kind.NAME, None, only=_named),
        Field("SIDE", "SIDE", Kind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        Field("CLASS", "CLASS", Kind.CHOICE, _class, _ALL_CLASSES, only=lambda v: bool(class_choices(v))),
        Field("LONG", "LENGTH", Kind.LENGTH, _long),
        Field("AT", "DISTANCE FROM Z0 TO START", Kind.LENGTH, 0.0, zero=True),
        Field("PULL", "PULL OUT WHILE FEEDING", Kind.CHOICE, YES, (YES, NO)),
        Field("RELIEF", "RELIEF WIDTH", Kind.LENGTH, 0.0, zero=True, only=lambda v: text(v, "PULL") == NO),
        Field("PITCH", "PITCH", Kind.LENGTH, _pitch),
        Field("STARTS", "STARTS", Kind.COUNT, 1.0, most=24),
        Field("HAND", "HAND", Kind.CHOICE, RIGHT, (RIGHT, LEFT)),
        Field("CREST", "DIAMETER BEFORE THREADING", Kind.DIAMETER, _from_limits("crest")),
        Field("ROOT", "DIAMETER AT LAST PASS", Kind.DIAMETER, _from_limits("root")),
        Field("TAPER", "TAPER ON THE DIAMETER", Kind.RATIO, _taper, zero=True, most=1.0),
        Field("PASSES", "PASSES", Kind.COUNT, _passes, most=60),
        Field("INFEED", "INFEED ANGLE", Kind.ANGLE, _infeed, most=30.0, zero=True),
        Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, _rpm, most=MOST_RPM),
        Field("RUNUP", "RUN-UP", Kind.LENGTH, _run_up),
    ),
    _thread,
    _sketch,
    _checks,
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
