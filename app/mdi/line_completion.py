"""Codes for the line of MDI: what is typed is completed, and what stands at the cursor looked up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.pages.code_help import CodeHelp
from app.mdi.mdi_line import LONGEST, MdiLine
from core.language.code_book import CodeBook, Entry

CONTINUED = "~"  # a block of Klartext goes on in the next line


@dataclass(slots=True)
class LineCompletion:
    """The same code help as the editor's, over one line. ``open``: the choices have the arrow keys."""

    typing: MdiLine
    book: Callable[[], CodeBook]
    codes: CodeHelp = field(default_factory=CodeHelp)
    open: bool = False

    def turn(self) -> None:
        """Open the choices for what stands before the cursor, or close them."""
        self.open = not self.open
        if self.open:
            self.codes.follow(self.book(), self.typing.text, self.typing.at + 1)
            self.codes.ask()

    def typed(self, key: str) -> bool:
        """Tab opens the choices; open, arrows look through them, and any other key goes to the line."""
        if not self.open:
            if key == "Tab":
                self.turn()
            return self.open
        match key:
            case "Up" | "Down":
                self.codes.mark(self.codes.marked + (1 if key == "Down" else -1))
            case "Left" | "Right":
                self.codes.turn(1 if key == "Right" else -1)
            case "Enter" | "Tab":
                self.take()
            case _:
                self.open = False
        return self.open or key in ("Enter", "Tab")

    def take(self) -> None:
        """The marked code into the line, in the place of what has been typed of it."""
        self.open, chosen = False, self.codes.chosen
        if chosen is None:
            return
        text, at = self.typing.text, self.typing.at
        begin = self.codes.begin - 1 if self.codes.begin else at
        written = _in_one_line(chosen, LONGEST - len(text) + at - begin)
        if written:
            self.typing.put(text[:begin] + written + text[at:], begin + len(written))


def _in_one_line(entry: Entry, room: int) -> str:
    """What completion writes, its continued lines in one; the head alone where that is too long.

    Empty where not even the head fits.
    """
    lines = entry.written.splitlines()
    joined = len(lines) == 1 or all(line.rstrip().endswith(CONTINUED) for line in lines[:-1])
    whole = " ".join(" ".join(line.rstrip().removesuffix(CONTINUED).split()) for line in lines)
    fitting = (each for each in ((whole,) if joined else ()) + (entry.head,) if len(each) <= room)
    return next(fitting, "")
