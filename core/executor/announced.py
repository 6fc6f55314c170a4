"""Announcement: what the next Cycle Start will start besides going on; nothing else starts with it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

SPINDLE = "spindle"
READ = 0.3  # s that it must have stood in the snapshot before a start may do it
_CHANGED = 0.1  # of a figure: more, and it counts from anew


class Starting(NamedTuple):
    """One thing that stands and will be on. ``what`` names it, ``text`` is what the operator reads.

    ``figure`` is how much of it, rpm for a spindle: one that has changed much is another announcement.
    ``begin`` lets it start; it is called with the start that was announced.
    """

    what: str
    text: str
    begin: Callable[[], None]
    figure: float = 0.0


class Announcement:
    """``sources`` are asked every tick what a start would start now. On the executor's thread alone."""

    def __init__(self) -> None:
        self.sources: list[Callable[[], Iterable[Starting]]] = []
        self._since: dict[str, tuple[float, float]] = {}  # what: when it was first published, its figure

    def publish(self, now: float) -> tuple[str, ...]:
        """What goes into the snapshot of this tick."""
        items, before = self._items(), self._since
        self._since = {item.what: self._counted(item, before, now) for item in items}
        return tuple(item.text for item in items)

    def refusal(self, now: float, what: str = "") -> str:
        """Why a start, of ``what`` or of all, is refused: nobody has had the time to read what it starts."""
        for item in self._items(what):
            since, figure = self._since.get(item.what, (math.inf, 0.0))
            if now - since < READ - 1e-9 or _differ(item.figure, figure):
                return f"look first: {item.text}; then start again"
        return ""

    def begin(self, what: str = "") -> None:
        """A start, of ``what`` or of all, that was not refused."""
        for item in self._items(what):
            item.begin()

    def _items(self, what: str = "") -> list[Starting]:
        return [item for source in self.sources for item in source() if what in {"", item.what}]

    def _counted(
        self, item: Starting, before: dict[str, tuple[float, float]], now: float
    ) -> tuple[float, float]:
        known = before.get(item.what)
        return (now, item.figure) if known is None or _differ(item.figure, known[1]) else known


def _differ(new: float, old: float) -> bool:
    return abs(new - old) > _CHANGED * abs(old)
