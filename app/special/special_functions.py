"""The list of special functions, and the one that is open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.desk.latest import Latest
from app.special.section import Section


@dataclass(slots=True)
class SpecialDesk:
    """``at`` is the function that is shown; while ``inside`` the keys are its own, else the list's."""

    sections: Sequence[Section]
    worker: Latest
    at: int = 0
    inside: bool = False

    @property
    def section(self) -> Section:
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
