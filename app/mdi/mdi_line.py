"""The line of MDI: its text with a cursor, and the lines before it."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field

from app.desk.persistence import Persistence
from core.store.store_errors import StoreError

KEY = "mdi"
LONGEST = 120  # characters of a line
KEPT = 100  # lines


@dataclass(slots=True)
class MdiLine:
    """One line with a cursor; arrows up and down go through the history, as in every shell."""

    persistence: Persistence = field(default_factory=Persistence)
    text: str = ""
    at: int = 0  # the cursor stands before this character
    history: list[str] = field(default_factory=list)  # oldest first
    refused: dict[str, int] = field(
        default_factory=dict
    )  # lines of it that do not run: column, from 1; 0: whole
    back: int = 0  # how far up the history the text comes from, 0: it is being typed
    _draft: str = ""

    def __post_init__(self) -> None:
        self.reload()

    def reload(self) -> None:
        """Read the history that is kept; what is no list of lines is forgotten."""
        try:
            kept = self.persistence.setting(KEY)
        except StoreError:
            kept = None
        lines = kept if isinstance(kept, list) else []
        self.history = [line for line in lines if isinstance(line, str)][-KEPT:]

    def type(self, key: str) -> bool:
        """A character or an editing key; False when it means nothing here."""
        match key:
            case "Back":
                self._cut(self.at - 1)
            case "Delete":
                self._cut(self.at)
            case "Left" | "Right":
                self.at = max(0, min(len(self.text), self.at + (1 if key == "Right" else -1)))
            case "Up" | "Down":
                self.recall(self.back + (1 if key == "Up" else -1))
            case _ if len(key) == 1 and key.isprintable():
                if len(self.text) < LONGEST:
                    self.put(self.text[: self.at] + key + self.text[self.at :], self.at + 1)
            case _:
                return False
        return True

    def put(self, text: str, at: int | None = None) -> None:
        """Another text, the cursor there or at its end."""
        self.text = text
        self.at = len(text) if at is None else at

    def recall(self, back: int) -> None:
        """Take up the line that stands so far up the history; 0: what was being typed."""
        if not 0 <= back <= len(self.history):
            return
        if not self.back:
            self._draft = self.text
        self.back = back
        self.put(self.history[-back] if back else self._draft)

    def done(self) -> None:
        """The line has been started: it goes into the history, and an empty one begins."""
        self.refused.pop(self.text, None)
        self._remember()
        self.put("")
        self.back, self._draft = 0, ""

    def refuse(self, column: int) -> None:
        """The line does not run: it stays to be mended, and stands in the history with its word marked."""
        self._remember()
        self.refused[self.text] = column
        self.refused = {line: at for line, at in self.refused.items() if line in self.history}
        self.back = 0

    def _remember(self) -> None:
        if self.text.strip() and (not self.history or self.history[-1] != self.text):
            self.history = [*self.history, self.text][-KEPT:]
            with suppress(StoreError):  # the desk says by itself that nothing is kept
                self.persistence.save_setting(KEY, self.history)

    def _cut(self, index: int) -> None:
        if 0 <= index < len(self.text):
            self.put(self.text[:index] + self.text[index + 1 :], index)
