"""The alarm catalog: every alarm, hold and stop with its number, text, causes and remedy.

Each alarm is one entry in the file of its subject, under its code. No alarm exists outside the catalog.
"""

from __future__ import annotations

from core.alarms.alarm_entry import Code as Code
from core.alarms.alarm_entry import Entries
from core.alarms.alarm_entry import Entry as Entry
from core.alarms.alarm_entry import Reaction as Reaction
from core.alarms.axis_alarms import AXES
from core.alarms.bus_alarms import WIRES
from core.alarms.control_alarms import CONTROL, PROGRAM, STATION
from core.alarms.spindle_alarms import CHUCK, SPINDLE

SUBJECTS: tuple[tuple[str, Entries], ...] = (
    ("Axes and axis drives", AXES),
    ("Spindle, C axis and threads", SPINDLE),
    ("Collet", CHUCK),
    ("Program", PROGRAM),
    ("Bus, driver host and controller", WIRES),
    ("Operator station and stops", STATION),
    ("Control", CONTROL),
)
CATALOGUE: dict[Code, Entry] = {code: entry for _, entries in SUBJECTS for code, entry in entries.items()}
