"""Changes of offsets: confirmation of suspicious changes, history and undo.

Every page changes offsets through these classes. A question shows the old and the new value. Y changes the
offset, and N and Esc leave it unchanged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from app.desk.desk import Desk
from app.desk.status.formats import local_time
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.change_rules import (
    LARGE_MM,
    Doubt,
    Suspicion,
    act_of,
    described,
    followers,
    of_followers,
    suspicions,
    suspicions_of,
    touched,
    travel_of,
)
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_values import Mode, cell_text, from_to, heading, not_set, shown_value, signed
from core.access.access_table import Act
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.offsets.touch_off import Touch
from core.store.store_errors import StoreError
from core.store.store_rows import FIELDS, Change, Kind, ToolRow, Value
from core.tool_edges import edge_name

LETTERS = {
    Kind.TOOL: "T",
    Kind.SHAPE: "T",
    Kind.SECONDARY: "D",
    Kind.ZERO: "G",
    Kind.MILL_TOOL: "T",
    Kind.PRESET: "PRESET ",
}


def refusal(snapshot: Snapshot, *, correction: bool) -> str:
    """Return why offsets cannot be changed now. Empty if they can.

    A correction (wear, secondary offset) may be entered while parts run, because the present part uses the
    offsets that it was proved with. A change of a tip position must wait until no program is running.
    """
    if snapshot.state in {State.JOG, State.HOME}:
        return tr("AXES ARE MOVING. WAIT UNTIL THEY STOP TO CHANGE OFFSETS")
    if snapshot.state in UNDER_WAY and not correction:
        return tr("PROGRAM RUNNING. CHANGE ONLY WEAR OR SECONDARY OFFSETS (F9)")
    return ""


def counts_from(snapshot: Snapshot) -> str:
    """Return from when a change that is entered now applies. Empty between cycles."""
    if snapshot.state not in UNDER_WAY:
        return ""
    if snapshot.cycle_repeat:
        return tr("OFFSET CHANGES APPLY FROM NEXT PART, AFTER THEY ARE PROVED")
    return tr("WEAR APPLIES FROM NEXT CYCLE START")


def _behind_saved(snapshot: Snapshot) -> str:
    """Return the text that follows SAVED in a message while parts run."""
    if snapshot.state not in UNDER_WAY:
        return ""
    if snapshot.cycle_repeat:
        return tr("; APPLIES FROM NEXT PART")
    return tr("; APPLIES FROM NEXT CYCLE START")


@dataclass(slots=True)
class OffsetHistory:
    """The history of the table ``kind``. Every page that changes the table calls ``look`` once a frame."""

    desk: Desk
    kind: Kind
    mode: Mode = field(default_factory=Mode)  # Mode of the control at the last update.
    keys: str = "F5"  # Keys that show the history on the page.
    last: tuple[Change, ...] = ()  # Changes of the last step that was saved while the page was open.
    listed: tuple[Change, ...] | None = None  # The history while it is shown, else None.
    _seen: int = 0
    _newest: int = 0  # Id of the newest change that was read.
    _asked_of: tuple[int, int | None] | None = None  # Change count and row for which ``_undoable`` is valid.
    _undoable: bool = True

    def __post_init__(self) -> None:
        self._seen = self.book.changes

    @property
    def book(self) -> OffsetBook:
        """The saved offsets."""
        return self.desk.book

    def opened(self) -> None:
        """Ignore the changes that were made before the page opened."""
        self._seen, self.last = self.book.changes, ()
        self._newest = max((change.id for change in self._read(1)), default=0)

    def look(self, snapshot: Snapshot) -> None:
        """Update the unit of the control, and report newly saved changes; called once a frame."""
        self.mode = Mode(snapshot.modal.metric, snapshot.reads_diameter)
        if self.book.changes == self._seen:
            return
        self._seen = self.book.changes
        changes = self._read()
        # The change may belong to another table, for example a tip entered on the page of the tool shape.
        fresh = bool(changes) and changes[0].id != self._newest
        self._newest = changes[0].id if changes else 0
        self.last = tuple(change for change in changes if fresh and change.step == changes[0].step)
        if self.listed is not None:
            self.listed = changes
        self.desk.done(self._saved() + _behind_saved(snapshot))

    def _saved(self) -> str:
        if not self.last:
            return tr("SAVED")
        names = " ".join(self._named(change) for change in reversed(self.last))
        if len(self.last) > 1 and self.kind is not Kind.ZERO:
            names = tr(Message("{count} OFFSETS", count=len(self.last)))
        taken_back = self.last[0].undoes is not None
        return tr(Message(tr("{names} UNDONE") if taken_back else tr("{names} SAVED"), names=names))

    def _named(self, change: Change) -> str:
        letter = LETTERS[self.kind]
        return edge_name(change.number) if letter == "T" else f"{letter}{change.number}"

    def in_words(self, change: Change) -> tuple[str, str, str, str]:
        """Return the texts of one change.

        They are the local time, the offset, its values from → to in the control's unit, and the reason with
        the user.
        """
        at = local_time(change.at)
        who = "" if change.who == "operator" else f" ({change.who})"
        which = self._named(change)
        return at, which, from_to(change.old, change.new, self.mode), f"{change.why}{who}"

    @property
    def last_in_words(self) -> str:
        """The last change in one line. Empty if nothing has changed while the page was open."""
        if len(self.last) == 1:
            _at, which, change, _why = self.in_words(self.last[0])
            return f"{which}   {change}"
        return (
            tr(
                Message(
                    "{count} offsets changed. {keys}: show the changes", count=len(self.last), keys=self.keys
                )
            )
            if self.last
            else ""
        )

    def toggle(self) -> None:
        """Show the history in place of the table, or the table again."""
        self.listed = None if self.listed is not None else self._read()

    def undoable(self, number: int | None) -> bool:
        """Return whether a change of this row can be undone. The result is cached until the next change."""
        key = self.book.changes, number
        if self._asked_of != key:
            self._asked_of, self._undoable = key, True
            with suppress(StoreError):  # ``undo`` itself reports the error.
                self._undoable = bool(self.book.undoable(self.kind, number))
        return self._undoable

    def answer(self, why: str) -> None:
        """Show a reason why something was rejected. An empty text shows nothing."""
        if why:
            self.desk.say(why)

    def _read(self, limit: int = 200) -> tuple[Change, ...]:
        try:
            return self.book.history(self.kind, limit)
        except StoreError as error:
            self.desk.say(str(error))
            return ()


_MOST_NAMES = 6  # Followers that a question lists by name.


@dataclass(frozen=True, slots=True)
class OffsetQuestions:
    """Changes of offsets with confirmation. Each method returns why it was rejected, or an empty text."""

    history: OffsetHistory

    # --- values --------------------------------------------------------------------------------------

    def change(self, kind: Kind, number: int, values: Mapping[str, Value], why: str) -> str:
        """Save some fields of an offset. Ask first if a value is suspicious."""
        book = self.history.book
        table = book.of(kind)
        return self._if_meant(
            kind,
            suspicions_of(kind, table, {number: values}, self._travel()),
            act_of(kind, values),
            lambda: book.change(kind, number, values, why),
            lambda: book.of(kind).get(number) == table.get(number),
        )

    def touch_off(self, number: int, touch: Touch, why: str, tip: float | None = None) -> str:
        """Set a tool by a touch-off. Ask first if the result is suspicious.

        ``tip`` is X of the tip relative to part zero in mm as a radius, or None if X was not touched.
        """
        book = self.history.book
        tools = book.tools
        return self._if_meant(
            Kind.TOOL,
            self.doubts(number, touch, tip),
            Act.TOOLS,
            lambda: book.touch_off(number, touch, why),
            lambda: book.tools == tools,
            self._that_follow(number, touch),
        )

    def doubts(self, number: int, touch: Touch, tip: float | None = None) -> tuple[Suspicion, ...]:
        """Return the suspicious fields of this touch-off."""
        tools, travel = self.history.book.tools, self._travel()
        old, new = tools.get(number), touched(tools, number, touch)
        found = suspicions(number, old, new, travel)
        if old is not None and old.master and not touch.alone:
            found += of_followers(tools, number, new, travel)
        if tip is not None and self._other_side(number, tip, new.x):
            found = (Suspicion(Doubt.SIDE, number, "x", old.x if old else None, new.x), *found)
        return found

    def _that_follow(self, number: int, touch: Touch) -> str:
        """Return the names of the tools that follow this touch-off. Empty if no other tool moves."""
        tools = self.history.book.tools
        moves_all = number in tools and tools[number].master and not touch.alone
        return follower_names(tools, number) if moves_all else ""

    def _other_side(self, number: int, tip: float, new_x: float) -> bool:
        """Return whether the tool would touch the other side of the part than before."""
        book = self.history.book
        old, shape = book.tools.get(number), book.shapes.get(number)
        if old is not None:
            return tip * (tip + new_x - old.offset[0]) < 0.0
        return tip > 0.0 if shape is not None and shape.rear else tip < 0.0

    def _travel(self) -> Mapping[str, tuple[float, float]]:
        return travel_of(self.history.desk.machine.model)

    def _if_meant(
        self,
        kind: Kind,
        found: tuple[Suspicion, ...],
        act: Act,
        save: Callable[[], str],
        unchanged: Callable[[], bool],
        others: str = "",
    ) -> str:
        """Save at once, or after Y if there are suspicions.

        The change is rejected if the offsets have changed since the question.
        """
        history = self.history
        if (why := history.book.barred(act)) or not found:
            return why or save()
        changes = described(found, lambda each: self._named(kind, each), lambda each: _reason(each.doubt))
        text = tr("{changes}. Y: CHANGE   N: KEEP OLD VALUE")
        if others:
            text = tr("{changes}. ALSO ADJUSTED: {others}. Y: CHANGE   N: KEEP")
        question = tr(Message(text, changes=changes, others=others))
        history.desk.ask(question, lambda: history.answer(save() if unchanged() else _changed_meanwhile()))
        return ""

    def _named(self, kind: Kind, each: Suspicion) -> str:
        """Return the text of a change, for example T1 X Ø +0.50000 → −1.20000."""
        title, shown = self._display(kind, each.name)
        old = not_set() if each.old is None else shown(each.old)
        return f"{_row_name(kind, each.number)} {title} {old} → {shown(each.new)}"

    def _display(self, kind: Kind, name: str) -> tuple[str, Callable[[Value], str]]:
        """Return the title of a field, and the function that formats its values."""
        mode = self.history.mode
        if kind is Kind.TOOL:
            return heading(name, mode), lambda value: shown_value(name, value, mode)
        if kind is Kind.SECONDARY:
            return name.upper(), lambda value: signed(float(value), mode.metric)
        field = FIELDS[kind][name]
        return field.word, lambda value: cell_text(field, value)

    # --- the master ----------------------------------------------------------------------------------

    def choose_master(self, number: int) -> str:
        """Ask whether this tool becomes the master, or no tool if it is the master. Name the followers."""
        book = self.history.book
        tools, before = book.tools, book.master
        if why := book.barred(Act.TOOLS):
            return why
        chosen = 0 if before == number else number
        reason = tr("set as master") if chosen else tr("no master")
        self.history.desk.ask(
            self._master_question(before, chosen),
            lambda: self.history.answer(
                book.choose_master(chosen, reason) if book.tools == tools else _changed_meanwhile()
            ),
        )
        return ""

    def _master_question(self, before: int, chosen: int) -> str:
        if not chosen:
            text = tr("MASTER {before} → NONE: NO OTHER TOOLS WILL BE ADJUSTED. Y: CHANGE   N: KEEP")
            return tr(Message(text, before=edge_name(before)))
        text = tr(
            "MASTER {before} → {tool}. TOOLS ADJUSTED WITH THE MASTER: {others}. TOUCH-OFF "
            "CHANGES OVER {limit} {unit} MUST BE CONFIRMED. Y: CHANGE   N: KEEP"
        )
        mode = self.history.mode
        return tr(
            Message(
                text,
                before=edge_name(before) if before else tr("none"),
                tool=edge_name(chosen),
                others=follower_names(self.history.book.tools, chosen) or tr("no tools"),
                limit=f"{LARGE_MM / mode.unit:.2g}",
                unit=mode.name.upper(),
            )
        )

    # --- undo ----------------------------------------------------------------------------------------

    def undo(self, kind: Kind, number: int | None, done: str = "") -> str:
        """Ask whether the last change of this row is undone. None means the last change of the table.

        ``done`` is shown after Y by a page that does not watch the table.
        """
        book = self.history.book
        if why := book.barred(act_of(kind)):
            return why
        try:
            step = book.undoable(kind, number)
        except StoreError as error:
            return str(error)
        if not step:
            return tr(Message("NO CHANGE TO UNDO IN {row}", row=_table_or_row(kind, number)))
        chosen = next((each for each in step if each.number == number), step[0])
        _at, _which, change, _why = self.history.in_words(chosen._replace(old=chosen.new, new=chosen.old))
        others = [_row_name(kind, each.number) for each in step if each is not chosen]
        text = tr("UNDO {row}: {change}? Y: UNDO   N: KEEP")
        if others:
            text = tr("UNDO {row}: {change}, AND ALSO {others}? Y: UNDO   N: KEEP")
        words = tr(
            Message(text, row=_row_name(kind, chosen.number), change=change, others=", ".join(_short(others)))
        )
        self.history.desk.ask(words, partial(self._undo, kind, number, step[0].step, done))
        return ""

    def _undo(self, kind: Kind, number: int | None, step: int, done: str) -> None:
        why = self.history.book.undo(kind, number, step)
        self.history.answer(why)
        if done and not why:
            self.history.desk.done(done)


def _reason(doubt: Doubt) -> str:
    words = {
        Doubt.TRAVEL: tr("OUTSIDE AXIS TRAVEL"),
        Doubt.SIDE: tr("CUTS ON THE OPPOSITE SIDE OF THE PART"),
        Doubt.LARGE: tr("LARGE CHANGE"),
        Doubt.MASTER: tr("OTHER TOOLS ARE ADJUSTED WITH THIS TOOL"),
    }
    return words[doubt]


def _changed_meanwhile() -> str:
    return tr("OFFSETS CHANGED BEFORE YOU ANSWERED. ENTER THE VALUE AGAIN")


def _row_name(kind: Kind, number: int) -> str:
    letter = LETTERS[kind]
    return edge_name(number) if letter == "T" else f"{letter}{number}"


def _table_or_row(kind: Kind, number: int | None) -> str:
    return tr("THIS TABLE") if number is None else _row_name(kind, number)


def follower_names(tools: Mapping[int, ToolRow], master: int) -> str:
    """Return the names of the tools that follow this master, shortened if there are many."""
    return ", ".join(_short([edge_name(number) for number in followers(tools, master)]))


def _short(names: list[str]) -> list[str]:
    """Return the first names and the number of the others."""
    more = len(names) - _MOST_NAMES
    return names if more <= 0 else [*names[:_MOST_NAMES], tr(Message("{count} MORE", count=more))]
