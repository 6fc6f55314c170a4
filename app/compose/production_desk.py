"""What a desk counts and keeps of production: tool lives, stops, and what optional features keep of parts."""

from __future__ import annotations

from app.compose.journal import Journal
from app.desk.desk import Desk
from app.offsets.mill_touch import MillLives
from app.production.parts_book import PartsBook, tools_of
from app.production.parts_watch import PartsWatch
from app.production.tool_life_watch import ToolLifeWatch
from core.machine.machine_model import Machine
from core.store.store_rows import Kind


def give_production(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Give the desk what it counts and keeps of production."""
    tools = tools_of(machine.kind)
    book = journal.parts_book(tools) if journal is not None else PartsBook(tools=tools)
    book.access = desk.access
    watch = PartsWatch(desk, book, ToolLifeWatch(book))
    desk.attach(watch)
    desk.watches.append(watch)
    if tools is Kind.MILL_TOOL:
        lives = watch.lives
        desk.attach(MillLives(lives.lives, lambda number, cut: lives.set_used(number, cut, desk.say)))
