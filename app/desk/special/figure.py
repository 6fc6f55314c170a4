"""A special function that asks for one figure under its table."""

from __future__ import annotations

from app.desk.desk import Desk
from app.desk.special.entry import Entry
from app.desk.special.sheet import Section


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
