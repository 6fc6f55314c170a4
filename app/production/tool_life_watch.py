"""Tool life during production: the use of each tool is counted and reported, and can block the next part."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace

from app.desk.translation import tr
from app.production.parts_book import ProductionRecords
from app.production.tool_totals import TOTALS_SETTING, ToolUseTotals
from core.access.access_table import ProtectedChange
from core.executor.snapshot import CYCLE_STATES, Snapshot
from core.message import Message
from core.production.tool_life import ToolLife, ToolLifeState
from core.store.production import tool_lives
from core.store.production.tool_lives import ToolLifeRow
from core.store.store_rows import OffsetKind

SAVE_INTERVAL_S = 10.0  # seconds at feed between two stored counts; a power failure loses no more


def make_tool_life(row: ToolLifeRow) -> ToolLife:
    """Return the tool life for a stored row."""
    return ToolLife(
        row.number, row.limit_parts, row.limit_seconds, row.parts, row.seconds, row.warn, row.stops
    )


@dataclass(slots=True)
class ToolLifeMonitor:
    """Monitor of tool life.

    The stored use of a tool is the initial value. From then on, this object counts the use. The limits are
    in the store. On a mill, the counts apply to a whole tool instead of an insert.
    """

    production_records: ProductionRecords
    read_control_id: Callable[[], str] = str  # identity of the control process, empty without one
    # parts and seconds since the last change of insert
    tool_use_counts: dict[int, tuple[int, float]] = field(default_factory=dict)
    _kept: dict[int, float] = field(default_factory=dict)  # stored seconds
    _cut: Mapping[int, float] = field(default_factory=dict)  # cutting seconds of the last snapshot
    _in_part: set[int] = field(default_factory=set)  # tools that have cut since the last end of a part
    _ends: int = -1
    _control: str | None = None  # identity of the control to which the totals belong
    _told: dict[int, ToolLifeState] = field(default_factory=dict)
    _changes: int = 0  # number of changes of ``tool_use_counts``
    _lives: tuple[object, dict[int, ToolLife]] = field(default=(None, {}))
    _due: tuple[object, str] = (None, "")
    _seen: object = None

    def find_tool_lives(self) -> dict[int, ToolLife]:
        """Return the tool life of all tools that have a limit or were used.

        As long as nothing changes, each call returns the same object.
        """
        of = (self.production_records.load_count, self._changes)
        if self._lives[0] != of:
            self._lives = of, self._found()
        return self._lives[1]

    def _found(self) -> dict[int, ToolLife]:
        rows = self.production_records.current_data.tool_lives
        found = {}
        for number in sorted({*rows, *self.tool_use_counts}):
            row = rows.get(number, ToolLifeRow(number))
            parts, seconds = self.tool_use_counts.get(number, (row.parts, row.seconds))
            found[number] = replace(make_tool_life(row), parts=parts, seconds=seconds)
        return found

    def process_snapshot(self, snapshot: Snapshot, show_message: Callable[[str], None]) -> None:
        """Update the use of tools from a snapshot, and report tool life.

        This is called once a frame.
        """
        if self._control != self.read_control_id():
            self._begin(snapshot, self.read_control_id())
        if not self.production_records.load_count and self.production_records.store is not None:
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
        elif snapshot.state not in CYCLE_STATES or any(
            self._unkept(number) > SAVE_INTERVAL_S for number in tools
        ):
            self._keep({number for number in tools if self._unkept(number)})
        self._report(show_message)

    def _begin(self, snapshot: Snapshot, control: str) -> None:
        """Start counting from the totals that are stored for this control.

        If no totals are stored, start from the totals of the snapshot.
        """
        self._control, self._ends, self._cut = control, snapshot.ends, snapshot.cutting
        stored = (
            ToolUseTotals.from_setting(
                self.production_records.user_access.persistence.read_setting(TOTALS_SETTING)
            )
            if control
            else None
        )
        if stored is not None and stored.control_identity == control:
            self._ends, self._cut, self._in_part = (
                stored.finished_part_count,
                stored.cutting_seconds_by_tool,
                set(stored.current_part_tools),
            )
        elif control:
            self.production_records.save_tool_use((), self._totals())

    def _totals(self) -> ToolUseTotals | None:
        if not self._control:
            return None
        return ToolUseTotals(self._control, self._ends, dict(self._cut), frozenset(self._in_part))

    def _add(self, number: int, parts: int, seconds: float) -> None:
        row = self.production_records.current_data.tool_lives.get(number, ToolLifeRow(number))
        before = self.tool_use_counts.get(number, (row.parts, row.seconds))
        self.tool_use_counts[number] = before[0] + parts, before[1] + seconds
        self._changes += 1

    def _unkept(self, number: int) -> float:
        used = self.tool_use_counts.get(number)
        return used[1] - self._kept.get(number, 0.0) if used is not None else 0.0

    def _keep(self, numbers: set[int]) -> None:
        rows = []
        for number in numbers:
            parts, seconds = self.tool_use_counts[number]
            self._kept[number] = seconds
            rows.append(ToolLifeRow(number, parts=parts, seconds=seconds))
        if rows:
            self.production_records.save_tool_use(rows, self._totals())

    def save_all_tool_use(self) -> None:
        """Store the use of all tools when TurnDesk closes."""
        self._keep({number for number in self.tool_use_counts if self._unkept(number)})

    def _report(self, show_message: Callable[[str], None]) -> None:
        """Report a tool once when it reaches its warning limit, and once when its life is used up."""
        if self._seen is self.find_tool_lives():
            return
        self._seen = self.find_tool_lives()
        for number, life in self.find_tool_lives().items():
            before = self._told.get(number)
            self._told[number] = life.state
            if before is not None and life.state is not before and life.state in _REPORTED_STATES:
                show_message(make_tool_life_notice(life))

    # --- inserts -------------------------------------------------------------------------------------

    def record_insert_change(self, number: int, reason: str, on_done: Callable[[str], None]) -> None:
        """Reset the use of a tool after a change of insert.

        ``on_done`` is called with the result.
        """
        parts, seconds = self.tool_use_counts.get(number, (0, 0.0))
        known, who = number in self.tool_use_counts, self.production_records.user_access.persistence.who()

        def write_insert_change(connection: sqlite3.Connection) -> None:
            if known:
                tool_lives.save_insert_use(
                    connection, number, parts, seconds, self.production_records.tool_table_kind
                )
            tool_lives.record_insert_change(
                connection, number, reason, self.production_records.tool_table_kind, who
            )

        def reset_tool_use() -> None:
            more_parts, more_seconds = self.tool_use_counts.get(number, (parts, seconds))
            self.tool_use_counts[number] = max(0, more_parts - parts), max(0.0, more_seconds - seconds)
            self._kept[number] = 0.0
            self._changes += 1
            words = tr("T{number}: NEW INSERT, TOOL LIFE STARTS AT ZERO")
            if self.production_records.tool_table_kind is OffsetKind.MILL_TOOL:
                words = tr("T{number}: NEW TOOL, TOOL LIFE STARTS AT ZERO")
            on_done(tr(Message(words, number=number)))

        self.production_records.write_change(
            ProtectedChange.INSERTS, write_insert_change, reset_tool_use, on_done
        )

    def set_cutting_time(self, number: int, cutting_time_s: float, on_done: Callable[[str], None]) -> None:
        """Set the cutting time of the tool in the spindle in seconds.

        A value of 0 means a new tool.
        """
        life = self.find_tool_lives().get(number)
        if cutting_time_s <= 0.0:
            self.record_insert_change(number, life.words if life is not None else "", on_done)
            return
        parts = life.parts if life is not None else 0

        def apply_cutting_time() -> None:
            self.tool_use_counts[number], self._kept[number] = (parts, cutting_time_s), cutting_time_s
            self._changes += 1
            on_done(tr(Message("T{number} SAVED", number=number)))

        self.production_records.write_change(
            ProtectedChange.INSERTS,
            lambda connection: tool_lives.save_insert_use(
                connection, number, parts, cutting_time_s, self.production_records.tool_table_kind
            ),
            apply_cutting_time,
            on_done,
            Message(
                "cutting time of T{number} set to {seconds} min",
                number=number,
                seconds=f"{cutting_time_s / 60.0:.1f}",
            ),
        )

    def discard_counts(self) -> None:
        """Discard the counts of tool use, because another store replaces the current one."""
        self.tool_use_counts, self._kept = {}, {}
        self._changes += 1

    # --- messages and lock -------------------------------------------------------------------------------

    def find_reminder(self) -> str:
        """Return the message about the tool that is nearest to the end of its life, or an empty string."""
        lives = self.find_tool_lives()
        if self._due[0] is not lives:
            alerts = [life for life in lives.values() if life.state in _REPORTED_STATES]
            self._due = (
                lives,
                make_tool_life_notice(max(alerts, key=lambda life: life.share)) if alerts else "",
            )
        return self._due[1]

    def find_lock_reason(self, snapshot: Snapshot, tools: Collection[int]) -> str:
        """Return why no part with these tools may start, or an empty string if it may.

        The use by the current part is included.
        """
        for life in self._stopping(tools):
            after = replace(life, parts=life.parts + 1) if snapshot.counts else life
            if after.state is ToolLifeState.USED_UP:
                return describe_used_up_tool(after, self.production_records.tool_table_kind)
        return ""

    def _stopping(self, used: Collection[int]) -> Iterator[ToolLife]:
        yield from (life for life in self.find_tool_lives().values() if life.stops and life.number in used)


_REPORTED_STATES = frozenset({ToolLifeState.WARNING, ToolLifeState.USED_UP})


def make_tool_life_notice(life: ToolLife) -> str:
    """Return the message about a tool whose life is ending."""
    if life.state is ToolLifeState.USED_UP:
        return tr(Message("TOOL {number} LIFE USED UP: {words}", number=life.number, words=tr(life.words)))
    return tr(Message("TOOL {number} LIFE: {words} USED", number=life.number, words=tr(life.words)))


def describe_used_up_tool(life: ToolLife, tool_table: OffsetKind) -> str:
    """Return the message that no part may start because the life of this tool is used up."""
    if tool_table is OffsetKind.MILL_TOOL:
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
