"""The catalogue of alarms: every alarm, hold and stop, with number, what happened, causes and remedy."""

from core.alarms.alarm_entry import Code as Code
from core.alarms.alarm_entry import Entry as Entry
from core.alarms.alarm_entry import Reaction as Reaction
from core.alarms.catalogue import CATALOGUE as CATALOGUE
from core.alarms.catalogue import by_number as by_number
