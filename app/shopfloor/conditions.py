"""Which alarm is a condition of what: slide, spindle drive, wires, interlocks, program, control."""

from __future__ import annotations

import re
from collections.abc import Mapping

from core.alarms import CATALOGUE, Code, Reaction
from core.executor.snapshot import Alarm, Snapshot, State

FAULT, WARNING = "FAULT", "WARNING"
Condition = tuple[str, str, str]  # level, code, text
SPINDLE, COMMS, LOGIC, SYSTEM, MOTION = "Sdrive", "comms", "logic", "system", "motion"

# By the first digit of the alarm's number, which is its subject; and those that belong elsewhere. A slide's
# own condition ends in ``servo`` or ``travel`` and begins with its name.
_SERVO, _TRAVEL = "servo", "travel"
SUBJECTS = {1: _SERVO, 2: SPINDLE, 3: LOGIC, 4: MOTION, 5: COMMS}
PLACES: dict[Code, str] = {
    **{"driver": COMMS, "travel": _TRAVEL},
    **{"spindle-still": MOTION, "c-is-spindle": MOTION},
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
    stop = snapshot.stop
    if snapshot.state is State.HOLD and stop is not None and CATALOGUE[stop.code].reaction is Reaction.HOLD:
        active[SYSTEM].append((WARNING, str(stop.number), stop.text))
    return {key: tuple(found) for key, found in active.items()}


def _place(alarm: Alarm, keys: frozenset[str]) -> str:
    place = PLACES.get(alarm.code) or SUBJECTS.get(alarm.number // 100, SYSTEM)
    if place not in _NOWHERE:
        return place
    for word in re.findall(r"\b[A-Z]\b", alarm.cause):
        if f"{word}{place}" in keys:
            return f"{word}{place}"
        if word == "C" and place == _SERVO:
            return SPINDLE  # the spindle is this axis
    return _NOWHERE[place]
