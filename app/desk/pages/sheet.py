"""What the lists of the desk are made of: a table with a question under it, a typed line, and keys."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from app.desk.arithmetic import CHARACTERS, LONGEST
from app.desk.status.machine_status import Tone

if TYPE_CHECKING:
    from core.part.tool_outline import ToolOutline

T = TypeVar("T")
STEPS = {"Up": -1, "Down": 1, "Page up": -10, "Page down": 10}  # of the mark, by keys


def following(choices: Iterable[T], now: T) -> T:
    """The next choice; the first after the last, and after one that is none of them."""
    order = list(choices)
    return order[(order.index(now) + 1) % len(order) if now in order else 0]


class RefusedText(str):
    """A typed value that was refused: the next character replaces it, Back corrects it."""

    __slots__ = ()


def refused(text: str) -> str:
    """Return a typed text marked as refused; a name is not marked, as it is corrected and not retyped."""
    return text if set(text) - CHARACTERS else RefusedText(text)


def edited(text: str, key: str, longest: int = LONGEST) -> str:
    """A text that is typed, after one more key: a character, ``Back`` or ``Delete``."""
    if key == "Back":
        return text[:-1]
    if key == "Delete":
        return ""
    return key if isinstance(text, RefusedText) else (text + key)[:longest]


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a table. ``lit`` draws its lamp, filled or hollow; None: it has none.

    A cell may have two lines where the sheet is ``tall``. ``outline`` is drawn in the last cell.
    """

    cells: tuple[str, ...]
    lit: bool | None = None
    tone: Tone = Tone.READY
    bar: float | None = None  # 0…1: how much of its last cell is filled
    outline: ToolOutline | None = None


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
    tall: bool = False  # rows high enough for two lines and a picture
    refused: bool = field(init=False)  # the next character replaces the text

    def __post_init__(self) -> None:
        object.__setattr__(self, "refused", isinstance(self.text, RefusedText))


class Key(NamedTuple):
    """A function key of a section: its label of up to eight characters, and what it does."""

    label: str
    action: Callable[[], None]
    barred: bool = False  # it would be refused now


@dataclass(slots=True)
class Entry:
    """``words``: any letter is taken; else figures and signs only."""

    words: bool = False
    text: str = ""
    offered: str = ""  # a text that the first character replaces, and Back edits

    def offer(self, text: str) -> None:
        """Start with a text that was not typed."""
        self.text = self.offered = text

    def takes(self, key: str) -> bool:
        """Whether a character belongs to it."""
        return len(key) == 1 and (self.words or key in CHARACTERS)

    def type(self, key: str) -> bool:
        """A key; False when it means nothing here. Return is the caller's."""
        taken = self.takes(key) or key in {"Back", "Delete"}
        if taken:
            replaced = self.takes(key) and self.text == self.offered
            self.text, self.offered = edited("" if replaced else self.text, key), ""
        return taken
