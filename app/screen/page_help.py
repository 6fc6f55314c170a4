"""Help about a page: the marked word or field, the guide's section about the page, and the common keys."""

from __future__ import annotations

from collections.abc import Sequence

from app.desk.pages.guide_text import ALARM_LOG, COMMON_KEYS, BlockKind, GuideBlock, read_page_help
from app.desk.translation import get_language, tr


def make_page_help(
    page_name: str, marked_help: Sequence[GuideBlock], *, is_log: bool
) -> tuple[GuideBlock, ...]:
    """Return the help about a page, or an empty tuple if the guide is not installed.

    ``marked_help`` is the help about the marked word or field. ``is_log`` is True if the alarm log covers
    the page.
    """
    language = get_language()
    section = read_page_help(ALARM_LOG if is_log else page_name, language)
    if not section:
        return tuple(marked_help)
    title = tr("ALARMS AND STOPS") if is_log else tr(page_name)
    common = read_page_help(COMMON_KEYS, language)
    common_title = GuideBlock(BlockKind.HEADING, tr("KEYS THAT ACT ON EVERY PAGE"))
    return (
        *(marked_help if not is_log else ()),
        GuideBlock(BlockKind.HEADING, title),
        *section,
        *((common_title, *common) if common != section else ()),
    )
