"""What is proposed for a thread by its series, size and class, by its tool and by the machine."""

from __future__ import annotations

import math

from core.extras.shapes.cutting_data import Work, rpm
from core.extras.shapes.shape import Filled
from core.extras.shapes.shape_fields import Proposal, Value, Values, number, text
from core.extras.shapes.shape_setting import Setting
from core.extras.shapes.threads.thread_limits import Limits, angle_of, classes, in_unit, limits, pipe_length
from core.extras.shapes.threads.thread_series import TAPERED, Series, size_of
from core.part.tool_shape import ToolKind

OUTSIDE, INSIDE = "OUTSIDE", "BORE"
RIGHT, LEFT = "RIGHT", "LEFT"
YES, NO = "YES", "NO"
_MOST_RPM = 1000.0  # of a thread on a small lathe: the slide has to follow
_TURNS_BEFORE = 3.0  # of run-up, where nobody knows the slide's acceleration
_TAPER = 1.0 / 16.0


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


def from_limits(of: str) -> Proposal:
    """Propose a diameter by the standard: ``of`` is crest or root."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        known = limits_of(values, setting)
        if known is None:
            return None
        value = known.crest if of == "crest" else known.root
        return round(in_unit(value, series_of(values), metric=setting.metric), 4 if not setting.metric else 3)

    return proposed


def proposed_pitch(values: Values, setting: Setting) -> Value | None:
    """Propose the pitch of the size."""
    series = series_of(values)
    found = size_of(series, text(values, "SIZE"))
    if found is None:
        return None
    return round(in_unit(found.pitch, series, metric=setting.metric), 6)


def proposed_class(values: Values, _setting: Setting) -> Value | None:
    """Propose the first class of the series."""
    allowed = classes(series_of(values), inside=text(values, "SIDE") == INSIDE)
    return allowed[0] if allowed else ""


def class_choices(values: Values) -> tuple[str, ...]:
    """The classes that this series has on this side."""
    return classes(series_of(values), inside=text(values, "SIDE") == INSIDE)


def is_named(values: Values) -> bool:
    """Return whether the thread has a series, and so a size."""
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
    """As makers of inserts have it: by pitch, four for the finest and sixteen for the coarsest."""
    pitch = number(values, "PITCH") * setting.mm / 25.4
    return float(min(16, max(4, round(4 + 80 * pitch)))) if pitch else None


def flank_angle(values: Values, setting: Setting) -> float:
    """Between both flanks, by the series; of a thread of its own figures by the sheet of its tool."""
    shape = setting.tool(number(values, "T"))
    point = shape.point if shape is not None and shape.kind is ToolKind.THREADING else 0.0
    return angle_of(series_of(values)) or point or 60.0


def proposed_infeed(values: Values, setting: Setting) -> Value | None:
    """Along a flank, less half a degree at least: 29 of 60°, as the control has it by itself."""
    return math.ceil(flank_angle(values, setting) / 2.0) - 1.0


def proposed_rpm(values: Values, setting: Setting) -> Value | None:
    """Propose a speed that the slide can follow."""
    lead = number(values, "PITCH") * number(values, "STARTS")
    across = number(values, "CREST")
    if not lead or not across:
        return None
    most = min(rpm(Work.THREAD, across, setting), _MOST_RPM)
    fastest = 60.0 * 25.4 / setting.mm / lead  # in/min that a slide reaches in a short run-up
    return max(10.0, 10.0 * math.floor(min(most, fastest) / 10.0))


def proposed_run_up(values: Values, setting: Setting) -> Value | None:
    """What the slide needs to reach the lead, twice, and never less than two pitches."""
    lead, turns = number(values, "PITCH") * number(values, "STARTS"), number(values, "RPM")
    if not lead or not turns:
        return None
    accel = setting.shop.slide_accel / setting.mm
    needed = (lead * turns / 60.0) ** 2 / accel if accel else _TURNS_BEFORE * lead
    return round(max(needed, 2.0 * number(values, "PITCH"), setting.near), 2 if not setting.metric else 1)


def filled_depth(filled: Filled) -> float:
    """Of the thread, per side."""
    return abs(filled.n("CREST") - filled.n("ROOT")) / 2.0
