"""The special functions of F10: what each is to the page, their list, and the one that is open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from app.desk.desk import Desk
from app.desk.latest import Latest
from app.desk.sheet import Entry, Key, Sheet
from core.executor.snapshot import Snapshot


class SpecialFunction:
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


class FigureFunction(SpecialFunction):
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


@dataclass(slots=True)
class SpecialFunctions:
    """``at`` is the function that is shown; while ``inside`` the keys are its own, else the list's."""

    sections: Sequence[SpecialFunction]
    worker: Latest
    at: int = 0
    inside: bool = False

    @property
    def section(self) -> SpecialFunction:
        """The function that is shown."""
        return self.sections[self.at]

    def show(self, number: int) -> None:
        """Another function, seen from the list."""
        number = max(0, min(len(self.sections) - 1, number))
        if number != self.at or self.inside:
            self.section.desk.clear()
            self.section.left()
            self.at, self.inside = number, False
            self.section.opened()

    def enter(self, number: int) -> None:
        """Open a function: the keys are its own now."""
        self.show(number)
        self.inside = True

    def typed(self, key: str) -> bool:
        """Arrows and figures in the list; in a function its own keys."""
        if self.inside:
            return self.section.typed(key)
        if key in {"Up", "Down"}:
            self.show(self.at + (1 if key == "Down" else -1))
        elif key in {"Enter", "Tab"}:
            self.enter(self.at)
        elif key.isdigit() and 1 <= int(key) <= len(self.sections):
            self.enter(int(key) - 1)
        else:
            return False
        return True

    def takes(self, key: str) -> bool:
        """Whether a character is text now."""
        return self.section.takes(key) if self.inside else key.isdigit()

    def escape(self) -> bool:
        """One step back; False from the list."""
        section = self.section
        if not self.inside:
            return False
        if section.desk.notice:
            section.desk.clear()
        elif not section.escape():
            self.inside = False
        return True

    def prompt(self) -> str:
        """Of the function, or how to choose one."""
        if self.inside:
            return self.section.prompt()
        return "ARROWS OR A FIGURE CHOOSE A FUNCTION, RETURN OPENS IT; ESC FOR AUTOMATIC"

    def opened(self) -> None:
        """The page comes up with the list."""
        self.inside = False
        self.section.opened()

    def leave(self) -> None:
        """The page goes."""
        self.section.left()
        self.inside = False

    def look(self) -> None:
        """Once a frame: what the worker has found."""
        self.worker.poll()

    def close(self) -> None:
        """End the worker, and what a function has under way."""
        for section in self.sections:
            section.close()
        self.worker.close()
