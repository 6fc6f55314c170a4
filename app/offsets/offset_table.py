"""Base class of the offset tables that the operator edits, and entry of the fields of a tool.

A page shows the table, the entry line below it, the history, and the effect of a change on the path.
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
    """Base class of the models of offset pages. Each subclass has its own entry method."""

    kind: ClassVar[Kind]
    clears: ClassVar[str] = ""  # Question before C clears the whole table; empty if C has no function.
    own_key: str = ""  # A letter with a function on this page, for the number pad.
    why_cleared: ClassVar[str] = ""  # Reason for the history.
    text: str = ""  # The entered text.

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.history = OffsetHistory(desk, self.kind)

    @property
    def book(self) -> OffsetBook:
        """The saved offsets."""
        return self.desk.book

    @property
    def mode(self) -> Mode:
        """The control's unit, and whether its X is a diameter."""
        return self.history.mode

    @property
    def questions(self) -> OffsetQuestions:
        """The changes that are confirmed before they take effect."""
        return OffsetQuestions(self.history)

    @property
    def chosen(self) -> int | None:
        """The number of the selected row, to which undo applies. None if no row is selected."""
        return None

    # --- members that each table defines -------------------------------------------------------------

    @property
    def heading(self) -> str:
        """The name of the offset that is being entered, if the question does not contain it."""
        return ""

    @property
    @abstractmethod
    def question(self) -> str:
        """The question that the operator must answer now."""

    @property
    def is_writing(self) -> bool:
        """Whether a text that accepts letters is being edited."""
        return False

    @property
    def entered(self) -> str:
        """The entered text, as the entry line shows it."""
        return self.text

    @property
    @abstractmethod
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last change."""

    @property
    @abstractmethod
    def foot(self) -> str:
        """The hint about other keys."""

    @abstractmethod
    def hint(self, snapshot: Snapshot) -> str:
        """Return how a value is entered, or from when it will apply, for the prompt line."""

    @abstractmethod
    def takes(self, key: str) -> bool:
        """Return whether a character can be entered."""

    @abstractmethod
    def enter_key(self, key: str) -> bool:
        """Handle a key of the entry. Return False if the key has no meaning here."""

    @abstractmethod
    def take_back(self) -> bool:
        """Discard the entry and show this. Return False if nothing was entered."""

    @abstractmethod
    def drop(self) -> None:
        """Discard the entry."""

    def proposed(self) -> Proposed:
        """Return the tool and secondary offsets as they would be with the present entry."""
        return self.book.tools, self.book.secondary

    # --- conditions: each returns the reason for a refusal, or an empty text --------------------------

    @property
    def corrects(self) -> bool:
        """Whether the entry is a correction, which may be made while parts run."""
        return True

    def barred(self, snapshot: Snapshot, *, correction: bool) -> str:
        """Return why the table cannot be changed now. Empty if it can."""
        return self.book.locked or refusal(snapshot, correction=correction)

    def undo_barred(self) -> str:
        """Return why the last change cannot be undone now. Empty if it can."""
        return self.barred(self.desk.snapshot(), correction=self.kind is Kind.SECONDARY)

    # --- the page ------------------------------------------------------------------------------------

    def prompt(self, snapshot: Snapshot) -> str:
        """Return the page's prompt."""
        if why := self.barred(snapshot, correction=self.corrects):
            return why
        if self.history.listed is not None:
            return tr("PAGE UP, PAGE DOWN: SCROLL   F5 OR ESC: CLOSE HISTORY")
        return self.hint(snapshot)

    def look(self, snapshot: Snapshot) -> None:
        """Update the unit of the control, and report saved changes; called once a frame."""
        self.history.look(snapshot)

    def typed(self, key: str) -> bool:
        """Handle a key. Return False to leave the key to the window."""
        if key in {"c", "C"} and self.clears:
            self.clear()
            return True
        return self.enter_key(key)

    def type_text(self, key: str, longest: int = LONGEST) -> None:
        """Edit the entered text by one key."""
        self.text = edited(self.text, key, longest)

    def undo(self) -> None:
        """Discard the entry, or else ask whether the last change of the selected row is undone."""
        why = self.undo_barred()
        if why or not self.take_back():
            self.history.answer(why or self.questions.undo(self.kind, self.chosen))

    def clear(self) -> None:
        """Handle C: clear the whole table after the operator confirms."""
        if why := self.barred(self.desk.snapshot(), correction=False):
            self.desk.say(why)
        else:
            self.desk.ask(tr(self.clears), self._clear_all)

    def _clear_all(self) -> None:
        why = self.barred(self.desk.snapshot(), correction=False)
        self.history.answer(why or self.book.clear(self.kind, self.why_cleared))

    def escape(self) -> bool:
        """Handle Esc: close the history, a question or the entry. Return False if nothing was open."""
        if self.history.listed is not None:
            self.history.listed = None
        elif self.desk.asked:
            self.desk.clear()
        else:
            return self.take_back()
        return True

    def opened(self) -> None:
        """Ignore the changes that were made before the page opened."""
        self.history.opened()

    def leave(self) -> None:
        """Discard unfinished entries before the page closes."""
        self.drop()
        self.desk.clear()
        self.history.listed = None


@dataclass(slots=True)
class NewTool:
    """X or Z of a tool that is not set yet. It is saved only with the other value.

    A tool with half an offset could run into the part.
    """

    number: int = 0
    values: dict[str, Value] = field(default_factory=dict)
    tip: float | None = None  # X of the tip relative to part zero at the touch-off in mm.

    def add(self, number: int, name: str, value: Value) -> dict[str, Value]:
        """Add one of the two values, and return the values that are known."""
        if number != self.number:
            self.drop()
        self.values = {**self.values, name: value}
        self.number = number
        return self.values

    def drop(self) -> None:
        """Discard the values."""
        self.number, self.values, self.tip = 0, {}, None

    @property
    def missing(self) -> str:
        """The axis whose value is still missing."""
        return "x" if "z" in self.values else "z"


@dataclass(slots=True)
class ToolFields:
    """Saves single fields of tools, for F8 and the Jog page.

    Each method returns why it was rejected, or an empty text.
    """

    history: OffsetHistory
    new: NewTool = field(default_factory=NewTool)

    def never_set(self, number: int) -> str:
        """Return the message that this tool is not set."""
        text = tr("T{number} IS NOT SET. TYPE X AND Z, OR TOUCH OFF ON THE JOG PAGE")
        return tr(Message(text, number=edge_number(number)))

    def save(self, number: int, name: str, text: str, *, adding: bool = False) -> str:
        """Set a field to the entered value, or add the value to it.

        Raises EntryError for an invalid value.
        """
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
        """Save X and Z of a new tool when both are known."""
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
        """Ask whether this tool becomes the master, or whether no tool is if it is the master now."""
        if number not in self.history.book.tools:
            return self.never_set(number)
        return OffsetQuestions(self.history).choose_master(number)


class ToolEntry(OffsetTable):
    """A tool table with a field under the cursor and its entered text.

    A text field accepts letters after Enter has opened it.
    """

    to_write: ClassVar[str]  # Message for a letter before the text is open.
    writing = False  # A text is being edited.

    @property
    def number(self) -> int:
        """The tool that the tool pages have selected."""
        return self.book.at

    @property
    def chosen(self) -> int | None:
        """The selected tool, to which undo applies."""
        return self.number

    @property
    def tool(self) -> ToolRow | None:
        """The offset of the selected tool. None if the tool was never set."""
        return self.book.tools.get(self.number)

    @property
    @abstractmethod
    def name(self) -> str:
        """The field under the cursor."""

    @property
    @abstractmethod
    def value_before(self) -> str:
        """The saved value of the field as text."""

    def cell_barred(self) -> str:
        """Return why the field under the cursor cannot be changed now. Empty if it can."""
        return self.barred(self.desk.snapshot(), correction=self.corrects)

    @property
    def is_text(self) -> bool:
        """Whether the field accepts any text, which Enter opens."""
        field = TOOL_FIELDS[self.name]
        return field.sort is Sort.TEXT and not field.choices

    @property
    def question(self) -> str:
        """The tool and the field under the cursor."""
        return f"{edge_name(self.number)}  {heading(self.name, self.mode)}?"

    @property
    def old_to_new(self) -> str:
        """The field's old and entered value, or else the last change."""
        if not (self.text or self.writing):
            return self.history.last_in_words
        try:
            new = shown_value(self.name, value_typed(self.name, self.text, self.mode), self.mode)
        except EntryError:
            new = "…"  # An incomplete expression is not an error yet.
        return f"{self.value_before}  →  {new}"

    def takes(self, key: str) -> bool:
        """Return whether a character can be entered: number characters, or any character in an open text."""
        return self.writing or key in CHARACTERS

    def enter_key(self, key: str) -> bool:
        """Handle Enter and text keys. Subclasses handle the keys that move the cursor."""
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
        """Handle Enter on the field."""

    def _add(self, key: str) -> None:
        if self.is_text and not self.writing:
            self.desk.say(tr(self.to_write))
            return
        if not self.text:
            self.desk.clear()
        self.type_text(key, int(TOOL_FIELDS[self.name].high) if self.writing else LONGEST)

    def left_open(self) -> bool:
        """Return whether an unfinished entry prevents moving the cursor, and show this."""
        if self.text or self.writing:
            self.desk.say(tr("ENTER: SET   ESC: CANCEL"))
        return bool(self.text or self.writing)

    def store(self, save: Callable[[], str]) -> bool:
        """Save the field with ``save``. Show why it was rejected; the text then remains for correction."""
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
        """Whether there is an entry that Esc can discard."""
        return bool(self.text or self.writing)

    def take_back(self) -> bool:
        """Discard the entry or close an open text. Return False if there is neither."""
        if not self.entering:
            return False
        self.drop()
        self.desk.say(tr(Message("T{number} NOT CHANGED", number=edge_number(self.number))))
        return True

    def drop(self) -> None:
        """Discard the entry."""
        self.text, self.writing = "", False
