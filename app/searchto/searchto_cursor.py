"""Choosing a line of a program: by its number, by a text in it, or by going there."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from app.desk.arithmetic import line_of
from app.desk.pages.sheet import edited

_PASS = re.compile(r"\s*(\d+)\s*[Pp]\s*(\d+)\s*")
LONGEST = 60  # characters of what is typed
_QUOTE = '"'


@dataclass(slots=True)
class LineCursor:
    """A line of the program, counted from 1, and what is being typed to find another."""

    lines: Sequence[str] = ()
    line: int = 1
    text: str = ""
    found: bool = False  # the line was found by the text as it stands

    @property
    def number(self) -> int | None:
        """The number of a line that was typed, a sum too; None when it is a text to look for."""
        passes = _PASS.fullmatch(self.text)
        return int(passes[1]) if passes else line_of(self.text)

    @property
    def visit(self) -> int:
        """The pass that was typed behind the line, such as ``8P4``; 0: none was."""
        passes = _PASS.fullmatch(self.text)
        return int(passes[2]) if passes else 0

    @property
    def wanted(self) -> str:
        """The text to look for; a quotation mark in front makes figures a text."""
        return self.text.removeprefix(_QUOTE).upper()

    def show(self, lines: Sequence[str], line: int) -> None:
        """Another program, or another line to begin with."""
        self.lines, self.text, self.found = lines, "", False
        self.go(line)

    def go(self, line: int) -> None:
        """To this line, or the nearest there is."""
        self.line = max(1, min(line, len(self.lines)))

    def type(self, key: str) -> bool:
        """A character or an editing key; False when it means nothing here."""
        taken = key in {"Back", "Delete"} or (len(key) == 1 and key.isprintable())
        if taken:
            self.text, self.found = edited(self.text, key, LONGEST), False
        return taken

    def find(self, way: int) -> bool:
        """To the next (1) or the previous (-1) line that holds the text, round the end; False: in none."""
        count, wanted = len(self.lines), self.wanted
        if not wanted:
            return False
        for step in range(1, count + 1):
            at = (self.line - 1 + way * step) % count
            if wanted in self.lines[at].upper():
                self.line, self.found = at + 1, True
                return True
        return False
