"""Changes to offsets, with confirmation of suspicious changes, history and undo.

Every page changes offsets through these classes. The question for confirmation shows the old and the new
value. Y changes the offset. N and Esc leave it unchanged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from app.desk.desk import Desk
from app.desk.status.formats import format_local_time
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.offsets.change_rules import (
    LARGE_CHANGE_MM,
    SuspicionReason,
    SuspiciousChange,
    apply_touch_off,
    describe_suspicious_changes,
    find_factor_suspicion,
    find_following_tools,
    find_required_access_right,
    find_suspicious_changes,
    find_suspicious_follower_changes,
    find_suspicious_table_changes,
    find_travel_limits,
    sort_by_seriousness,
)
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_values import (
    UnitMode,
    describe_missing_offset,
    format_cell,
    format_offset_change,
    format_signed_length,
    format_value,
    make_field_heading,
)
from core.access.access_table import ProtectedChange
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message
from core.store.offsets.touch_off import TouchPosition
from core.store.store_errors import StoreError
from core.store.store_rows import FIELDS_BY_KIND, FieldValue, OffsetChange, OffsetKind, ToolOffsetRow
from core.tool_edges import format_edge_name, get_tool_number

NUMBER_PREFIXES = {
    OffsetKind.TOOL: "T",
    OffsetKind.SHAPE: "T",
    OffsetKind.SECONDARY: "D",
    OffsetKind.ZERO: "G",
    OffsetKind.MILL_TOOL: "T",
    OffsetKind.PRESET: "PRESET ",
}


def find_change_refusal(snapshot: Snapshot, *, is_correction: bool) -> str:
    """Return the reason why offsets cannot be changed now, or an empty string if they can be changed.

    A correction (wear, secondary offset) may be entered while parts are being cut, because the current part
    uses the offsets with which it was proved. A change that moves a tool tip must wait until no program is
    running.
    """
    if snapshot.state in {MachineState.JOG, MachineState.HOMING}:
        return tr("AXES ARE MOVING. WAIT UNTIL THEY STOP TO CHANGE OFFSETS")
    if snapshot.state in ACTIVE_STATES and not is_correction:
        return tr("PROGRAM RUNNING. CHANGE ONLY WEAR OR SECONDARY OFFSETS (F9)")
    return ""


def describe_effective_time(snapshot: Snapshot) -> str:
    """Return a text that states when a change entered now takes effect.

    The result is an empty string if no cycle is running. This includes a cycle that is stopped, for example
    in feed hold.
    """
    if snapshot.state not in ACTIVE_STATES:
        return ""
    if snapshot.cycle_repeat:
        return tr("OFFSET CHANGES APPLY FROM NEXT PART, AFTER THEY ARE PROVED")
    return tr("WEAR APPLIES FROM NEXT CYCLE START")


def _describe_applied_next(snapshot: Snapshot) -> str:
    """Return the suffix of a SAVED message that states when the change applies.

    The result is an empty string if no cycle is running.
    """
    if snapshot.state not in ACTIVE_STATES:
        return ""
    if snapshot.cycle_repeat:
        return tr("; APPLIES FROM NEXT PART")
    return tr("; APPLIES FROM NEXT CYCLE START")


@dataclass(slots=True)
class OffsetHistory:
    """History of changes to the offset table ``kind``.

    Every page that changes the table calls ``update`` once per frame.
    """

    desk: Desk
    kind: OffsetKind
    unit_mode: UnitMode = field(default_factory=UnitMode)  # Mode of the control at the last update.
    key_hint: str = "F5"  # Keys that show the history on the page.
    last_changes: tuple[
        OffsetChange, ...
    ] = ()  # Changes of the last step that was saved while the page was open.
    listed_changes: tuple[OffsetChange, ...] | None = None  # The history while it is shown, else None.
    _seen: int = 0
    _newest: int = 0  # Id of the newest change that was read.
    _asked_of: tuple[int, int | None] | None = None  # Change count and row for which ``_undoable`` is valid.
    _undoable: bool = True

    def __post_init__(self) -> None:
        self._seen = self.offset_book.changes

    @property
    def offset_book(self) -> OffsetBook:
        """Return the offset book, which contains the saved offsets."""
        return self.desk.offset_book

    def on_open(self) -> None:
        """Mark all earlier changes as known when the page opens, so that they are not reported."""
        self._seen, self.last_changes = self.offset_book.changes, ()
        self._newest = max((change.id for change in self._read(1)), default=0)

    def update(self, snapshot: Snapshot) -> None:
        """Read the unit of the control, and report newly saved changes.

        This method is called once per frame.
        """
        self.unit_mode = UnitMode(snapshot.modal.metric, snapshot.shows_diameter)
        if self.offset_book.changes == self._seen:
            return
        self._seen = self.offset_book.changes
        changes = self._read()
        # The change may belong to another table, for example a tip entered on the page of the tool shape.
        fresh = bool(changes) and changes[0].id != self._newest
        self._newest = changes[0].id if changes else 0
        self.last_changes = tuple(change for change in changes if fresh and change.step == changes[0].step)
        if self.listed_changes is not None:
            self.listed_changes = changes
        self.desk.show_success(self._saved() + _describe_applied_next(snapshot))

    def _saved(self) -> str:
        if not self.last_changes:
            return tr("SAVED")
        names = " ".join(self._named(change) for change in reversed(self.last_changes))
        if len(self.last_changes) > 1 and self.kind is not OffsetKind.ZERO:
            names = tr(Message("{count} OFFSETS", count=len(self.last_changes)))
        taken_back = self.last_changes[0].undoes is not None
        return tr(Message(tr("{names} UNDONE") if taken_back else tr("{names} SAVED"), names=names))

    def _named(self, change: OffsetChange) -> str:
        letter = NUMBER_PREFIXES[self.kind]
        return format_edge_name(change.number) if letter == "T" else f"{letter}{change.number}"

    def format_change(self, change: OffsetChange) -> tuple[str, str, str, str]:
        """Return the texts of one change in the history.

        The texts are the local time, the name of the offset, its old and new values in the unit of the
        control, and the reason with the user.
        """
        at = format_local_time(change.at)
        who = "" if change.who == "operator" else f" ({change.who})"
        which = self._named(change)
        return at, which, format_offset_change(change.old, change.new, self.unit_mode), f"{change.why}{who}"

    @property
    def last_change_text(self) -> str:
        """Return a description of the last change in one line.

        The result is an empty string if nothing has changed since the page opened.
        """
        if len(self.last_changes) == 1:
            _at, which, change, _why = self.format_change(self.last_changes[0])
            return f"{which}   {change}"
        return (
            tr(
                Message(
                    "{count} offsets changed. {keys}: show the changes",
                    count=len(self.last_changes),
                    keys=self.key_hint,
                )
            )
            if self.last_changes
            else ""
        )

    def toggle_change_list(self) -> None:
        """Show the history instead of the table, or the table again."""
        self.listed_changes = None if self.listed_changes is not None else self._read()

    def can_undo(self, number: int | None) -> bool:
        """Return whether the last change of a row can be undone. ``number`` None means the whole table.

        The result is cached until the next change.
        """
        key = self.offset_book.changes, number
        if self._asked_of != key:
            self._asked_of, self._undoable = key, True
            with suppress(StoreError):  # ``undo`` itself reports the error.
                self._undoable = bool(self.offset_book.find_undoable_changes(self.kind, number))
        return self._undoable

    def show_refusal(self, reason: str) -> None:
        """Show the reason why a change was rejected. Do nothing if the reason is empty."""
        if reason:
            self.desk.say(reason)

    def _read(self, limit: int = 200) -> tuple[OffsetChange, ...]:
        try:
            return self.offset_book.read_history(self.kind, limit)
        except StoreError as error:
            self.desk.say(str(error))
            return ()


_MAX_NAMES = 6  # Followers that a question lists by name.


@dataclass(frozen=True, slots=True)
class ConfirmedOffsetChanges:
    """Changes to offsets, which the operator must confirm if they are suspicious.

    Each method that makes a change returns an empty string, or the reason if the change is rejected.
    """

    offset_history: OffsetHistory

    # --- values --------------------------------------------------------------------------------------

    def change_fields(
        self, kind: OffsetKind, number: int, values: Mapping[str, FieldValue], reason: str
    ) -> str:
        """Save some fields of an offset row.

        If a value is suspicious, ask the operator to confirm it first.
        """
        book = self.offset_history.offset_book
        table = book.get_rows(kind)
        return self._ask_if_intended(
            kind,
            find_suspicious_table_changes(kind, table, {number: values}, self._travel()),
            find_required_access_right(kind, values),
            lambda: book.change_fields(kind, number, values, reason),
            lambda: book.get_rows(kind).get(number) == table.get(number),
        )

    def touch_off(
        self, tool_number: int, touch: TouchPosition, reason: str, tip_x_mm: float | None = None
    ) -> str:
        """Set the offset of a tool by a touch-off, after confirmation if the result is suspicious.

        ``tip_x_mm`` is X of the tip relative to part zero as a radius in mm, or None if X was not touched
        off.
        """
        book = self.offset_history.offset_book
        tools = book.tool_offsets
        return self._ask_if_intended(
            OffsetKind.TOOL,
            self.find_suspicious_touch_changes(tool_number, touch, tip_x_mm),
            ProtectedChange.TOOLS,
            lambda: book.touch_off(tool_number, touch, reason),
            lambda: book.tool_offsets == tools,
            self._describe_followers(tool_number, touch),
        )

    def touch_off_new_tool(
        self, tool_number: int, touch: TouchPosition, save: Callable[[], str], tip_x_mm: float | None = None
    ) -> str:
        """Touch off one axis of a new tool, after confirmation if the result is suspicious.

        ``save`` stores the result. ``tip_x_mm`` has the same meaning as for ``touch_off``.
        """
        found = self.find_suspicious_touch_changes(tool_number, touch, tip_x_mm)
        return self._ask_if_intended(
            OffsetKind.TOOL,
            tuple(each for each in found if getattr(touch, each.name, None) is not None),
            ProtectedChange.TOOLS,
            save,
            lambda: tool_number not in self.offset_history.offset_book.tool_offsets,
        )

    def find_suspicious_touch_changes(
        self, tool_number: int, touch: TouchPosition, tip_x_mm: float | None = None
    ) -> tuple[SuspiciousChange, ...]:
        """Return the suspicious fields of a touch-off, the most serious first."""
        tools, travel = self.offset_history.offset_book.tool_offsets, self._travel()
        old, new = tools.get(tool_number), apply_touch_off(tools, tool_number, touch)
        found = find_suspicious_changes(tool_number, old, new, travel)
        if old is not None and old.master and not touch.applies_to_this_tool_only:
            found += find_suspicious_follower_changes(tools, tool_number, new, travel)
        if tip_x_mm is not None and (reason := self._find_position_suspicion(tool_number, tip_x_mm, new.x)):
            found += (SuspiciousChange(reason, tool_number, "x", old.x if old else None, new.x),)
        return sort_by_seriousness(found)

    def _find_position_suspicion(self, number: int, tip_x_mm: float, new_x: float) -> SuspicionReason | None:
        """Return why the position of a tip after a touch-off in X is suspicious, or None."""
        old = self.offset_history.offset_book.tool_offsets.get(number)
        if self._is_other_side(number, tip_x_mm, new_x):
            return SuspicionReason.WRONG_SIDE
        return None if old is None else find_factor_suspicion(tip_x_mm + new_x - old.offset[0], tip_x_mm)

    def _describe_followers(self, number: int, touch: TouchPosition) -> str:
        """Return the names of the tools that follow a touch-off of the master tool.

        The result is an empty string if no other tool moves.
        """
        tools = self.offset_history.offset_book.tool_offsets
        moves_all = number in tools and tools[number].master and not touch.applies_to_this_tool_only
        return format_tools_following_master(tools, number) if moves_all else ""

    def _is_other_side(self, number: int, tip: float, new_x: float) -> bool:
        """Return whether the tool would cut on the opposite side of the part after a touch-off."""
        book = self.offset_history.offset_book
        old, shape = book.tool_offsets.get(number), book.tool_shapes.get(get_tool_number(number))
        if old is not None:
            return tip * (tip + new_x - old.offset[0]) < 0.0
        return tip > 0.0 if shape is not None and shape.rear else tip < 0.0

    def _travel(self) -> Mapping[str, tuple[float, float]]:
        return find_travel_limits(self.offset_history.desk.machine.machine)

    def _ask_if_intended(
        self,
        kind: OffsetKind,
        found: tuple[SuspiciousChange, ...],
        act: ProtectedChange,
        save: Callable[[], str],
        unchanged: Callable[[], bool],
        others: str = "",
    ) -> str:
        """Save a change immediately, or after the operator's confirmation (Y) if it is suspicious.

        The change is rejected if the offsets have changed since the question was asked.
        """
        history = self.offset_history
        if (why := history.offset_book.barred(act)) or not found:
            return why or save()
        changes = describe_suspicious_changes(
            found, lambda each: self._describe_field(kind, each), lambda each: describe_suspicion(each.kind)
        )
        text = tr("{changes}. Y: CHANGE   N: KEEP OLD VALUE")
        if others:
            text = tr("{changes}. ALSO ADJUSTED: {others}. Y: CHANGE   N: KEEP")
        question = tr(Message(text, changes=changes, others=others))
        history.desk.ask_operator(
            question, lambda: history.show_refusal(save() if unchanged() else _changed_meanwhile())
        )
        return ""

    def _describe_field(self, kind: OffsetKind, each: SuspiciousChange) -> str:
        """Return the text of a suspicious change, for example "T1 X Ø +0.50000 → −1.20000"."""
        title, shown = self._find_format(kind, each.name)
        old = describe_missing_offset() if each.old_value is None else shown(each.old_value)
        return f"{_row_name(kind, each.row_number)} {title} {old} → {shown(each.new_value)}"

    def _find_format(self, kind: OffsetKind, name: str) -> tuple[str, Callable[[FieldValue], str]]:
        """Return the title of a field, and the function that formats its values."""
        mode = self.offset_history.unit_mode
        if kind is OffsetKind.TOOL:
            return make_field_heading(name, mode), lambda value: format_value(name, value, mode)
        if kind is OffsetKind.SECONDARY:
            return name.upper(), lambda value: format_signed_length(float(value), mode.is_metric)
        field = FIELDS_BY_KIND[kind][name]
        return field.label, lambda value: format_cell(field, value)

    # --- the master ----------------------------------------------------------------------------------

    def ask_to_toggle_master(self, tool_number: int) -> str:
        """Ask whether to make a tool the master tool, or to have no master tool if it already is one.

        The question names the tools that follow the master tool.
        """
        book = self.offset_history.offset_book
        tools, before = book.tool_offsets, book.master_tool_number
        if why := book.barred(ProtectedChange.TOOLS):
            return why
        chosen = 0 if before == tool_number else tool_number
        reason = tr("set as master") if chosen else tr("no master")
        self.offset_history.desk.ask_operator(
            self._master_question(before, chosen),
            lambda: self.offset_history.show_refusal(
                book.set_master_tool(chosen, reason) if book.tool_offsets == tools else _changed_meanwhile()
            ),
        )
        return ""

    def _master_question(self, before: int, chosen: int) -> str:
        if not chosen:
            text = tr("MASTER {before} → NONE: NO OTHER TOOLS WILL BE ADJUSTED. Y: CHANGE   N: KEEP")
            return tr(Message(text, before=format_edge_name(before)))
        text = tr(
            "MASTER {before} → {tool}. TOOLS ADJUSTED WITH THE MASTER: {others}. TOUCH-OFF "
            "CHANGES OVER {limit} {unit} MUST BE CONFIRMED. Y: CHANGE   N: KEEP"
        )
        mode = self.offset_history.unit_mode
        return tr(
            Message(
                text,
                before=format_edge_name(before) if before else tr("none"),
                tool=format_edge_name(chosen),
                others=format_tools_following_master(self.offset_history.offset_book.tool_offsets, chosen)
                or tr("no tools"),
                limit=f"{LARGE_CHANGE_MM / mode.unit_length_mm:.2g}",
                unit=mode.name.upper(),
            )
        )

    # --- undo ----------------------------------------------------------------------------------------

    def ask_to_undo_change(self, kind: OffsetKind, number: int | None, on_done: str = "") -> str:
        """Ask whether to undo the last change of a row, or of the table if ``number`` is None.

        ``on_done`` is the message after the undo, for pages that do not report changes to the table.
        """
        book = self.offset_history.offset_book
        if why := book.barred(find_required_access_right(kind)):
            return why
        try:
            step = book.find_undoable_changes(kind, number)
        except StoreError as error:
            return str(error)
        if not step:
            return tr(Message("NO CHANGE TO UNDO IN {row}", row=_table_or_row(kind, number)))
        chosen = next((each for each in step if each.number == number), step[0])
        _at, _which, change, _why = self.offset_history.format_change(
            chosen._replace(old=chosen.new, new=chosen.old)
        )
        others = [_row_name(kind, each.number) for each in step if each is not chosen]
        text = tr("UNDO {row}: {change}? Y: UNDO   N: KEEP")
        if others:
            text = tr("UNDO {row}: {change}, AND ALSO {others}? Y: UNDO   N: KEEP")
        words = tr(
            Message(
                text,
                row=_row_name(kind, chosen.number),
                change=change,
                others=", ".join(_shorten_names(others)),
            )
        )
        self.offset_history.desk.ask_operator(words, partial(self._undo, kind, number, step[0].step, on_done))
        return ""

    def _undo(self, kind: OffsetKind, number: int | None, step: int, done: str) -> None:
        why = self.offset_history.offset_book.undo_step(kind, number, step)
        self.offset_history.show_refusal(why)
        if done and not why:
            self.offset_history.desk.show_success(done)


def describe_suspicion(reason: SuspicionReason) -> str:
    """Return the text of the reason why a change must be confirmed."""
    words = {
        SuspicionReason.OUTSIDE_TRAVEL: tr("OUTSIDE AXIS TRAVEL"),
        SuspicionReason.WRONG_SIDE: tr("CUTS ON THE OPPOSITE SIDE OF THE PART"),
        SuspicionReason.RADIUS_ENTERED: tr("HALF OF THE OLD DIAMETER. RADIUS ENTERED?"),
        SuspicionReason.DOUBLE_DIAMETER: tr("TWICE THE OLD DIAMETER"),
        SuspicionReason.LARGE_CHANGE: tr("LARGE CHANGE"),
        SuspicionReason.NEW_MASTER: tr("OTHER TOOLS ARE ADJUSTED WITH THIS TOOL"),
    }
    return words[reason]


def _changed_meanwhile() -> str:
    return tr("OFFSETS CHANGED BEFORE YOU ANSWERED. ENTER THE VALUE AGAIN")


def _row_name(kind: OffsetKind, number: int) -> str:
    letter = NUMBER_PREFIXES[kind]
    return format_edge_name(number) if letter == "T" else f"{letter}{number}"


def _table_or_row(kind: OffsetKind, number: int | None) -> str:
    return tr("THIS TABLE") if number is None else _row_name(kind, number)


def format_tools_following_master(tools: Mapping[int, ToolOffsetRow], master: int) -> str:
    """Return the names of the tools that follow the master tool, shortened if there are many."""
    return ", ".join(
        _shorten_names([format_edge_name(number) for number in find_following_tools(tools, master)])
    )


def _shorten_names(names: list[str]) -> list[str]:
    """Return the first names, followed by a text with the number of omitted names."""
    more = len(names) - _MAX_NAMES
    return names if more <= 0 else [*names[:_MAX_NAMES], tr(Message("{count} MORE", count=more))]
