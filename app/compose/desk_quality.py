"""Measured parts, tool life and trends of a desk: put together and given to it."""

from __future__ import annotations

from collections.abc import Sequence

from app.compose.journal import Journal
from app.desk.desk import Desk
from app.offsets.mill_lives import MillLives
from app.quality.parts_book import PartsBook, tools_of
from app.quality.parts_watch import PartsWatch
from app.quality.quality_functions import QualityFunctions
from app.quality.tool_life_watch import ToolLifeWatch
from app.special.special_functions import SpecialFunction
from core.machine.machine_model import Machine
from core.store.store_rows import Kind


def give_quality(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Give the desk what it measures, counts and remembers of parts and inserts."""
    tools = tools_of(machine.kind)
    book = journal.parts_book(tools) if journal is not None else PartsBook(tools=tools)
    book.access = desk.access
    watch = PartsWatch(desk, book, ToolLifeWatch(book))
    desk.attach(watch)
    desk.watches.append(watch)
    if tools is Kind.MILL_TOOL:
        lives = watch.lives
        desk.attach(MillLives(lives.lives, lambda number, cut: lives.set_used(number, cut, desk.say)))
    desk.attach(QualityFunctions(lambda: _sections(desk, machine, watch), book.worker))


def _sections(desk: Desk, machine: Machine, watch: PartsWatch) -> Sequence[SpecialFunction]:
    """Those of the page: the start of the desk is not delayed by loading them."""
    from app.compose.desk_quality_sections import sections

    return sections(desk, machine, watch)
