"""The dialogue of an offset page: a number, then one question after the other, then the change is saved.

Both pages ask in this way; they differ in their words and in what a typed value does (``Rules``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Protocol

from app.desk.arithmetic import LONGEST, EntryError, value_of
from app.desk.formats import MM_PER_INCH, length
from app.desk.offsets.book import OffsetBook
from app.desk.offsets.figures import Triple
from core.store.rows import OFFSETS, RADIUS_MAX, Kind

CHARACTERS = frozenset("0123456789.,+-*/()−")
KEYS = CHARACTERS | {"Back", "Delete", "Enter"}
ZERO = (0.0, 0.0, 0.0)


class Step(IntEnum):
    """What is asked."""

    NUMBER = 0
    X = 1
    Z = 2
    R = 3


@dataclass(frozen=True, slots=True)
class Mode:
    """The control's unit and whether X is a diameter, from one snapshot."""

    metric: bool = False
    diameter: bool = False


class Rules(Protocol):
    """What differs between the two pages."""

    kind: Kind
    letter: str
    reach: float  # mm

    def question(self, step: Step, mode: Mode) -> str: ...

    def value(self, step: Step, old: float, typed: float, mode: Mode) -> float: ...

    def refusal(self, step: Step, old: Triple | None) -> str: ...


@dataclass(slots=True)
class Dialogue:
    """One entry after the other; ``say`` answers on the prompt line, ``barred`` tells why nothing changes."""

    rules: Rules
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
        return self.rules.question(self.step, self.mode)

    @property
    def old(self) -> Triple | None:
        """The offset that is being changed, as it is now."""
        return self.book.of(self.rules.kind, self.number) if self.number else None

    @property
    def preview(self) -> Triple | None:
        """What it would become if the text were entered; None while no number is chosen."""
        if not self.number:
            return None
        old = self.old or ZERO
        new = [*self._new, *old[len(self._new) :]]
        if self.text.strip() and self.step is not Step.NUMBER:
            try:
                at = self.step - 1
                new[at] = self.rules.value(self.step, old[at], value_of(self.text), self.mode)
            except EntryError:
                pass  # half a sum is no mistake yet
        return new[0], new[1], new[2]

    def follow(self, mode: Mode) -> None:
        """The control's mode now; an entry that was begun in another one is given up."""
        if mode != self.mode:
            begun = self.step is not Step.NUMBER
            self.mode = mode
            if begun:
                self.restart()
                self.say("THE CONTROL HAS CHANGED ITS UNIT OR ITS X: NOTHING WAS CHANGED, ENTER IT AGAIN")

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
            self.say(f"FINISH {self.rules.letter}{self.number} FIRST, OR PRESS ESC")

    def _enter(self) -> None:
        why = self.barred()
        if why:
            self.say(why)
            return
        try:
            self._number() if self.step is Step.NUMBER else self._value()
        except EntryError as error:
            self.say(f"REFUSED: {error}")

    def _number(self) -> None:
        value = value_of(self.text)
        if value not in OFFSETS:
            letter = self.rules.letter
            raise EntryError(f"{letter}{value:g} does not exist; offsets are {letter}1…32")
        self.number, self.step, self.text = int(value), Step.X, ""

    def _value(self) -> None:
        at, text = self.step - 1, self.text.strip()
        old = (self.old or ZERO)[at]
        new = old
        if text:
            new = self.rules.value(self.step, old, value_of(text), self.mode)
            self._check(new)
        elif why := self.rules.refusal(self.step, self.old):
            raise EntryError(why)
        typed = f"{'XZR'[at]} {text}" if text else ""
        if self.step is not Step.R:
            self._new.append(new)
            self._typed.append(typed)
            self.step, self.text = Step(self.step + 1), ""
        else:
            self._save((self._new[0], self._new[1], new), [*self._typed, typed])

    def _check(self, mm: float) -> None:
        """Within the range of the table, said in the unit of the entry."""
        metric, letter = self.mode.metric, f"{self.rules.letter}{self.number} {'XZR'[self.step - 1]}"
        low, high = (0.0, RADIUS_MAX) if self.step is Step.R else (-self.rules.reach, self.rules.reach)
        if not low <= mm <= high:
            unit = 1.0 if metric else MM_PER_INCH
            name = "mm" if metric else "in"
            raise EntryError(
                f"{letter} would become {length(mm, metric)} {name}; it may be {low / unit:g}…{high / unit:g}"
            )

    def _save(self, new: Triple, typed: list[str]) -> None:
        if new == self.old:
            self.say(f"{self.rules.letter}{self.number} IS AS IT WAS")
            self.restart()
            return
        unit = "MM " if self.mode.metric else ""
        why = self.book.change(self.rules.kind, self.number, new, unit + " ".join(filter(None, typed)))
        if why:
            self.say(why)
        else:
            self.restart()
