"""The model of the secondary offsets (F9 SECCMP), which asks for a number and then for X, Z and R.

The questions are those of the original control. X is a diameter correction, which is halved and added. Z is
added. R replaces the value. Enter without a value leaves the present value.
"""

from __future__ import annotations

from enum import IntEnum

from app.desk.arithmetic import CHARACTERS, EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import refused
from app.desk.status.formats import length
from app.desk.translation import tr
from app.offsets.offset_changes import counts_from
from app.offsets.offset_table import OffsetTable, Proposed
from app.offsets.offset_values import Mode, added, in_words, out_of_range, to_mm
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import OFFSETS, RADIUS_MAX, SECONDARY_REACH, Kind, SecondaryRow

_KEYS = CHARACTERS | {"Back", "Delete", "Enter"}


class Step(IntEnum):
    """The steps of the dialogue, in order."""

    NUMBER = 0
    X = 1
    Z = 2
    R = 3


def corrected(step: Step, old: float, typed: float, mode: Mode) -> float:
    """Return the new value in mm for an entry: X is halved and added, Z is added, R replaces the value."""
    if step is Step.R:
        return to_mm(typed, mode.metric)
    return added(old, typed / 2 if step is Step.X else typed, mode.metric)


class SecondaryOffsets(OffsetTable):
    """The dialogue with its number, step, entered text and previous answers."""

    kind = Kind.SECONDARY
    own_key = "C"
    clears = "PRESS Y TO CLEAR ALL 32 SECONDARY OFFSETS, N TO KEEP THEM"
    why_cleared = "all offsets cleared with the C key"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.step, self.number = Step.NUMBER, 0
        self._answers: list[float] = []  # New values of the previous steps in mm.
        self._typed: list[str] = []

    # --- display -------------------------------------------------------------------------------------

    @property
    def heading(self) -> str:
        """The number of the offset that is being entered."""
        which = tr("Secondary offset number:")
        return f"{which} {self.number}" if self.number else which

    @property
    def question(self) -> str:
        """The prompt of this step. All prompts except R are those of the original control."""
        words = (tr("Offset Number?"), tr("X DIAMETER CORRECTION?"), tr("Z CORRECTION?"), tr("R?"))
        return words[self.step]

    @property
    def old(self) -> SecondaryRow | None:
        """The present values of the offset that is being changed. None if it is not set."""
        return self.book.secondary.get(self.number) if self.number else None

    @property
    def chosen(self) -> int | None:
        """The entered number, or None, which means that undo applies to the last change of the table."""
        return self.number or None

    @property
    def preview(self) -> SecondaryRow | None:
        """The offset as it would be with the entered text. None if no number is selected."""
        if not self.number:
            return None
        old = self.old or SecondaryRow()
        new = [*self._answers, *old[len(self._answers) :]]
        if self.text.strip() and self.step is not Step.NUMBER:
            try:
                at = self.step - 1
                new[at] = corrected(self.step, old[at], value_of(self.text), self.mode)
            except EntryError:
                pass  # An incomplete expression is not an error yet.
        return SecondaryRow(*new)

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last change."""
        if self.step is Step.NUMBER:
            return self.history.last_in_words
        was, new = (in_words(side, self.mode) for side in (self.old, self.preview))
        return f"D{self.number}   {was}  →  {new}"

    @property
    def foot(self) -> str:
        """The hint how to exit and how to clear the table, in the words of the original control."""
        leave = tr("Press Esc to exit offset adjustment screen")
        return f"{leave}        {tr('Press C to clear all offsets')}"

    def hint(self, snapshot: Snapshot) -> str:
        """Return how to answer the question, or from when a correction applies."""
        if self.step is Step.NUMBER and not counts_from(snapshot):
            return tr("TYPE AN OFFSET NUMBER AND PRESS ENTER")
        return counts_from(snapshot) or tr("TYPE A VALUE OR EXPRESSION (.5-.002). ENTER ALONE: NO CHANGE")

    def proposed(self) -> Proposed:
        """Return the offsets as they would be with the present entry."""
        tools, secondary = super().proposed()
        preview = self.preview
        return tools, {**secondary, **({self.number: preview} if preview else {})}

    def look(self, snapshot: Snapshot) -> None:
        """Update the unit of the control; called once a frame. A change of the unit discards the entry.

        X is always a diameter correction. A change of the control's diameter mode therefore has no effect.
        """
        before = self.mode
        super().look(snapshot)
        if self.mode.metric != before.metric and self.step is not Step.NUMBER:
            self.drop()
            self.desk.say(tr("CONTROL CHANGED UNITS. NOTHING SAVED. ENTER THE VALUE AGAIN"))

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Return whether a character can be entered: number characters, or C to clear the table."""
        return key in CHARACTERS or key == "C"

    def enter_key(self, key: str) -> bool:
        """Handle a text key, or Enter to answer the question."""
        if key not in _KEYS:
            return False
        self.desk.clear()
        if key == "Enter":
            self._enter()
        else:
            self.type_text(key)
        return True

    def choose(self, number: int) -> None:
        """Select an offset by touch. This is rejected while another offset is being entered."""
        if self.step is Step.NUMBER:
            self.text = str(number)
            self._enter()
        else:
            self.desk.say(tr(Message("FINISH ENTERING D{number} FIRST, OR PRESS ESC", number=self.number)))

    def clear(self) -> None:
        """Handle C: clear the table, but not while an offset is being entered."""
        whole = self.barred(self.desk.snapshot(), correction=False)
        if not whole and self.step is not Step.NUMBER:
            self.desk.say(tr("C CLEARS ALL OFFSETS ONLY AT THE PROMPT Offset Number? PRESS ESC FIRST"))
        else:
            super().clear()

    def undo(self) -> None:
        """Ask whether the last change of the entered number is undone, if no value has been entered yet."""
        if self.step is not Step.X or self.text or self.undo_barred():
            super().undo()
            return
        number = self.number
        self.drop()
        self.history.answer(self.questions.undo(self.kind, number))

    def take_back(self) -> bool:
        """Discard the entry and show this. Return False if nothing was entered."""
        if self.step is Step.NUMBER and not self.text:
            return False
        number = self.number
        self.drop()
        self.desk.say(tr(Message("D{number} NOT CHANGED", number=number)) if number else "")
        return True

    def drop(self) -> None:
        """Return to the first step, and discard all answers."""
        self.step, self.number, self.text = Step.NUMBER, 0, ""
        self._answers, self._typed = [], []

    def _enter(self) -> None:
        if why := self.barred(self.desk.snapshot(), correction=True):
            self.desk.say(why)
            return
        try:
            self._take_number() if self.step is Step.NUMBER else self._take_value()
        except EntryError as error:
            self.text = refused(self.text)
            self.desk.say(tr(Message("REJECTED: {why}", why=error)))

    def _take_number(self) -> None:
        value = value_of(self.text)
        if value not in OFFSETS:
            raise EntryError(tr(Message("D{number:g} does not exist; offsets are D1…32", number=value)))
        self.number, self.step, self.text = int(value), Step.X, ""

    def _take_value(self) -> None:
        at, text = self.step - 1, self.text.strip()
        new = old = (self.old or SecondaryRow())[at]
        if text:
            new = corrected(self.step, old, value_of(text), self.mode)
            self._check(new)
        typed = f"{self.step.name} {text}" if text else ""
        if self.step is not Step.R:
            self._answers.append(new)
            self._typed.append(typed)
            self.step, self.text = Step(self.step + 1), ""
        else:
            self._save(SecondaryRow(self._answers[0], self._answers[1], new), [*self._typed, typed])

    def _check(self, mm: float) -> None:
        """Check the range of a value. Raises EntryError."""
        low, high = (0.0, RADIUS_MAX) if self.step is Step.R else (-SECONDARY_REACH, SECONDARY_REACH)
        if not low <= mm <= high:
            unit, name = self.mode.unit, f"D{self.number} {self.step.name}"
            figure = length(mm, self.mode.metric)
            raise EntryError(out_of_range(name, figure, self.mode.name, low / unit, high / unit))

    def _save(self, new: SecondaryRow, typed: list[str]) -> None:
        if new == self.old:
            self.desk.say(tr(Message("D{number} NOT CHANGED", number=self.number)))
            self.drop()
            return
        reason = ("MM " if self.mode.metric else "") + " ".join(filter(None, typed))
        why = self.questions.change(self.kind, self.number, new._asdict(), reason)
        if why:
            self.desk.say(why)
        else:
            self.drop()
