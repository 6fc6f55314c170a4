"""Changes of offsets that are asked before they take effect: suspicious values, a master, undo.

Every page changes offsets through this class. A question names the old and the new value; Y changes the
offset, N and Esc leave it as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from app.desk.translation import tr
from app.offsets.offset_acts import act_of
from app.offsets.offset_history import LETTERS, OffsetHistory
from app.offsets.offset_values import cell_text, heading, not_set, shown_value, signed
from app.offsets.suspicious_changes import (
    LARGE_MM,
    Doubt,
    Suspicion,
    described,
    followers,
    of_followers,
    suspicions,
    suspicions_of,
    touched,
    travel_of,
)
from core.access.access_table import Act
from core.message import Message
from core.store.offsets.touch_off import Touch
from core.store.store_errors import StoreError
from core.store.store_rows import FIELDS, Kind, ToolRow, Value
from core.tool_edges import edge_name

_MOST_NAMES = 6  # followers that a question lists by name


@dataclass(frozen=True, slots=True)
class OffsetQuestions:
    """Changes of the offsets of one page. Each method returns why it refused, or an empty string."""

    history: OffsetHistory

    # --- values --------------------------------------------------------------------------------------

    def change(self, kind: Kind, number: int, values: Mapping[str, Value], why: str) -> str:
        """Save some fields of an offset; ask first if a value is suspicious."""
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
        """Set a tool by a touch-off; ask first if the result is suspicious.

        ``tip`` is X of the tip from part zero by this touch (mm, a radius), None if X was not measured so.
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
        """Return what is questionable about this touch-off."""
        tools, travel = self.history.book.tools, self._travel()
        old, new = tools.get(number), touched(tools, number, touch)
        found = suspicions(number, old, new, travel)
        if old is not None and old.master and not touch.alone:
            found += of_followers(tools, number, new, travel)
        if tip is not None and self._other_side(number, tip, new.x):
            found = (Suspicion(Doubt.SIDE, number, "x", old.x if old else None, new.x), *found)
        return found

    def _that_follow(self, number: int, touch: Touch) -> str:
        """Return the names of the tools that this touch-off moves too; empty if it moves no other tool."""
        tools = self.history.book.tools
        moves_all = number in tools and tools[number].master and not touch.alone
        return follower_names(tools, number) if moves_all else ""

    def _other_side(self, number: int, tip: float, new_x: float) -> bool:
        """Return whether the tool would touch on the other side of the part than before."""
        book = self.history.book
        old, shape = book.tools.get(number), book.shapes.get(number)
        if old is not None:
            return tip * (tip + new_x - old.offset[0]) < 0.0
        return tip > 0.0 if shape is not None and shape.rear else tip < 0.0

    def _travel(self) -> Mapping[str, tuple[float, float]]:
        return travel_of(self.history.desk.lathe)

    def _if_meant(
        self,
        kind: Kind,
        found: tuple[Suspicion, ...],
        act: Act,
        save: Callable[[], str],
        unchanged: Callable[[], bool],
        others: str = "",
    ) -> str:
        """Save at once, or after Y if there are suspicions and nothing has changed meanwhile."""
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
        """T1 X Ø +0.50000 → −1.20000"""
        title, shown = self._display(kind, each.name)
        old = not_set() if each.old is None else shown(each.old)
        return f"{_row_name(kind, each.number)} {title} {old} → {shown(each.new)}"

    def _display(self, kind: Kind, name: str) -> tuple[str, Callable[[Value], str]]:
        """Return the title of a field, and how its values are shown."""
        mode = self.history.mode
        if kind is Kind.TOOL:
            return heading(name, mode), lambda value: shown_value(name, value, mode)
        if kind is Kind.SECONDARY:
            return name.upper(), lambda value: signed(float(value), mode.metric)
        field = FIELDS[kind][name]
        return field.word, lambda value: cell_text(field, value)

    # --- the master ----------------------------------------------------------------------------------

    def choose_master(self, number: int) -> str:
        """Ask whether this tool becomes the master, or no tool if it is the master; name the followers."""
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
        """Ask whether the last change of this row is taken back; None: the last change of the table.

        ``done`` is reported after Y by a page that does not watch the table.
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
    """Return the names of the tools that follow this master, the first few of many."""
    return ", ".join(_short([edge_name(number) for number in followers(tools, master)]))


def _short(names: list[str]) -> list[str]:
    """Return the first names, and how many more there are."""
    more = len(names) - _MOST_NAMES
    return names if more <= 0 else [*names[:_MOST_NAMES], tr(Message("{count} MORE", count=more))]
