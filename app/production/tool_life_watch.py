"""Tool life during production: counts the use of each tool, reports it and can block the next part."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace

from app.desk.translation import tr
from app.production.parts_book import PartsBook
from app.production.tool_totals import TOTALS, ToolTotals
from core.access.access_table import Act
from core.executor.snapshot import CYCLE, Snapshot
from core.message import Message
from core.production.tool_life import LifeState, ToolLife
from core.store.production import tool_lives
from core.store.production.tool_lives import LifeRow
from core.store.store_rows import Kind

KEEP = 10.0  # seconds at feed between two stored counts; a power failure loses no more


def life_of(row: LifeRow) -> ToolLife:
    """Return the tool life for a stored row."""
    return ToolLife(
        row.number, row.limit_parts, row.limit_seconds, row.parts, row.seconds, row.warn, row.stops
    )


@dataclass(slots=True)
class ToolLifeWatch:
    """Watch of tool life. Counts are maintained here after the store was read, and limits are in the store.

    On a mill, the counts apply to a whole tool instead of an insert.
    """

    book: PartsBook
    control: Callable[[], str] = str  # identity of the control process, empty without one
    # parts and seconds since the last change of insert
    counted: dict[int, tuple[int, float]] = field(default_factory=dict)
    _kept: dict[int, float] = field(default_factory=dict)  # stored seconds
    _cut: Mapping[int, float] = field(default_factory=dict)  # cutting seconds of the last snapshot
    _in_part: set[int] = field(default_factory=set)  # tools that have cut since the last end of a part
    _ends: int = -1
    _control: str | None = None  # identity of the control to which the totals belong
    _told: dict[int, LifeState] = field(default_factory=dict)
    _changes: int = 0  # number of changes of ``counted``
    _lives: tuple[object, dict[int, ToolLife]] = field(default=(None, {}))
    _due: tuple[object, str] = (None, "")
    _seen: object = None

    def lives(self) -> dict[int, ToolLife]:
        """Return the tool life of all tools with a limit or use.

        The same object is returned while nothing changes.
        """
        of = (self.book.loads, self._changes)
        if self._lives[0] != of:
            self._lives = of, self._found()
        return self._lives[1]

    def _found(self) -> dict[int, ToolLife]:
        rows = self.book.now.lives
        found = {}
        for number in sorted({*rows, *self.counted}):
            row = rows.get(number, LifeRow(number))
            parts, seconds = self.counted.get(number, (row.parts, row.seconds))
            found[number] = replace(life_of(row), parts=parts, seconds=seconds)
        return found

    def see(self, snapshot: Snapshot, say: Callable[[str], None]) -> None:
        """Update the use of tools from a snapshot, and report tool life. Called once per frame."""
        if self._control != self.control():
            self._begin(snapshot, self.control())
        if not self.book.loads and self.book.store is not None:
            return  # The stored counts are not known yet; the totals of the snapshot remain until then.
        for number, seconds in snapshot.cutting.items():
            more = seconds - self._cut.get(number, 0.0)
            if number and more > 0.0:
                self._in_part.add(number)
                self._add(number, 0, more)
        ended, tools = snapshot.ends - self._ends, self._in_part
        self._cut, self._ends = snapshot.cutting, snapshot.ends
        if ended > 0:
            for number in tools:
                self._add(number, ended, 0.0)
            self._in_part = set()
            self._keep(tools)
        elif snapshot.state not in CYCLE or any(self._unkept(number) > KEEP for number in tools):
            self._keep({number for number in tools if self._unkept(number)})
        self._tell(say)

    def _begin(self, snapshot: Snapshot, control: str) -> None:
        """Continue from the stored totals of this control, or else from those of the snapshot."""
        self._control, self._ends, self._cut = control, snapshot.ends, snapshot.cutting
        stored = ToolTotals.of_plain(self.book.access.persistence.read_setting(TOTALS)) if control else None
        if stored is not None and stored.control == control:
            self._ends, self._cut, self._in_part = stored.ends, stored.cut, set(stored.in_part)
        elif control:
            self.book.keep_use((), self._totals())

    def _totals(self) -> ToolTotals | None:
        if not self._control:
            return None
        return ToolTotals(self._control, self._ends, dict(self._cut), frozenset(self._in_part))

    def _add(self, number: int, parts: int, seconds: float) -> None:
        row = self.book.now.lives.get(number, LifeRow(number))
        before = self.counted.get(number, (row.parts, row.seconds))
        self.counted[number] = before[0] + parts, before[1] + seconds
        self._changes += 1

    def _unkept(self, number: int) -> float:
        used = self.counted.get(number)
        return used[1] - self._kept.get(number, 0.0) if used is not None else 0.0

    def _keep(self, numbers: set[int]) -> None:
        rows = []
        for number in numbers:
            parts, seconds = self.counted[number]
            self._kept[number] = seconds
            rows.append(LifeRow(number, parts=parts, seconds=seconds))
        if rows:
            self.book.keep_use(rows, self._totals())

    def keep_all(self) -> None:
        """Store the use of all tools when TurnDesk closes."""
        self._keep({number for number in self.counted if self._unkept(number)})

    def _tell(self, say: Callable[[str], None]) -> None:
        """Report once when a tool reaches its warning limit, and once when its life is used up."""
        if self._seen is self.lives():
            return
        self._seen = self.lives()
        for number, life in self.lives().items():
            before = self._told.get(number)
            self._told[number] = life.state
            if before is not None and life.state is not before and life.state in _WORTH_TELLING:
                say(notice(life))

    # --- inserts -------------------------------------------------------------------------------------

    def change_insert(self, number: int, why: str, said: Callable[[str], None]) -> None:
        """Reset the use of a tool after a change of insert. ``said`` is called with the result."""
        parts, seconds = self.counted.get(number, (0, 0.0))
        known, who = number in self.counted, self.book.access.persistence.who()

        def operation(connection: sqlite3.Connection) -> None:
            if known:
                tool_lives.set_use(connection, number, parts, seconds, self.book.tools)
            tool_lives.change_insert(connection, number, why, self.book.tools, who)

        def done() -> None:
            more_parts, more_seconds = self.counted.get(number, (parts, seconds))
            self.counted[number] = max(0, more_parts - parts), max(0.0, more_seconds - seconds)
            self._kept[number] = 0.0
            self._changes += 1
            words = tr("T{number}: NEW INSERT, TOOL LIFE STARTS AT ZERO")
            if self.book.tools is Kind.MILL_TOOL:
                words = tr("T{number}: NEW TOOL, TOOL LIFE STARTS AT ZERO")
            said(tr(Message(words, number=number)))

        self.book.write(Act.INSERTS, operation, done, said)

    def set_used(self, number: int, seconds: float, said: Callable[[str], None]) -> None:
        """Set the cutting time of the tool in the spindle in seconds. 0 means a new tool."""
        life = self.lives().get(number)
        if seconds <= 0.0:
            self.change_insert(number, life.words if life is not None else "", said)
            return
        parts = life.parts if life is not None else 0

        def done() -> None:
            self.counted[number], self._kept[number] = (parts, seconds), seconds
            self._changes += 1
            said(tr(Message("T{number} SAVED", number=number)))

        self.book.write(
            Act.INSERTS,
            lambda connection: tool_lives.set_use(connection, number, parts, seconds, self.book.tools),
            done,
            said,
            Message(
                "cutting time of T{number} set to {seconds} min",
                number=number,
                seconds=f"{seconds / 60.0:.1f}",
            ),
        )

    def forget(self) -> None:
        """Discard the counts, because another store replaces the present one."""
        self.counted, self._kept = {}, {}
        self._changes += 1

    # --- messages and lock -------------------------------------------------------------------------------

    def due(self) -> str:
        """Return the message about the tool nearest its end of life, or an empty string."""
        lives = self.lives()
        if self._due[0] is not lives:
            told = [life for life in lives.values() if life.state in _WORTH_TELLING]
            self._due = lives, notice(max(told, key=lambda life: life.share)) if told else ""
        return self._due[1]

    def bar(self, snapshot: Snapshot, tools: Collection[int]) -> str:
        """Return the reason why no part with these tools may start, including the use by the present part."""
        for life in self._stopping(tools):
            after = replace(life, parts=life.parts + 1) if snapshot.counts else life
            if after.state is LifeState.SPENT:
                return spent(after, self.book.tools)
        return ""

    def _stopping(self, used: Collection[int]) -> Iterator[ToolLife]:
        yield from (life for life in self.lives().values() if life.stops and life.number in used)


_WORTH_TELLING = frozenset({LifeState.WARNED, LifeState.SPENT})


def notice(life: ToolLife) -> str:
    """Return the message about a tool life that is ending."""
    if life.state is LifeState.SPENT:
        return tr(Message("TOOL {number} LIFE USED UP: {words}", number=life.number, words=tr(life.words)))
    return tr(Message("TOOL {number} LIFE: {words} USED", number=life.number, words=tr(life.words)))


def spent(life: ToolLife, tools: Kind) -> str:
    """Return the reason why no part may start with this tool."""
    if tools is Kind.MILL_TOOL:
        how = "fit a new tool and set its CUR.TIME to 0 in the tool table (F8)"
        return Message(
            "T{number} tool life is used up ({life}): {method}",
            number=life.number,
            life=life.words,
            method=how,
        )
    return Message(
        "T{number} tool life is used up ({life}): change the insert and confirm the change in TOOL LIFE",
        number=life.number,
        life=life.words,
    )
