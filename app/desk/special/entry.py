"""One line that is typed: a number by arithmetic, or words."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.arithmetic import LONGEST
from app.desk.offsets.dialogue import CHARACTERS


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
