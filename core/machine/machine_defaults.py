"""What a machine file leaves out and its other values tell: each default with the reason for its figure.

A value without a safe default is not here, and a file without it is refused. Units are the model's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from core.machine.machine_reading import Reading
from core.table_schema import Finding, Values, missing

HAND_RAPID = 100 * 25.4 / 60  # mm/s: jog and manual rapid of an OmniTurn, 100 in/min
_DRIVE = 40.0  # Hz, position loop of a slow servo drive; it lags 2 / (2 pi f) seconds behind its command
_LAG = 2.0 / (2.0 * math.pi * _DRIVE)
_C_STARTS = 3.0  # 1/s: a third of a second to full speed, which a spindle drive without a C ramp can do
_C_SPEED, _C_COUNT = 200 * 6.0, 0.02  # degrees/s and degrees: the C option of a GT-75
_STILL, _STILL_DEGREES = 0.2, 1.0  # mm, degrees: what an axis at rest may be off
_CLOSES = 0.5  # s; collets of this class take 0.2 to 0.4, and the switch decides
_SLIDES = ("X", "Y", "Z")

Derived = float | None  # None: it cannot be told


def fill(reading: Reading) -> Iterator[Finding]:
    """Puts in what was left out; a finding for each value that this machine has to say itself.

    What cannot be told because the value it comes from is wrong has its finding there.
    """
    values = reading.values
    for place, field in values.left_out.items():
        if not _filled(place, reading) and place in TO_BE_SAID:
            yield missing(place, field, values.inch)


def _filled(place: str, reading: Reading) -> bool:
    _, _, key = place.rpartition(".")
    rule = RULES.get(place) or OF_AN_AXIS[key]
    value = rule(reading, place)
    if value is not None:
        reading.values.found[place] = value
    return value is not None


def _of_slides(values: Values, key: str) -> list[float]:
    paths = [f"axis.{name}.{key}" for name in _SLIDES]
    return [values.number(path) for path in paths if values.has(path)]


def _slowest(reading: Reading, _place: str) -> Derived:
    """A feed goes in every direction: no faster than the slowest slide."""
    return min(_of_slides(reading.values, "vmax"), default=None)


def _by_hand(reading: Reading, _place: str) -> Derived:
    return min((HAND_RAPID, *_of_slides(reading.values, "vmax")))


def _coarsest(reading: Reading, _place: str) -> Derived:
    """A programmed step must be a count on every slide."""
    return max(_of_slides(reading.values, "count"), default=None)


def _brakes(reading: Reading, _place: str) -> Derived:
    """As hard as it accelerates: most brake harder, and a time that is too long only waits."""
    return _number(reading.values, "spindle.accel_rpm_s")


def _closes(reading: Reading, _place: str) -> Derived:
    """Only where a switch says that it is closed; else its time is all that holds the spindle back."""
    return _CLOSES if "collet_closed" in reading.inputs or reading.kind != "lathe" else None


def _neighbour(values: Values, place: str) -> Derived:
    """The same key of the first slide that says it: slides of one machine have drives of one kind."""
    _, name, key = place.split(".")
    said = [f"axis.{other}.{key}" for other in _SLIDES if name in _SLIDES]
    return next((values.number(p) for p in said if values.has(p) and p not in values.left_out), None)


def _window(reading: Reading, place: str) -> Derived:
    """The neighbour's, else twice what a slow drive lags at full speed."""
    values = reading.values
    vmax = _number(values, place.replace("fe_window", "vmax"))
    return _neighbour(values, place) or (2.0 * _LAG * vmax if vmax else None)


def _arrived(reading: Reading, place: str) -> Derived:
    """The neighbour's, else four counts: a drive that stands moves by one or two; five of a coarse C."""
    values = reading.values
    count = _number(values, place.replace("in_pos", "count"))
    counts = 4.0 if place.split(".")[1] in _SLIDES else 5.0
    return _neighbour(values, place) or (counts * count if count else None)


def _stands(reading: Reading, place: str) -> Derived:
    """The neighbour's; else .2 mm, by which no cutting force moves a slide that is held, or a degree.

    But no less than it needs to be in position, and no more than its fault window.
    """
    values = reading.values
    window = _number(values, place.replace("still_window", "fe_window"))
    arrived = _number(values, place.replace("still_window", "in_pos"))
    if window is None or arrived is None:
        return None
    usual = _STILL if place.split(".")[1] in _SLIDES else _STILL_DEGREES
    return _neighbour(values, place) or min(max(usual, 4.0 * arrived), window)


def _c_speed(reading: Reading, _place: str) -> Derived:
    return None if _c_is_used(reading) else _C_SPEED


def _c_count(reading: Reading, _place: str) -> Derived:
    return None if _c_is_used(reading) else _C_COUNT


def _c_starts(reading: Reading, _place: str) -> Derived:
    """In a third of a second, and no harder than the spindle, which it is."""
    values = reading.values
    spindle, vmax = _number(values, "spindle.accel_rpm_s"), _number(values, "axis.C.vmax")
    return min(6.0 * spindle, _C_STARTS * vmax) if spindle and vmax else None


def _c_is_used(reading: Reading) -> bool:
    return reading.values.has("axis.C.enabled") and reading.values.flag("axis.C.enabled")


def _number(values: Values, path: str) -> Derived:
    return values.number(path) if values.has(path) else None


Rule = Callable[[Reading, str], Derived]
OF_AN_AXIS: dict[str, Rule] = {"fe_window": _window, "in_pos": _arrived, "still_window": _stands}
RULES: dict[str, Rule] = {
    "limits.max_feed": _slowest,
    "limits.manual_rapid": _by_hand,
    "limits.resolution": _coarsest,
    "spindle.decel_rpm_s": _brakes,
    "collet.close_s": _closes,
    "axis.C.vmax": _c_speed,
    "axis.C.count": _c_count,
    "axis.C.amax": _c_starts,
}
TO_BE_SAID = frozenset(("collet.close_s", "axis.C.vmax", "axis.C.count"))
