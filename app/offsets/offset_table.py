"""Tables of offsets that the operator changes: what all have in common, and the fields of a tool.

A page shows the table, the line that is typed under it, the history, and what a change does to the path.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from app.desk.arithmetic import CHARACTERS, LONGEST, EntryError
from app.desk.desk import Desk
from app.desk.pages.sheet import edited, refused
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_changes import OffsetHistory, OffsetQuestions, refusal
from app.offsets.offset_values import TOOL_FIELDS, Mode, heading, shown_value, value_added, value_typed, word
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import Kind, SecondaryRow, Sort, ToolRow, Value
from core.tool_edges import edge_name, edge_number

Proposed = tuple[Mapping[int, ToolRow], Mapping[int, SecondaryRow]]


class OffsetTable(ABC):
    """One of the three tables; each has its own way to enter a value. The page only draws."""

    kind: ClassVar[Kind]
    clears: ClassVar[str] = ""  # what C asks before it clears the whole table; empty: C is no key here
    own_key: str = ""  # a letter that does something on this page, for the pad of a finger
    why_cleared: ClassVar[str] = ""  # in the history
    text: str = ""  # what is typed as the answer

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.history = OffsetHistory(desk, self.kind)

    @property
    def book(self) -> OffsetBook:
        """The offsets as they are saved."""
        return self.desk.book

    @property
    def mode(self) -> Mode:
        """The control's unit, and whether its X is a diameter."""
        return self.history.mode

    @property
    def questions(self) -> OffsetQuestions:
        """The changes that are asked before they take effect."""
        return OffsetQuestions(self.history)

    @property
    def chosen(self) -> int | None:
        """The number of the chosen row, which undo refers to; None if no row is chosen."""
        return None

    # --- what each table has of its own --------------------------------------------------------------

    @property
    def heading(self) -> str:
        """Which offset is being entered, where the question does not say it."""
        return ""

    @property
    @abstractmethod
    def question(self) -> str:
        """What the operator is asked to type now."""

    @property
    def is_writing(self) -> bool:
        """Whether a text is open, which takes letters."""
        return False

    @property
    def entered(self) -> str:
        """What is typed, as the entry shows it."""
        return self.text

    @property
    @abstractmethod
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""

    @property
    @abstractmethod
    def foot(self) -> str:
        """What can be done beside answering."""

    @abstractmethod
    def hint(self, snapshot: Snapshot) -> str:
        """How a value is entered, or from when it will count, for the prompt line."""

    @abstractmethod
    def takes(self, key: str) -> bool:
        """Whether a character goes to the entry."""

    @abstractmethod
    def enter_key(self, key: str) -> bool:
        """A key of the entry; False when it means nothing here."""

    @abstractmethod
    def take_back(self) -> bool:
        """Forget what is being entered and say so; False when there was nothing."""

    @abstractmethod
    def drop(self) -> None:
        """Forget what is being entered."""

    def proposed(self) -> Proposed:
        """Tool and secondary offsets as they would be with what is being entered."""
        return self.book.tools, self.book.secondary

    # --- when something may change: each says why not, or nothing -------------------------------------

    @property
    def corrects(self) -> bool:
        """Whether what is being entered is a correction, which may be made while parts run."""
        return True

    def barred(self, snapshot: Snapshot, *, correction: bool) -> str:
        """Why nothing may be changed now."""
        return self.book.locked or refusal(snapshot, correction=correction)

    def undo_barred(self) -> str:
        """Why the last change is not taken back now."""
        return self.barred(self.desk.snapshot(), correction=self.kind is Kind.SECONDARY)

    # --- the page ------------------------------------------------------------------------------------

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        if why := self.barred(snapshot, correction=self.corrects):
            return why
        if self.history.listed is not None:
            return tr("PAGE UP, PAGE DOWN: SCROLL   F5 OR ESC: CLOSE HISTORY")
        return self.hint(snapshot)

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: follow the control's unit, and see what has been saved."""
        self.history.look(snapshot)

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if key in {"c", "C"} and self.clears:
            self.clear()
            return True
        return self.enter_key(key)

    def type_text(self, key: str, longest: int = LONGEST) -> None:
        """A character more, or less."""
        self.text = edited(self.text, key, longest)

    def undo(self) -> None:
        """Drop what is being entered; if nothing is, ask about undoing the last change of the chosen row."""
        why = self.undo_barred()
        if why or not self.take_back():
            self.history.answer(why or self.questions.undo(self.kind, self.chosen))

    def clear(self) -> None:
        """C: clear the whole table, after asking."""
        if why := self.barred(self.desk.snapshot(), correction=False):
            self.desk.say(why)
        else:
            self.desk.ask(tr(self.clears), self._clear_all)

    def _clear_all(self) -> None:
        why = self.barred(self.desk.snapshot(), correction=False)
        self.history.answer(why or self.book.clear(self.kind, self.why_cleared))

    def escape(self) -> bool:
        """Esc closes the history, keeps the offsets, takes an entry back; False when the page may be left."""
        if self.history.listed is not None:
            self.history.listed = None
        elif self.desk.asked:
            self.desk.clear()
        else:
            return self.take_back()
        return True

    def opened(self) -> None:
        """The page comes up: what was changed on another is no news here."""
        self.history.opened()

    def leave(self) -> None:
        """The page goes: nothing stays half entered."""
        self.drop()
        self.desk.clear()
        self.history.listed = None


@dataclass(slots=True)
class NewTool:
    """X or Z alone of a tool that was never set: half an offset would run into the part, so it waits."""

    number: int = 0
    values: dict[str, Value] = field(default_factory=dict)
    tip: float | None = None  # X of the tip from part zero when it was touched, mm

    def add(self, number: int, name: str, value: Value) -> dict[str, Value]:
        """One of the two; answers what there is of this tool now."""
        if number != self.number:
            self.drop()
        self.values = {**self.values, name: value}
        self.number = number
        return self.values

    def drop(self) -> None:
        """It is not to be set after all."""
        self.number, self.values, self.tip = 0, {}, None

    @property
    def missing(self) -> str:
        """The axis that is still to come."""
        return "x" if "z" in self.values else "z"


@dataclass(slots=True)
class ToolFields:
    """Saves single fields of tools, for F8 and the Jog page. Each answer is why not, or nothing."""

    history: OffsetHistory
    new: NewTool = field(default_factory=NewTool)

    def never_set(self, number: int) -> str:
        """Why a tool that nobody has set has no fields."""
        text = tr("T{number} IS NOT SET. TYPE X AND Z, OR TOUCH OFF ON THE JOG PAGE")
        return tr(Message(text, number=edge_number(number)))

    def save(self, number: int, name: str, text: str, *, adding: bool = False) -> str:
        """Set a field to what is typed, or add that to it. Raises EntryError for a text that is no value."""
        mode, row = self.history.mode, self.history.book.tools.get(number)
        if row is None:
            return self._first(number, name, value_typed(name, text, mode))
        value = value_added(name, row, text, mode) if adding else value_typed(name, text, mode)
        if value == getattr(row, name):
            self.history.desk.say(tr(Message("T{number} NOT CHANGED", number=edge_number(number))))
            return ""
        typed = f"{'MM ' if mode.metric else ''}{word(name)} {'+ ' if adding else ''}{text.strip()}"
        return OffsetQuestions(self.history).change(Kind.TOOL, number, {name: value}, typed)

    def _first(self, number: int, name: str, value: Value) -> str:
        """X and Z of a tool that was never set are saved together."""
        if name not in {"x", "z"}:
            return self.never_set(number)
        values = self.new.add(number, name, value)
        if len(values) < 2:
            text = tr("NOW ENTER {axis}. T{number} IS SET WHEN BOTH X AND Z ARE ENTERED")
            self.history.desk.say(tr(Message(text, axis=word(self.new.missing), number=edge_number(number))))
            return ""
        why = OffsetQuestions(self.history).change(Kind.TOOL, number, values, tr("manual entry"))
        if not why:
            self.new.drop()
        return why

    def master(self, number: int) -> str:
        """Ask whether this tool becomes the master; or, if it is the master, whether no tool is."""
        if number not in self.history.book.tools:
            return self.never_set(number)
        return OffsetQuestions(self.history).choose_master(number)


class ToolEntry(OffsetTable):
    """One field under the cursor, and what is typed there. A text takes letters once Return has opened it."""

    to_write: ClassVar[str]  # what a letter is answered with before
    writing = False  # a text is open

    @property
    def number(self) -> int:
        """The tool at which the pages of tools stand."""
        return self.book.at

    @property
    def chosen(self) -> int | None:
        """Undo refers to this tool."""
        return self.number

    @property
    def tool(self) -> ToolRow | None:
        """Its offset; None when it was never set."""
        return self.book.tools.get(self.number)

    @property
    @abstractmethod
    def name(self) -> str:
        """The field under the cursor."""

    @property
    @abstractmethod
    def value_before(self) -> str:
        """The field as it is, without what is typed."""

    def cell_barred(self) -> str:
        """Why the field under the cursor may not be changed now; empty when it may."""
        return self.barred(self.desk.snapshot(), correction=self.corrects)

    @property
    def is_text(self) -> bool:
        """Whether the field takes any text, which Return opens."""
        field = TOOL_FIELDS[self.name]
        return field.sort is Sort.TEXT and not field.choices

    @property
    def question(self) -> str:
        """The tool and the field under the cursor."""
        return f"{edge_name(self.number)}  {heading(self.name, self.mode)}?"

    @property
    def old_to_new(self) -> str:
        """The field before and after what is typed, or else the last change."""
        if not (self.text or self.writing):
            return self.history.last_in_words
        try:
            new = shown_value(self.name, value_typed(self.name, self.text, self.mode), self.mode)
        except EntryError:
            new = "…"  # half a sum is no mistake yet
        return f"{self.value_before}  →  {new}"

    def takes(self, key: str) -> bool:
        """Figures and signs; every character while a text is written."""
        return self.writing or key in CHARACTERS

    def enter_key(self, key: str) -> bool:
        """Return sets what is typed; the page goes from field to field before."""
        if key == "Enter":
            self.enter()
        elif key in {"Back", "Delete"}:
            self.type_text(key)
        elif len(key) == 1 and self.takes(key):
            self._add(key)
        else:
            return False
        return True

    @abstractmethod
    def enter(self) -> None:
        """Return on the field."""

    def _add(self, key: str) -> None:
        if self.is_text and not self.writing:
            self.desk.say(tr(self.to_write))
            return
        if not self.text:
            self.desk.clear()
        self.type_text(key, int(TOOL_FIELDS[self.name].high) if self.writing else LONGEST)

    def left_open(self) -> bool:
        """Whether something is typed and not entered, which keeps the cursor where it is; that is said."""
        if self.text or self.writing:
            self.desk.say(tr("ENTER: SET   ESC: CANCEL"))
        return bool(self.text or self.writing)

    def store(self, save: Callable[[], str]) -> bool:
        """Save the field; what is refused is said, and the text stays to be mended."""
        barred = self.cell_barred()
        try:
            why = barred or save()
        except EntryError as error:
            why = tr(Message("REJECTED: {why}", why=error))
        if why:
            self.text = self.text if barred else refused(self.text)
            self.desk.say(why)
            return False
        self.text, self.writing = "", False
        return True

    @property
    def entering(self) -> bool:
        """Whether there is anything that Esc takes back."""
        return bool(self.text or self.writing)

    def take_back(self) -> bool:
        """What is typed or chosen, or an open text."""
        if not self.entering:
            return False
        self.drop()
        self.desk.say(tr(Message("T{number} NOT CHANGED", number=edge_number(self.number))))
        return True

    def drop(self) -> None:
        """Forget what is typed or chosen."""
        self.text, self.writing = "", False
