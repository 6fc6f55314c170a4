"""Proposals for a thread from its size and tool, and checks of the entered values."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.extras.shapes.common_fields import check_rpm
from core.extras.shapes.cutting_data import Operation, rpm
from core.extras.shapes.editor_shape import ShapeInstance
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ValueProposal,
    number,
    text,
)
from core.extras.shapes.threads.thread_series import (
    TAPERED_SERIES,
    ThreadLimits,
    ThreadSeries,
    calculate_thread_limits,
    convert_length,
    find_thread_size,
    get_flank_angle,
    get_pipe_thread_length,
    list_tolerance_classes,
)
from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolKind

OUTSIDE, INSIDE = "OUTSIDE", "BORE"
RIGHT, LEFT = "RIGHT", "LEFT"
YES, NO = "YES", "NO"
_MOST_RPM = 1000.0  # for a thread on a small lathe, because the axis must follow
_TURNS_BEFORE = 3.0  # revolutions of run-up if the acceleration of the axis is unknown
_TAPER = 1.0 / 16.0


def get_thread_series(values: FieldValues) -> ThreadSeries:
    """Return the thread series that the operator has chosen."""
    return ThreadSeries(text(values, "SERIES") or ThreadSeries.CUSTOM)


def find_thread_limits(values: FieldValues, settings: ProgramSettings) -> ThreadLimits | None:
    """Return the limits for the entered series, size and class, or None if they are unknown.

    The limits are in the unit of the series.
    """
    series, inside = get_thread_series(values), text(values, "SIDE") == INSIDE
    found = find_thread_size(series, text(values, "SIZE"))
    if found is None:
        return None
    shape = settings.tool(number(values, "T"))
    nose = shape.nose_radius / convert_length(1.0, series, is_metric=True) if shape is not None else 0.0
    allowed = list_tolerance_classes(series, is_inside=inside)
    chosen = text(values, "CLASS")
    if allowed and chosen not in allowed:
        return None
    return calculate_thread_limits(series, found, chosen, is_inside=inside, nose_radius=nose)


def make_diameter_proposal(limit_name: str) -> ValueProposal:
    """Return a function that proposes the standard crest or root diameter of a thread.

    ``limit_name`` is ``crest`` or ``root``.
    """

    def propose_diameter(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
        known = find_thread_limits(values, setting)
        if known is None:
            return None
        value = known.crest_diameter if limit_name == "crest" else known.root_diameter
        return round(
            convert_length(value, get_thread_series(values), is_metric=setting.metric),
            4 if not setting.metric else 3,
        )

    return propose_diameter


def propose_pitch(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose the pitch that the standard specifies for the thread size."""
    series = get_thread_series(values)
    found = find_thread_size(series, text(values, "SIZE"))
    if found is None:
        return None
    return round(convert_length(found.pitch, series, is_metric=settings.metric), 6)


def propose_tolerance_class(values: FieldValues, _settings: ProgramSettings) -> FieldValue | None:
    """Propose the usual tolerance class of the series."""
    allowed = list_tolerance_classes(get_thread_series(values), is_inside=text(values, "SIDE") == INSIDE)
    return allowed[0] if allowed else ""


def list_side_tolerance_classes(values: FieldValues) -> tuple[str, ...]:
    """Return the tolerance classes of the series for the chosen side, inside or outside."""
    return list_tolerance_classes(get_thread_series(values), is_inside=text(values, "SIDE") == INSIDE)


def has_standard_series(values: FieldValues) -> bool:
    """Return whether the thread belongs to a standard series and therefore has a size."""
    return get_thread_series(values) is not ThreadSeries.CUSTOM


def propose_thread_taper(values: FieldValues, _settings: ProgramSettings) -> FieldValue | None:
    """Propose the taper that the thread series specifies."""
    return _TAPER if get_thread_series(values) in TAPERED_SERIES else 0.0


def propose_thread_length(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose the thread length of a pipe thread."""
    series = get_thread_series(values)
    found = find_thread_size(series, text(values, "SIZE"))
    long = get_pipe_thread_length(series, found) if found is not None else 0.0
    return round(convert_length(long, series, is_metric=settings.metric), 3) if long else None


def propose_pass_count(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose a number of threading passes, from 4 for the finest to 16 for the coarsest pitch.

    Insert manufacturers recommend these numbers.
    """
    pitch = number(values, "PITCH") * settings.mm / 25.4
    return float(min(16, max(4, round(4 + 80 * pitch)))) if pitch else None


def find_flank_angle(values: FieldValues, settings: ProgramSettings) -> float:
    """Return the included flank angle of the thread in degrees.

    The angle is taken from the series, otherwise from the tool data. If both are unknown, it is 60 degrees.
    """
    shape = settings.tool(number(values, "T"))
    point = shape.point if shape is not None and shape.kind is ToolKind.THREADING else 0.0
    return get_flank_angle(get_thread_series(values)) or point or 60.0


def propose_infeed_angle(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose an infeed angle that is at least half a degree smaller than the flank angle.

    For a 60° thread, the result is 29°, as in the original control.
    """
    return math.ceil(find_flank_angle(values, settings) / 2.0) - 1.0


def propose_threading_rpm(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose a spindle speed at which the axis can follow the thread."""
    lead = number(values, "PITCH") * number(values, "STARTS")
    across = number(values, "CREST")
    if not lead or not across:
        return None
    most = min(rpm(Operation.THREAD, across, settings), _MOST_RPM)
    fastest = 60.0 * 25.4 / settings.mm / lead  # in/min that the axis reaches in a short run-up
    return max(10.0, 10.0 * math.floor(min(most, fastest) / 10.0))


def propose_run_up(values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Propose the run-up distance in which the axis reaches its feed rate, at least two pitches."""
    lead, turns = number(values, "PITCH") * number(values, "STARTS"), number(values, "RPM")
    if not lead or not turns:
        return None
    accel = settings.shop.max_acceleration_mm_s2 / settings.mm
    needed = (lead * turns / 60.0) ** 2 / accel if accel else _TURNS_BEFORE * lead
    return round(max(needed, 2.0 * number(values, "PITCH"), settings.near), 2 if not settings.metric else 1)


def calculate_thread_depth(filled_shape: ShapeInstance) -> float:
    """Return the depth of the thread per side."""
    return abs(filled_shape.get_number("CREST") - filled_shape.get_number("ROOT")) / 2.0


G35_LEAD_LIMITS_IN = (0.2, 1.0, 2.0)  # in/rev, largest lead without G35, with G35 and with G35F2


def check_thread(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield errors for a thread that is inconsistent or that the machine or the tool cannot cut."""
    inside = filled_shape.get_text("SIDE") == INSIDE
    crest, root, pitch = (
        filled_shape.get_number("CREST"),
        filled_shape.get_number("ROOT"),
        filled_shape.get_number("PITCH"),
    )
    if inside and root <= crest:
        yield FieldError(
            "ROOT",
            Message(
                "An internal thread is cut outward, so the diameter at the last pass, {root}, "
                "must be larger than the diameter before threading, {crest}.",
                root=f"{root:g}",
                crest=f"{crest:g}",
            ),
        )
    if not inside and root >= crest:
        yield FieldError(
            "ROOT",
            Message(
                "An external thread is cut inward, so the diameter at the last pass, {root}, "
                "must be smaller than the diameter before threading, {crest}.",
                root=f"{root:g}",
                crest=f"{crest:g}",
            ),
        )
    sharp = pitch / 2.0 / math.tan(math.radians(find_flank_angle(filled_shape.field_values, settings) / 2.0))
    if calculate_thread_depth(filled_shape) > 1.02 * sharp:
        yield FieldError(
            "ROOT",
            Message(
                "The thread is {filled} deep, but at a pitch of {pitch} its flanks meet at a "
                "depth of {sharp}. Check both diameters.",
                filled=f"{calculate_thread_depth(filled_shape):.4f}",
                pitch=f"{pitch:.5g}",
                sharp=f"{sharp:.4f}",
            ),
        )
    if settings.dialect is Dialect.OMNITURN:
        yield from _lead_checks(filled_shape, settings)
    pulls = filled_shape.get_text("PULL") == YES or filled_shape.shape.find_field("RELIEF") is None
    if not pulls:
        yield from _relief(filled_shape)
    yield from _flank_checks(filled_shape, settings)
    yield from _by_sheet(filled_shape, settings)
    yield from check_rpm(filled_shape, settings)


def _flank_checks(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield an error if the infeed angle is larger than the flank angle.

    A pass would then cut into the flank of the previous pass.
    """
    angle, flank = (
        filled_shape.get_number("INFEED"),
        find_flank_angle(filled_shape.field_values, settings) / 2.0,
    )
    if angle > flank + 1e-9:
        yield FieldError(
            "INFEED",
            Message(
                "An infeed angle of {angle}° is more than the flank angle of {flank}°, so the "
                "first passes would cut into the flank. Enter {limit} or less.",
                angle=f"{angle:g}",
                flank=f"{flank:g}",
                limit=f"{math.floor(flank):g}",
            ),
        )


def _lead_checks(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    lead = filled.get_number("PITCH") * filled.get_number("STARTS")
    inch = lead * setting.mm / 25.4
    if inch > G35_LEAD_LIMITS_IN[2]:
        yield FieldError(
            "PITCH",
            Message(
                "A lead of {lead} is more than the maximum that the control can cut, {coarse}.",
                lead=f"{lead:g}",
                coarse=f"{G35_LEAD_LIMITS_IN[2] / setting.mm * 25.4:g}",
            ),
        )
    speed = inch * filled.get_number("RPM")
    if speed > 300.0:
        slow = math.floor(300.0 / inch)
        yield FieldError(
            "RPM",
            Message(
                "At S{number} the axis needs {speed} in/min, but the axis limit is 300 in/min: "
                "enter S{slow} or less.",
                number=f"{filled.get_number('RPM'):g}",
                speed=f"{speed:.0f}",
                slow=slow,
            ),
        )


def _relief(filled_shape: ShapeInstance) -> Iterator[FieldError]:
    """Yield an error if a pass ends without a pull-out and there is no relief groove."""
    lead = filled_shape.get_number("PITCH") * filled_shape.get_number("STARTS")
    relief = filled_shape.get_number("RELIEF")
    if relief <= 0.0:
        text_ = (
            "Thread relief missing: the tool cuts a ring where it stops. Enter the relief width, "
            "or set pull-out to YES."
        )
        if filled_shape.get_text("PULL") != NO:  # a language without pull-out
            text_ = "Thread relief missing: the tool cuts a ring where it stops. Enter the relief width."
        yield FieldError("RELIEF", text_)
    elif relief < 1.5 * lead:
        yield FieldError(
            "RELIEF",
            Message(
                "A relief width of {relief} is less than {lead}, which is 1.5 times the lead.",
                relief=f"{relief:g}",
                lead=f"{1.5 * lead:.4g}",
            ),
        )


def _by_sheet(filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    shape, name = setting.tool(filled.get_number("T")), f"T{filled.get_number('T'):.0f}"
    if shape is None:
        return
    angle = find_flank_angle(filled.field_values, setting)
    if shape.kind is ToolKind.THREADING and shape.point and abs(shape.point - angle) > 0.5:
        words = Message(
            "{name} cuts a thread angle of {point}°, but this thread needs {angle}°: use another insert.",
            name=name,
            point=f"{shape.point:g}",
            angle=f"{angle:g}",
        )
        yield FieldError("T", words)
    if shape.pitch and abs(shape.pitch / setting.mm - filled.get_number("PITCH")) > 0.02 * filled.get_number(
        "PITCH"
    ):
        yield FieldError(
            "T",
            Message(
                "{name} is made for a pitch of {pitch}, not {needed}: use another insert.",
                name=name,
                pitch=f"{shape.pitch / setting.mm:.5g}",
                needed=f"{filled.get_number('PITCH'):.5g}",
            ),
        )
    if (
        filled.get_text("SIDE") == INSIDE
        and shape.diameter
        and shape.diameter / setting.mm > filled.get_number("CREST")
    ):
        yield FieldError(
            "T",
            Message(
                "The bar of {name} does not fit into a bore of {number}.",
                name=name,
                number=f"{filled.get_number('CREST'):g}",
            ),
        )


def check_thread_name(filled_shape: ShapeInstance, _settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield an error if the thread series does not contain the entered size or class.

    Without a standard size and class, no values can be proposed.
    """
    series, allowed = (
        get_thread_series(filled_shape.field_values),
        list_side_tolerance_classes(filled_shape.field_values),
    )
    size, tolerance = filled_shape.get_text("SIZE"), filled_shape.get_text("CLASS")
    if series is not ThreadSeries.CUSTOM and size and find_thread_size(series, size) is None:
        yield FieldError(
            "SIZE",
            Message(
                "{series} does not include size {size}: choose a size with the arrows.",
                series=series,
                size=size,
            ),
        )
    elif filled_shape.shape.find_field("CLASS") is not None and allowed and tolerance not in allowed:
        yield FieldError(
            "CLASS",
            Message(
                "CLASS {tolerance} is not valid: choose one of {allowed}.",
                tolerance=tolerance,
                allowed=", ".join(allowed),
            ),
        )


def find_coarse_feed_step(filled_shape: ShapeInstance, settings: ProgramSettings) -> float:
    """Return the axis resolution of the G35 or G35F2 code that a coarse lead requires.

    The result is in the program's unit. It is 0 if the lead requires neither code.
    """
    lead = filled_shape.get_number("PITCH") * max(1.0, filled_shape.get_number("STARTS")) * settings.mm / 25.4
    inch = 0.0 if lead <= G35_LEAD_LIMITS_IN[0] else 0.00025 if lead <= G35_LEAD_LIMITS_IN[1] else 0.0005
    return inch * 25.4 / settings.mm
