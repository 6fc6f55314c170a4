"""Tables with an entry line and function keys, which the list pages of TurnDesk show."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from app.desk.arithmetic import EXPRESSION_CHARACTERS, MAX_LENGTH
from app.desk.status.machine_status import StatusTone

if TYPE_CHECKING:
    from core.part.tool_outline import ToolOutline

T = TypeVar("T")
WHOLE_LIST = 1_000_000  # Rows: more than any list has.
# Rows that the selection moves, by key. The lists limit the result to their first and last row.
ROW_STEPS = {
    "Up": -1,
    "Down": 1,
    "Page up": -10,
    "Page down": 10,
    "Home": -WHOLE_LIST,
    "End": WHOLE_LIST,
}


def following(choices: Iterable[T], current: T) -> T:
    """Return the choice that follows ``current``.

    After the last choice or an unknown ``current``, return the first choice.
    """
    order = list(choices)
    return order[(order.index(current) + 1) % len(order) if current in order else 0]


class RejectedText(str):
    """Text of a rejected value. The next typed character replaces the text, and the key Back edits it."""

    __slots__ = ()


def refused(text: str) -> str:
    """Return a rejected number as RejectedText, and a rejected name unchanged.

    The operator edits a rejected name instead of typing it again.
    """
    return text if set(text) - EXPRESSION_CHARACTERS else RejectedText(text)


def apply_edit_key(text: str, key: str, max_length: int = MAX_LENGTH) -> str:
    """Return an input text after one key press. The key is a character, ``Back`` or ``Delete``."""
    if key == "Back":
        return text[:-1]
    if key == "Delete":
        return ""
    return key if isinstance(text, RejectedText) else (text + key)[:max_length]


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row of a table.

    - ``is_lamp_lit`` determines the indicator lamp: filled if True, hollow if False, and no lamp if None.
    - A cell may have two lines if the table has ``has_tall_rows`` set.
    - ``tool_outline`` is drawn in the last cell.
    """

    cells: tuple[str, ...]
    is_lamp_lit: bool | None = None
    tone: StatusTone = StatusTone.READY
    bar_fraction: float | None = None  # Filled part of the last cell, 0…1.
    tool_outline: ToolOutline | None = None


@dataclass(frozen=True, slots=True)
class TableContent:
    """Content of a table with a title, column heads and an entry line.

    - ``relative_column_widths`` are the column widths as fractions of the table width.
    - ``marked`` is the index of the selected row, or -1 if no row is selected.
    - ``entry_prompt`` and ``text`` are shown in the entry line.
    - ``untranslated_columns`` are the columns with names and user texts, which are not translated.
    """

    title: str
    column_heads: tuple[str, ...]
    relative_column_widths: tuple[float, ...]
    rows: tuple[TableRow, ...]
    marked: int = -1
    entry_prompt: str = ""
    text: str = ""
    notes: tuple[str, ...] = ()
    untranslated_columns: frozenset[int] = frozenset()
    numeric_columns: frozenset[int] = frozenset()  # Columns that are right-aligned, for numbers.
    has_tall_rows: bool = False  # Rows are high enough for two lines and a drawing.
    is_entry_rejected: bool = field(init=False)  # The next character replaces the text.

    def __post_init__(self) -> None:
        object.__setattr__(self, "is_entry_rejected", isinstance(self.text, RejectedText))


class FunctionKey(NamedTuple):
    """Function key of a page, with its label of up to eight characters and its action."""

    label: str
    action: Callable[[], None]
    barred: bool = False  # The action would be rejected now.


@dataclass(slots=True)
class InputField:
    """Input field for text or for numbers.

    If ``words`` is True, the field accepts any character. Otherwise it accepts only the characters of
    numbers.
    """

    words: bool = False
    text: str = ""
    proposed_text: str = ""  # A proposed text that the first character replaces and Back edits.

    def propose(self, text: str) -> None:
        """Show a proposed text, which the first typed character replaces."""
        self.text = self.proposed_text = text

    def accepts_key(self, key: str) -> bool:
        """Return whether this character can be entered in the field."""
        return len(key) == 1 and (self.words or key in EXPRESSION_CHARACTERS)

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the field does not use it. The caller handles Return."""
        taken = self.accepts_key(key) or key in {"Back", "Delete"}
        if taken:
            replaced = self.accepts_key(key) and self.text == self.proposed_text
            self.text, self.proposed_text = apply_edit_key("" if replaced else self.text, key), ""
        return taken
