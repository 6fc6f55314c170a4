"""Explanation of one alarm or stop, which the help shows with its address in the documentation."""

from __future__ import annotations

from app.desk.pages.guide_text import BlockKind, GuideBlock
from app.desk.translation import tr
from core.alarms import CATALOG
from core.executor.snapshot import Alarm
from core.message import Message

_ALARMS_PAGE = "docs/alarms.html"
_ALARM_NUMBERS = frozenset(entry.number for entry in CATALOG.values())


def find_alarm_address(number: int) -> str:
    """Return the address of an alarm in the documentation site, or an empty string for an unknown number."""
    return f"{_ALARMS_PAGE}#{number}" if number in _ALARM_NUMBERS else ""


def make_alarm_help(alarm: Alarm) -> tuple[GuideBlock, ...]:
    """Return the number, text, causes and remedy of an alarm, with its address if the number is known."""
    address = find_alarm_address(alarm.number)
    causes = dict.fromkeys((alarm.cause, *alarm.causes))
    heading = tr(Message("{number}  ·  {alarm}", number=alarm.number, alarm=alarm.text))
    return (
        GuideBlock(BlockKind.HEADING, heading),
        *([GuideBlock(BlockKind.ADDRESS, address)] if address else []),
        GuideBlock(BlockKind.HEADING, tr("CAUSES, MOST LIKELY FIRST")),
        *(GuideBlock(BlockKind.TEXT, f"· {tr(cause)}") for cause in causes if cause),
        GuideBlock(BlockKind.HEADING, tr("WHAT TO DO")),
        GuideBlock(BlockKind.TEXT, tr(alarm.remedy)),
    )
