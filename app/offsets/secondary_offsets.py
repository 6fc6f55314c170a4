"""Secondary offsets, F9 SECCMP: a number, then one question after the other, then the change is saved.

The questions are the control's own. X is a diameter correction, halved and added; Z is added; R becomes the
value; bare Return keeps what is there.
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
    """The steps of the dialogue, in the order in which they are asked."""

    NUMBER = 0
    X = 1
    Z = 2
    R = 3


def corrected(step: Step, old: float, typed: float, mode: Mode) -> float:
    """What ``old`` (mm) becomes: X halved and added, Z added, R becomes the value."""
    if step is Step.R:
        return to_mm(typed, mode.metric)
    return added(old, typed / 2 if step is Step.X else typed, mode.metric)


class SecondaryOffsets(OffsetTable):
    """The dialogue: which number, which step, what is typed, and what was answered so far."""

    kind = Kind.SECONDARY
    own_key = "C"
    clears = "PRESS Y TO CLEAR ALL 32 SECONDARY OFFSETS, N TO KEEP THEM"
    why_cleared = "all offsets cleared with the C key"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.step, self.number = Step.NUMBER, 0
        self._answers: list[float] = []  # mm, of the steps so far
        self._typed: list[str] = []

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def heading(self) -> str:
        """The number of the offset that is being entered."""
        which = tr("Secondary offset number:")
        return f"{which} {self.number}" if self.number else which

    @property
    def question(self) -> str:
        """The prompt of this step; attested but for R."""
        words = (tr("Offset Number?"), tr("X DIAMETER CORRECTION?"), tr("Z CORRECTION?"), tr("R?"))
        return words[self.step]

    @property
    def old(self) -> SecondaryRow | None:
        """The offset that is being changed, as it is now."""
        return self.book.secondary.get(self.number) if self.number else None

    @property
    def chosen(self) -> int | None:
        """The offset whose number was entered; None: undo refers to the last change of the table."""
        return self.number or None

    @property
    def preview(self) -> SecondaryRow | None:
        """What it would become if the text were entered; None while no number is chosen."""
        if not self.number:
            return None
        old = self.old or SecondaryRow()
        new = [*self._answers, *old[len(self._answers) :]]
        if self.text.strip() and self.step is not Step.NUMBER:
            try:
                at = self.step - 1
                new[at] = corrected(self.step, old[at], value_of(self.text), self.mode)
            except EntryError:
                pass  # half a sum is no mistake yet
        return SecondaryRow(*new)

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""
        if self.step is Step.NUMBER:
            return self.history.last_in_words
        was, new = (in_words(side, self.mode) for side in (self.old, self.preview))
        return f"D{self.number}   {was}  →  {new}"

    @property
    def foot(self) -> str:
        """How to leave and how to clear, in the control's words."""
        leave = tr("Press Esc to exit offset adjustment screen")
        return f"{leave}        {tr('Press C to clear all offsets')}"

    def hint(self, snapshot: Snapshot) -> str:
        """Return what is typed now, or from when a correction counts."""
        if self.step is Step.NUMBER and not counts_from(snapshot):
            return tr("TYPE AN OFFSET NUMBER AND PRESS ENTER")
        return counts_from(snapshot) or tr("TYPE A VALUE OR EXPRESSION (.5-.002). ENTER ALONE: NO CHANGE")

    def proposed(self) -> Proposed:
        """The tables as they would be with what is being entered."""
        tools, secondary = super().proposed()
        preview = self.preview
        return tools, {**secondary, **({self.number: preview} if preview else {})}

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame; an entry that was begun in another unit is given up.

        X is a diameter correction whatever the control's X is, which every part changes as it begins.
        """
        before = self.mode
        super().look(snapshot)
        if self.mode.metric != before.metric and self.step is not Step.NUMBER:
            self.drop()
            self.desk.say(tr("CONTROL CHANGED UNITS. NOTHING SAVED. ENTER THE VALUE AGAIN"))

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Figures and signs are typed, C clears the table."""
        return key in CHARACTERS or key == "C"

    def enter_key(self, key: str) -> bool:
        """Figures are typed, Return answers."""
        if key not in _KEYS:
            return False
        self.desk.clear()
        if key == "Enter":
            self._enter()
        else:
            self.type_text(key)
        return True

    def choose(self, number: int) -> None:
        """The number, by a finger on its row; in the middle of an entry it is not taken."""
        if self.step is Step.NUMBER:
            self.text = str(number)
            self._enter()
        else:
            self.desk.say(tr(Message("FINISH ENTERING D{number} FIRST, OR PRESS ESC", number=self.number)))

    def clear(self) -> None:
        """C; not in the middle of an entry."""
        whole = self.barred(self.desk.snapshot(), correction=False)
        if not whole and self.step is not Step.NUMBER:
            self.desk.say(tr("C CLEARS ALL OFFSETS ONLY AT THE PROMPT Offset Number? PRESS ESC FIRST"))
        else:
            super().clear()

    def undo(self) -> None:
        """Ask about undoing the last change of the entered number, as long as no value follows it."""
        if self.step is not Step.X or self.text or self.undo_barred():
            super().undo()
            return
        number = self.number
        self.drop()
        self.history.answer(self.questions.undo(self.kind, number))

    def take_back(self) -> bool:
        """Take back the entry that was begun, and say so."""
        if self.step is Step.NUMBER and not self.text:
            return False
        number = self.number
        self.drop()
        self.desk.say(tr(Message("D{number} NOT CHANGED", number=number)) if number else "")
        return True

    def drop(self) -> None:
        """Back to the number; what was entered so far is forgotten."""
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
        """Raises EntryError for a value that is not kept."""
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
