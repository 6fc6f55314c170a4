"""Special functions of F10: their interface to the page, their list, and the function that is open."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from app.desk.arithmetic import EntryError
from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import STEPS, Entry, Key, Row, Sheet, refused
from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message


class SpecialFunction(ABC):
    """Special function of F10. No method waits, and ``desk.say`` reports rejected actions."""

    name: ClassVar[str]
    use: ClassVar[str]
    page: ClassVar[str] = ""  # page that opens instead of this function

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.marked = 0

    @abstractmethod
    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table for a snapshot."""

    def keys(self) -> Mapping[str, Key]:
        """Return the function's keys, F2 to F10 without F7."""
        return {}

    def typed(self, key: str) -> bool:
        """Handle a key. Return False to leave it to the window."""
        return (key == "Enter" and self.act()) or self.moves(key)

    def act(self) -> bool:
        """Execute the selected row. Return False if the row has no action."""
        return False

    def takes(self, _key: str) -> bool:
        """Return whether a character is text now."""
        return False

    def prompt(self) -> str:
        """Return the text of the prompt line."""
        return "ESC: BACK TO THE LIST"

    def escape(self) -> bool:
        """Close the innermost open part. Return False if nothing was open."""
        return False

    def opened(self) -> None:
        """Prepare the function for display."""

    def left(self) -> None:
        """Cancel entries and questions when the function closes."""

    def listen(self, *, seen: bool) -> None:
        """Process input from a wire, called once per frame.

        ``seen`` is set while the function is displayed.
        """

    def close(self) -> None:
        """Finish pending work when TurnDesk closes."""

    def choose(self, row: int) -> None:
        """Select the touched row. A touch on the selected row executes it."""
        if row != self.marked:
            self.desk.clear()
            self.marked = row
        else:
            self.act()

    @property
    def count(self) -> int:
        """Number of rows that can be selected."""
        return 0

    def moves(self, key: str) -> bool:
        """Move the selection by a key, and return whether the key does so."""
        if key not in STEPS or not self.count:
            return False
        self.desk.clear()
        self.marked = max(0, min(self.count - 1, self.marked + STEPS[key]))
        return True


class PageFunction(SpecialFunction):
    """Special function with a separate page: shows a few facts, and opens the page with Enter or a touch."""

    way: ClassVar[str]  # description of other keys that open the page

    @abstractmethod
    def facts(self) -> tuple[Row, ...]:
        """Return the rows of facts in the list."""

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of facts."""
        return Sheet(tr(self.name), ("", ""), (0.4, 0.6), self.facts(), notes=(self.way,))


class FigureFunction(SpecialFunction):
    """Special function with a numeric entry that accepts arithmetic.

    Enter passes the text to ``take``.
    """

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.entry = Entry()

    @abstractmethod
    def take(self, text: str) -> bool:
        """Accept the typed text.

        Return False if it was rejected with a message. Raises EntryError.
        """

    def enter(self) -> None:
        """Accept the typed text, or show the reason for its rejection."""
        try:
            if self.take(self.entry.text):
                self.entry.text = ""
        except EntryError as error:
            self.entry.text = refused(self.entry.text)
            self.desk.refuse(str(error))

    def takes(self, key: str) -> bool:
        """Return whether a character is a digit or an operator."""
        return self.entry.takes(key)

    def typed(self, key: str) -> bool:
        """Handle a key of the entry."""
        if key == "Enter":
            self.enter()
            return True
        if self.entry.type(key):
            self.desk.clear()
            return True
        return False

    def escape(self) -> bool:
        """Clear the entry. Return False if it was empty."""
        begun, self.entry.text = bool(self.entry.text), ""
        return begun

    def left(self) -> None:
        """Clear the entry when the function closes."""
        self.entry.text = ""


@dataclass(slots=True)
class SpecialFunctions:
    """List of special functions.

    ``at`` is the displayed one, which has the keys while ``inside`` is set.
    """

    functions: Sequence[SpecialFunction]
    worker: Latest
    at: int = 0
    inside: bool = False
    number: str = ""  # digits typed in the list so far

    @property
    def current(self) -> SpecialFunction:
        """Displayed function."""
        return self.functions[self.at]

    def show(self, number: int) -> None:
        """Display a function from the list."""
        self.number = ""
        number = max(0, min(len(self.functions) - 1, number))
        if number != self.at or self.inside:
            self.current.desk.clear()
            self.current.left()
            self.at, self.inside = number, False
            self.current.opened()

    def enter(self, number: int) -> None:
        """Open a function, which then receives the keys."""
        self.show(number)
        self.inside = True

    def typed(self, key: str) -> bool:
        """Handle a key: select a function by arrows or number, open it with Enter, or pass the key to it."""
        if self.inside:
            return self.current.typed(key)
        if key in {"Up", "Down"}:
            self.show(self.at + (1 if key == "Down" else -1))
        elif key in {"Enter", "Tab"}:
            self.enter(self.at)
        elif self.takes(key):
            self._type_number(key)
        else:
            return False
        return True

    def _type_number(self, digit: str) -> None:
        """Select the function of the typed number. A digit that does not fit starts a new number."""
        numbers = range(1, len(self.functions) + 1)
        typed = next((each for each in (self.number + digit, digit) if int(each) in numbers), "")
        if not typed:
            words = tr("FUNCTION {number} DOES NOT EXIST: TYPE 1 TO {last}")
            self.current.desk.say(tr(Message(words, number=self.number + digit, last=len(self.functions))))
            return
        self.show(int(typed) - 1)
        self.number = typed

    def takes(self, key: str) -> bool:
        """Return whether a character is text now."""
        return self.current.takes(key) if self.inside else key.isascii() and key.isdigit()

    def escape(self) -> bool:
        """Go back one step. Return False from the list."""
        shown = self.current
        if not self.inside:
            return False
        if shown.desk.notice:
            shown.desk.clear()
        elif not shown.escape():
            self.inside = False
        return True

    def prompt(self) -> str:
        """Return the prompt of the function or of the list."""
        if self.inside:
            return self.current.prompt()
        return "TAP A FUNCTION OR TYPE ITS NUMBER   ENTER: OPEN   ESC: BACK"

    def opened(self) -> None:
        """Show the list when the page opens."""
        self.inside, self.number = False, ""
        self.current.opened()

    def leave(self) -> None:
        """Close the function when the page closes."""
        self.current.left()
        self.inside = False

    def look(self) -> None:
        """Process the results of the worker; called once per frame."""
        self.worker.poll()

    def close(self) -> None:
        """Finish pending work of all functions and stop the worker."""
        for function in self.functions:
            function.close()
        self.worker.close()
