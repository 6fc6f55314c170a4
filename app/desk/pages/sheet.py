"""Tables with an entry line and function keys, as the list pages of TurnDesk use them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from app.desk.arithmetic import CHARACTERS, LONGEST
from app.desk.status.machine_status import Tone

if TYPE_CHECKING:
    from core.part.tool_outline import ToolOutline

T = TypeVar("T")
STEPS = {"Up": -1, "Down": 1, "Page up": -10, "Page down": 10}  # Rows that the selection moves, by key.


def following(choices: Iterable[T], now: T) -> T:
    """Return the choice after ``now``, in a cycle. An unknown ``now`` gives the first choice."""
    order = list(choices)
    return order[(order.index(now) + 1) % len(order) if now in order else 0]


class RefusedText(str):
    """A rejected value: the next character replaces it, and Back edits it."""

    __slots__ = ()


def refused(text: str) -> str:
    """Return a rejected text as RefusedText, unless it is a name, which is edited and not retyped."""
    return text if set(text) - CHARACTERS else RefusedText(text)


def edited(text: str, key: str, longest: int = LONGEST) -> str:
    """Return an input text after one more key: a character, ``Back`` or ``Delete``."""
    if key == "Back":
        return text[:-1]
    if key == "Delete":
        return ""
    return key if isinstance(text, RefusedText) else (text + key)[:longest]


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a table.

    ``lit`` draws a lamp, filled if True and hollow if False; None draws no lamp. A cell may have two lines if
    the table is ``tall``. ``outline`` is drawn in the last cell.
    """

    cells: tuple[str, ...]
    lit: bool | None = None
    tone: Tone = Tone.READY
    bar: float | None = None  # Filled part of the last cell, 0…1.
    outline: ToolOutline | None = None


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table with a title, column heads and an entry line.

    ``shares`` divide the table's width. ``marked`` is the index of the selected row, -1 for none.
    ``question`` and ``text`` are the entry line. Cells of the columns ``raw`` contain names and user texts,
    which are not translated.
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
    figures: frozenset[int] = frozenset()  # Columns that are right-aligned, for numbers.
    tall: bool = False  # Rows are high enough for two lines and a drawing.
    refused: bool = field(init=False)  # The next character replaces the text.

    def __post_init__(self) -> None:
        object.__setattr__(self, "refused", isinstance(self.text, RefusedText))


class Key(NamedTuple):
    """A function key of a page: its label of up to eight characters, and its action."""

    label: str
    action: Callable[[], None]
    barred: bool = False  # The action would be rejected now.


@dataclass(slots=True)
class Entry:
    """An input field. With ``words``, it accepts any character, otherwise only characters of numbers."""

    words: bool = False
    text: str = ""
    offered: str = ""  # A proposed text that the first character replaces and Back edits.

    def offer(self, text: str) -> None:
        """Set a proposed text, which the first character replaces."""
        self.text = self.offered = text

    def takes(self, key: str) -> bool:
        """Return whether this character can be entered in the field."""
        return len(key) == 1 and (self.words or key in CHARACTERS)

    def type(self, key: str) -> bool:
        """Handle a key. Return False if the key has no meaning here. The caller handles Return."""
        taken = self.takes(key) or key in {"Back", "Delete"}
        if taken:
            replaced = self.takes(key) and self.text == self.offered
            self.text, self.offered = edited("" if replaced else self.text, key), ""
        return taken
