"""Alarm catalog: every alarm, hold and stop with its number, text, causes and remedy.

Each alarm is one entry, identified by its code, in the module of its subject. Every alarm is in the
catalog.
"""

from __future__ import annotations

from core.alarms.alarm_entry import AlarmCode as AlarmCode
from core.alarms.alarm_entry import AlarmEntries
from core.alarms.alarm_entry import AlarmEntry as AlarmEntry
from core.alarms.alarm_entry import AlarmReaction as AlarmReaction
from core.alarms.axis_alarms import AXIS_ALARMS
from core.alarms.bus_alarms import CONNECTION_ALARMS
from core.alarms.control_alarms import CONTROL_ALARMS, PROGRAM_ALARMS, STOP_AND_HOLD_ALARMS
from core.alarms.spindle_alarms import COLLET_ALARMS, SPINDLE_ALARMS

ALARM_SUBJECTS: tuple[tuple[str, AlarmEntries], ...] = (
    ("Axes and axis drives", AXIS_ALARMS),
    ("Spindle, C axis and threads", SPINDLE_ALARMS),
    ("Collet", COLLET_ALARMS),
    ("Program", PROGRAM_ALARMS),
    ("Bus, driver host and controller", CONNECTION_ALARMS),
    ("Operator station and stops", STOP_AND_HOLD_ALARMS),
    ("Control", CONTROL_ALARMS),
)
CATALOG: dict[AlarmCode, AlarmEntry] = {
    code: entry for _, entries in ALARM_SUBJECTS for code, entry in entries.items()
}
