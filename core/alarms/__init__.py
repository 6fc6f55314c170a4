"""The catalogue of alarms: every alarm, hold and stop, with number, what happened, causes and remedy."""

from core.alarms.catalogue import CATALOGUE as CATALOGUE
from core.alarms.catalogue import by_number as by_number
from core.alarms.entry import Code as Code
from core.alarms.entry import Entry as Entry
from core.alarms.entry import Reaction as Reaction
