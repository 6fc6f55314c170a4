"""Proposals for a thread from its size and tool, and checks of its values."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.extras.shapes.cutting_data import Work, rpm
from core.extras.shapes.shape import Filled
from core.extras.shapes.shape_fields import Proposal, Refusal, Setting, Value, Values, number, text
from core.extras.shapes.threads.thread_series import (
    TAPERED,
    Limits,
    Series,
    angle_of,
    classes,
    in_unit,
    limits,
    pipe_length,
    size_of,
)
from core.extras.shapes.usual_fields import too_fast
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind

OUTSIDE, INSIDE = "OUTSIDE", "BORE"
RIGHT, LEFT = "RIGHT", "LEFT"
YES, NO = "YES", "NO"
_MOST_RPM = 1000.0  # for a thread on a small lathe, because the axis must follow
_TURNS_BEFORE = 3.0  # revolutions of run-up if the acceleration of the axis is unknown
_TAPER = 1.0 / 16.0


def series_of(values: Values) -> Series:
    """Return the chosen series."""
    return Series(text(values, "SERIES") or Series.OWN)


def limits_of(values: Values, setting: Setting) -> Limits | None:
    """Return the limits by series, size and class in the unit of the series; None if they are unknown."""
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


def from_limits(of: str) -> Proposal:
    """Return a proposal for a diameter of the standard; ``of`` is crest or root."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        known = limits_of(values, setting)
        if known is None:
            return None
        value = known.crest if of == "crest" else known.root
        return round(in_unit(value, series_of(values), metric=setting.metric), 4 if not setting.metric else 3)

    return proposed


def proposed_pitch(values: Values, setting: Setting) -> Value | None:
    """Propose the pitch of the thread size."""
    series = series_of(values)
    found = size_of(series, text(values, "SIZE"))
    if found is None:
        return None
    return round(in_unit(found.pitch, series, metric=setting.metric), 6)


def proposed_class(values: Values, _setting: Setting) -> Value | None:
    """Propose the usual class of the series."""
    allowed = classes(series_of(values), inside=text(values, "SIDE") == INSIDE)
    return allowed[0] if allowed else ""


def class_choices(values: Values) -> tuple[str, ...]:
    """Return the classes of this series for the chosen side."""
    return classes(series_of(values), inside=text(values, "SIDE") == INSIDE)


def is_named(values: Values) -> bool:
    """Return whether the thread has a standard series and therefore a size."""
    return series_of(values) is not Series.OWN


def proposed_taper(values: Values, _setting: Setting) -> Value | None:
    """Propose the taper of the series."""
    return _TAPER if series_of(values) in TAPERED else 0.0


def proposed_length(values: Values, setting: Setting) -> Value | None:
    """Propose the length of a pipe thread."""
    series = series_of(values)
    found = size_of(series, text(values, "SIZE"))
    long = pipe_length(series, found) if found is not None else 0.0
    return round(in_unit(long, series, metric=setting.metric), 3) if long else None


def proposed_passes(values: Values, setting: Setting) -> Value | None:
    """Propose the number of passes by pitch, from 4 for the finest to 16 for the coarsest.

    Insert makers recommend these numbers.
    """
    pitch = number(values, "PITCH") * setting.mm / 25.4
    return float(min(16, max(4, round(4 + 80 * pitch)))) if pitch else None


def flank_angle(values: Values, setting: Setting) -> float:
    """Return the included angle of the flanks from the series, from the tool data, or 60 degrees."""
    shape = setting.tool(number(values, "T"))
    point = shape.point if shape is not None and shape.kind is ToolKind.THREADING else 0.0
    return angle_of(series_of(values)) or point or 60.0


def proposed_infeed(values: Values, setting: Setting) -> Value | None:
    """Propose an infeed angle at least half a degree less than the flank: 29 for 60°, as in the control."""
    return math.ceil(flank_angle(values, setting) / 2.0) - 1.0


def proposed_rpm(values: Values, setting: Setting) -> Value | None:
    """Propose a speed that the axis can follow."""
    lead = number(values, "PITCH") * number(values, "STARTS")
    across = number(values, "CREST")
    if not lead or not across:
        return None
    most = min(rpm(Work.THREAD, across, setting), _MOST_RPM)
    fastest = 60.0 * 25.4 / setting.mm / lead  # in/min that the axis reaches in a short run-up
    return max(10.0, 10.0 * math.floor(min(most, fastest) / 10.0))


def proposed_run_up(values: Values, setting: Setting) -> Value | None:
    """Propose the distance that the axis needs to reach the lead, at least two pitches."""
    lead, turns = number(values, "PITCH") * number(values, "STARTS"), number(values, "RPM")
    if not lead or not turns:
        return None
    accel = setting.shop.slide_accel / setting.mm
    needed = (lead * turns / 60.0) ** 2 / accel if accel else _TURNS_BEFORE * lead
    return round(max(needed, 2.0 * number(values, "PITCH"), setting.near), 2 if not setting.metric else 1)


def filled_depth(filled: Filled) -> float:
    """Return the depth of the thread per side."""
    return abs(filled.n("CREST") - filled.n("ROOT")) / 2.0


COARSE = (0.2, 1.0, 2.0)  # in/rev, largest lead without G35, with G35 and with G35F2


def thread_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """Yield the errors of a thread: its dimensions, the machine's limits and the tool."""
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
    """Yield an error if the infeed is flatter than the flank.

    Passes would then cut into the flank that the previous pass has left.
    """
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
    if inch > COARSE[2]:
        yield Refusal(
            "PITCH",
            Message(
                "A lead of {lead} is more than the maximum that the control can cut, {coarse}.",
                lead=f"{lead:g}",
                coarse=f"{COARSE[2] / setting.mm * 25.4:g}",
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
    """Yield an error if a pass that ends without pulling out has no relief groove."""
    lead = filled.n("PITCH") * filled.n("STARTS")
    relief = filled.n("RELIEF")
    if relief <= 0.0:
        text_ = (
            "Thread relief missing: the tool cuts a ring where it stops. Enter the relief width, "
            "or set pull-out to YES."
        )
        if filled.t("PULL") != NO:  # a language without pull-out
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
    """Yield an error if the series does not have this size or class; no values are then proposed."""
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


def coarse_step(filled: Filled, setting: Setting) -> float:
    """Return the step of the axis under the G35 or G35F2 that a lead requires, or 0.

    The step is in the unit of the program.
    """
    lead = filled.n("PITCH") * max(1.0, filled.n("STARTS")) * setting.mm / 25.4
    inch = 0.0 if lead <= COARSE[0] else 0.00025 if lead <= COARSE[1] else 0.0005
    return inch * 25.4 / setting.mm
