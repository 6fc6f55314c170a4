"""Fields of a tool, typed into one by one: what the table of tool offsets and the shape of a tool share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar

from app.desk.arithmetic import CHARACTERS, LONGEST, EntryError
from app.desk.sheet import refused
from app.desk.translation import tr
from app.offsets.offset_changes import OffsetHistory, OffsetQuestions
from app.offsets.offset_table import OffsetTable
from app.offsets.offset_values import TOOL_FIELDS, heading, shown_value, value_added, value_typed, word
from core.message import Message
from core.store.store_rows import Kind, Sort, ToolRow, Value
from core.tool_edges import edge_name, edge_number


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
