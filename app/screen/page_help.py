"""Help about a page: the alarm, the marked word or field, the guide's section, and the common keys."""

from __future__ import annotations

from collections.abc import Sequence

from app.desk.pages.alarm_help import make_alarm_help
from app.desk.pages.guide_text import (
    ALARM_LOG,
    COMMON_KEYS,
    BlockKind,
    GuideBlock,
    find_page_address,
    read_page_help,
)
from app.desk.translation import get_language, tr
from core.executor.snapshot import Alarm


def make_page_help(
    page_name: str, marked_help: Sequence[GuideBlock], *, is_log: bool, alarm: Alarm | None = None
) -> tuple[GuideBlock, ...]:
    """Return the help about a page, or an empty tuple if the guide is not installed.

    ``marked_help`` is the help about the marked word or field. ``is_log`` is True if the alarm log covers
    the page. ``alarm`` is the selected alarm of the log, or the alarm that is active.
    """
    language, topic = get_language(), ALARM_LOG if is_log else page_name
    first = (*(make_alarm_help(alarm) if alarm else ()), *(marked_help if not is_log else ()))
    section = read_page_help(topic, language)
    if not section:
        return first
    title = tr("ALARMS AND STOPS") if is_log else tr(page_name)
    common = read_page_help(COMMON_KEYS, language)
    common_title = GuideBlock(BlockKind.HEADING, tr("KEYS THAT ACT ON EVERY PAGE"))
    return (
        *first,
        GuideBlock(BlockKind.HEADING, title),
        GuideBlock(BlockKind.ADDRESS, find_page_address(topic, language)),
        *section,
        *((common_title, *common) if common != section else ()),
    )
