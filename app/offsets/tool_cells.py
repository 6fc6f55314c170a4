"""Saving one field of a tool: by the table of F8 and by the Jog page alike."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.translation import tr
from app.offsets.offset_history import Ledger
from app.offsets.offset_values import value_added, value_typed, word
from core.store.store_rows import Kind, Value


@dataclass(slots=True)
class NewTool:
    """X or Z alone of a tool that was never set: half an offset would run into the part, so it waits."""

    number: int = 0
    values: dict[str, Value] = field(default_factory=dict)

    def add(self, number: int, name: str, value: Value) -> dict[str, Value]:
        """One of the two; answers what there is of this tool now."""
        self.values = {**(self.values if number == self.number else {}), name: value}
        self.number = number
        return self.values

    def drop(self) -> None:
        """It is not to be set after all."""
        self.number, self.values = 0, {}

    @property
    def missing(self) -> str:
        """The axis that is still to come."""
        return "x" if "z" in self.values else "z"


@dataclass(slots=True)
class ToolCells:
    """Each answer is why a field was not saved, or nothing."""

    ledger: Ledger
    new: NewTool = field(default_factory=NewTool)

    def never(self, number: int) -> str:
        """Why a tool that nobody has set has no fields."""
        return tr("T{number} WAS NEVER SET: TYPE X AND Z FIRST, OR TOUCH IT OFF ON THE JOG PAGE").format(
            number=number
        )

    def save(self, number: int, name: str, text: str, *, adding: bool = False) -> str:
        """Set a field to what is typed, or add that to it. Raises EntryError for a text that is no value."""
        mode, row = self.ledger.mode, self.ledger.book.tools.get(number)
        if row is None:
            return self._first(number, name, value_typed(name, text, mode))
        value = value_added(name, row, text, mode) if adding else value_typed(name, text, mode)
        if value == getattr(row, name):
            self.ledger.desk.say(tr("T{number} IS AS IT WAS").format(number=number))
            return ""
        typed = f"{'MM ' if mode.metric else ''}{word(name)} {'+ ' if adding else ''}{text.strip()}"
        return self.ledger.book.change(Kind.TOOL, number, {name: value}, typed)

    def _first(self, number: int, name: str, value: Value) -> str:
        """X and Z of a tool that was never set are saved together."""
        if name not in {"x", "z"}:
            return self.never(number)
        values = self.new.add(number, name, value)
        if len(values) < 2:
            text = tr("NOW {axis}: T{number} IS SET WHEN BOTH ARE THERE")
            self.ledger.desk.say(text.format(axis=word(self.new.missing), number=number))
            return ""
        why = self.ledger.book.change(Kind.TOOL, number, values, tr("entered by hand"))
        if not why:
            self.new.drop()
        return why

    def master(self, number: int) -> str:
        """A tool becomes the one that the others are relative to; being it already, none is."""
        row = self.ledger.book.tools.get(number)
        if row is None:
            return self.never(number)
        if row.master:
            return self.ledger.book.choose_master(0, tr("no master"))
        return self.ledger.book.choose_master(number, tr("chosen as master"))
