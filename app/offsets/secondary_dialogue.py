"""The dialogue of F9: a number, then one question after the other, then the change is saved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum

from app.desk.arithmetic import LONGEST, EntryError, value_of
from app.desk.formats import length
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_values import Mode, added, to_mm
from core.store.store_rows import OFFSETS, RADIUS_MAX, SECONDARY_REACH, Kind, SecondaryRow

# --- What a typed value does to a secondary offset, in the control's words.


class Step(IntEnum):
    """What is asked."""

    NUMBER = 0
    X = 1
    Z = 2
    R = 3


def question(step: Step) -> str:
    """The prompt of this step; attested but for R."""
    words = (tr("Offset Number?"), tr("X DIAMETER CORRECTION?"), tr("Z CORRECTION?"), tr("R?"))
    return words[step]


def value(step: Step, old: float, typed: float, mode: Mode) -> float:
    """What ``old`` (mm) becomes: X halved and added, Z added, R becomes the value."""
    if step is Step.R:
        return to_mm(typed, mode.metric)
    return added(old, typed / 2 if step is Step.X else typed, mode.metric)


def refusal(step: Step, number: int, mm: float, mode: Mode) -> str:
    """Why a value is not kept, said in the unit of the entry; empty when it is."""
    low, high = (0.0, RADIUS_MAX) if step is Step.R else (-SECONDARY_REACH, SECONDARY_REACH)
    if low <= mm <= high:
        return ""
    text = tr("{name} would become {value} {unit}; it may be {low}…{high}")
    return text.format(
        name=f"D{number} {step.name}",
        value=length(mm, mode.metric),
        unit=mode.name,
        low=f"{low / mode.unit:g}",
        high=f"{high / mode.unit:g}",
    )


CHARACTERS = frozenset("0123456789.,+-*/()−")
KEYS = CHARACTERS | {"Back", "Delete", "Enter"}


@dataclass(slots=True)
class Dialogue:
    """One entry after the other; ``say`` answers on the prompt line, ``barred`` tells why nothing changes."""

    book: OffsetBook
    say: Callable[[str], None]
    barred: Callable[[], str]
    step: Step = Step.NUMBER
    number: int = 0
    text: str = ""
    mode: Mode = field(default_factory=Mode)
    _new: list[float] = field(default_factory=list)
    _typed: list[str] = field(default_factory=list)

    @property
    def question(self) -> str:
        """What is asked now."""
        return question(self.step)

    @property
    def old(self) -> SecondaryRow | None:
        """The offset that is being changed, as it is now."""
        return self.book.secondary.get(self.number) if self.number else None

    @property
    def preview(self) -> SecondaryRow | None:
        """What it would become if the text were entered; None while no number is chosen."""
        if not self.number:
            return None
        old = self.old or SecondaryRow()
        new = [*self._new, *old[len(self._new) :]]
        if self.text.strip() and self.step is not Step.NUMBER:
            try:
                at = self.step - 1
                new[at] = value(self.step, old[at], value_of(self.text), self.mode)
            except EntryError:
                pass  # half a sum is no mistake yet
        return SecondaryRow(*new)

    def follow(self, mode: Mode) -> None:
        """The control's mode now; an entry that was begun in another unit is given up.

        X is a diameter correction whatever the control's X is, which every part changes as it begins.
        """
        other, self.mode = mode.metric != self.mode.metric, mode
        if other and self.step is not Step.NUMBER:
            self.restart()
            self.say(tr("THE CONTROL HAS CHANGED ITS UNIT: NOTHING WAS CHANGED, ENTER IT AGAIN"))

    def restart(self) -> None:
        """Back to the number; what was entered so far is forgotten."""
        self.step, self.number, self.text = Step.NUMBER, 0, ""
        self._new, self._typed = [], []

    def type(self, key: str) -> bool:
        """A key; False when it means nothing here."""
        if key in CHARACTERS:
            if len(self.text) < LONGEST:
                self.text += key
        elif key == "Back":
            self.text = self.text[:-1]
        elif key == "Delete":
            self.text = ""
        elif key == "Enter":
            self._enter()
        else:
            return False
        return True

    def choose(self, number: int) -> None:
        """The number, by a finger on its row; in the middle of an entry it is not taken."""
        if self.step is Step.NUMBER:
            self.text = str(number)
            self._enter()
        else:
            self.say(tr("FINISH D{number} FIRST, OR PRESS ESC").format(number=self.number))

    def _enter(self) -> None:
        why = self.barred()
        if why:
            self.say(why)
            return
        try:
            self._number() if self.step is Step.NUMBER else self._value()
        except EntryError as error:
            self.say(tr("REFUSED: {why}").format(why=error))

    def _number(self) -> None:
        value = value_of(self.text)
        if value not in OFFSETS:
            raise EntryError(tr("D{number:g} does not exist; offsets are D1…32").format(number=value))
        self.number, self.step, self.text = int(value), Step.X, ""

    def _value(self) -> None:
        at, text = self.step - 1, self.text.strip()
        new = old = (self.old or SecondaryRow())[at]
        if text:
            new = value(self.step, old, value_of(text), self.mode)
            if why := refusal(self.step, self.number, new, self.mode):
                raise EntryError(why)
        typed = f"{self.step.name} {text}" if text else ""
        if self.step is not Step.R:
            self._new.append(new)
            self._typed.append(typed)
            self.step, self.text = Step(self.step + 1), ""
        else:
            self._save(SecondaryRow(self._new[0], self._new[1], new), [*self._typed, typed])

    def _save(self, new: SecondaryRow, typed: list[str]) -> None:
        if new == self.old:
            self.say(tr("D{number} IS AS IT WAS").format(number=self.number))
            self.restart()
            return
        unit = "MM " if self.mode.metric else ""
        reason = unit + " ".join(filter(None, typed))
        why = self.book.change(Kind.SECONDARY, self.number, new._asdict(), reason)
        if why:
            self.say(why)
        else:
            self.restart()
