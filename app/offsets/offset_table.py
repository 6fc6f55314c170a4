"""A table of offsets that the operator changes: what tool, secondary and zero offsets have in common.

A page shows the table, the line that is typed under it, the history, and what a change does to the path.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import ClassVar

from app.desk.arithmetic import LONGEST
from app.desk.desk import Desk
from app.desk.sheet import edited
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_changes import OffsetHistory, OffsetQuestions, refusal
from app.offsets.offset_values import Mode
from core.executor.snapshot import Snapshot
from core.store.store_rows import Kind, SecondaryRow, ToolRow

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
