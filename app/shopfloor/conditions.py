"""Which alarm is a condition of what: slide, spindle drive, wires, interlocks, program, control."""

from __future__ import annotations

import re
from collections.abc import Mapping

from core.executor.snapshot import Alarm, Snapshot, State

FAULT, WARNING = "FAULT", "WARNING"
Condition = tuple[str, str, str]  # level, code, text
SPINDLE, COMMS, LOGIC, SYSTEM, MOTION = "Sdrive", "comms", "logic", "system", "motion"

# By the alarm's code. A slide's own condition ends in ``servo`` or ``travel`` and begins with its name.
_SERVO, _TRAVEL = "servo", "travel"
PLACES = {
    "axis": _SERVO,
    "following": _SERVO,
    "in-position": _SERVO,
    "driver": COMMS,
    "spindle": SPINDLE,
    "at-speed": SPINDLE,
    "ignores-stop": SPINDLE,
    "thread-lost": SPINDLE,
    "spindle-still": MOTION,
    "c-is-spindle": MOTION,
    "collet-open": LOGIC,
    "unclamp": LOGIC,
    "collet": LOGIC,
    "collet-lost": LOGIC,
    "program": MOTION,
    "travel": _TRAVEL,
    "internal": SYSTEM,
}
_NOWHERE = {_SERVO: SYSTEM, _TRAVEL: MOTION}  # where the alarm names no axis


def conditions_of(snapshot: Snapshot, keys: frozenset[str]) -> Mapping[str, tuple[Condition, ...]]:
    """What is active of each of these conditions; nothing of it: normal.

    A hold that nobody pressed is a warning of the system, with the reason that the screen shows.
    """
    active: dict[str, list[Condition]] = {key: [] for key in keys}
    for alarm in snapshot.alarms:
        active[_place(alarm, keys)].append((FAULT, str(alarm.number), f"{alarm.text}: {alarm.cause}"))
    if snapshot.interrupted is not None:
        active[SYSTEM].append((WARNING, "interrupted", snapshot.interrupted.words))
    if snapshot.state is State.HOLD and snapshot.waiting_for:
        active[SYSTEM].append((WARNING, "hold", snapshot.waiting_for))
    return {key: tuple(found) for key, found in active.items()}


def _place(alarm: Alarm, keys: frozenset[str]) -> str:
    place = PLACES.get(alarm.code, SYSTEM)
    if place not in _NOWHERE:
        return place
    for word in re.findall(r"\b[A-Z]\b", alarm.cause):
        if f"{word}{place}" in keys:
            return f"{word}{place}"
        if word == "C" and place == _SERVO:
            return SPINDLE  # the spindle is this axis
    return _NOWHERE[place]
