"""What every special function shows and takes: a table, perhaps a question under it, and its own keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from app.desk.arithmetic import CHARACTERS, LONGEST
from app.desk.desk import Desk
from app.desk.machine_status import Tone
from core.executor.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a table. ``lit`` draws its lamp, filled or hollow; None: it has none."""

    cells: tuple[str, ...]
    lit: bool | None = None
    tone: Tone = Tone.READY


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table with a head line; ``shares`` divide its width, ``marked`` is the row keys act on, -1: none.

    ``question`` and ``text`` are the entry below it; cells of the columns ``raw`` are names and texts of
    others, which nobody translates.
    """

    title: str
    heads: tuple[str, ...]
    shares: tuple[float, ...]
    rows: tuple[Row, ...]
    marked: int = -1
    question: str = ""
    text: str = ""
    notes: tuple[str, ...] = ()
    raw: frozenset[int] = frozenset()
    figures: frozenset[int] = frozenset()  # columns that stand at the right, as figures do


class Key(NamedTuple):
    """A function key of a section: its label of up to eight characters, and what it does."""

    label: str
    action: Callable[[], None]


class Section:
    """One special function. Nothing here waits; what cannot be done is said by ``desk.say``."""

    name: ClassVar[str]
    use: ClassVar[str]

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.marked = 0

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """The table of this instant."""
        raise NotImplementedError

    def keys(self) -> Mapping[str, Key]:
        """Its function keys, F2…F10 but for F7."""
        return {}

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        return self.moves(key)

    def takes(self, _key: str) -> bool:
        """Whether a character is text now."""
        return False

    def prompt(self) -> str:
        """What stands on the prompt line."""
        return "ESC GOES BACK TO THE LIST"

    def escape(self) -> bool:
        """Close what is open in it; False when nothing was."""
        return False

    def opened(self) -> None:
        """It comes up."""

    def left(self) -> None:
        """It goes: nothing stays half entered or half asked."""

    def close(self) -> None:
        """The desk shuts: what is under way ends."""

    def choose(self, row: int) -> None:
        """A finger on a row."""
        self.marked = row

    @property
    def count(self) -> int:
        """How many rows can be marked."""
        return 0

    def moves(self, key: str) -> bool:
        """Take the keys that move the mark."""
        steps = {"Up": -1, "Down": 1, "Page up": -10, "Page down": 10}
        if key not in steps or not self.count:
            return False
        self.desk.clear()
        self.marked = max(0, min(self.count - 1, self.marked + steps[key]))
        return True


# --- One line that is typed: a number by arithmetic, or words.


@dataclass(slots=True)
class Entry:
    """``words``: any letter is taken; else figures and signs only."""

    words: bool = False
    text: str = ""

    def takes(self, key: str) -> bool:
        """Whether a character belongs to it."""
        return len(key) == 1 and (self.words or key in CHARACTERS)

    def type(self, key: str) -> bool:
        """A key; False when it means nothing here. Return is the caller's."""
        if self.takes(key):
            self.text = (self.text + key)[:LONGEST]
        elif key == "Back":
            self.text = self.text[:-1]
        elif key == "Delete":
            self.text = ""
        else:
            return False
        return True


# --- A special function that asks for one figure under its table.


class FigureSection(Section):
    """Figures are typed into ``entry``, which takes arithmetic; Return hands it to ``enter``."""

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.entry = Entry()

    def enter(self) -> None:
        """Take what was typed, or say by ``desk.say`` why it is refused."""
        raise NotImplementedError

    def takes(self, key: str) -> bool:
        """Figures and signs."""
        return self.entry.takes(key)

    def typed(self, key: str) -> bool:
        """Figures, then Return."""
        if key == "Enter":
            self.enter()
            return True
        if self.entry.type(key):
            self.desk.clear()
            return True
        return False

    def escape(self) -> bool:
        """An entry that was begun."""
        begun, self.entry.text = bool(self.entry.text), ""
        return begun

    def left(self) -> None:
        """Nothing stays typed."""
        self.entry.text = ""
