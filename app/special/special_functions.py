"""The special functions of F10: what each is to the page, their list, and the one that is open."""

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
    """One special function. Nothing here waits; what cannot be done is said by ``desk.say``."""

    name: ClassVar[str]
    use: ClassVar[str]
    page: ClassVar[str] = ""  # that comes up instead when it is opened

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.marked = 0

    @abstractmethod
    def sheet(self, snapshot: Snapshot) -> Sheet:
        """The table of this instant."""

    def keys(self) -> Mapping[str, Key]:
        """Its function keys, F2…F10 but for F7."""
        return {}

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        return (key == "Enter" and self.act()) or self.moves(key)

    def act(self) -> bool:
        """Return on the marked row; False where it does nothing."""
        return False

    def takes(self, _key: str) -> bool:
        """Whether a character is text now."""
        return False

    def prompt(self) -> str:
        """What stands on the prompt line."""
        return "ESC: BACK TO THE LIST"

    def escape(self) -> bool:
        """Close what is open in it; False when nothing was."""
        return False

    def opened(self) -> None:
        """The function comes up."""

    def left(self) -> None:
        """It goes: nothing stays half entered or half asked."""

    def listen(self, *, seen: bool) -> None:
        """Once a frame, where the page asks: what has come by a wire; ``seen``: it is the one shown."""

    def close(self) -> None:
        """The desk shuts: what is under way ends."""

    def choose(self, row: int) -> None:
        """A finger marks a row; on the marked one it is Return."""
        if row != self.marked:
            self.desk.clear()
            self.marked = row
        else:
            self.act()

    @property
    def count(self) -> int:
        """How many rows can be marked."""
        return 0

    def moves(self, key: str) -> bool:
        """Take the keys that move the mark."""
        if key not in STEPS or not self.count:
            return False
        self.desk.clear()
        self.marked = max(0, min(self.count - 1, self.marked + STEPS[key]))
        return True


class PageFunction(SpecialFunction):
    """What has a page of its own: a few facts of it, and Return or a finger that opens it."""

    way: ClassVar[str]  # how the page is opened besides

    @abstractmethod
    def facts(self) -> tuple[Row, ...]:
        """What is told of it in the list."""

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """The facts of this instant."""
        return Sheet(tr(self.name), ("", ""), (0.4, 0.6), self.facts(), notes=(self.way,))


class FigureFunction(SpecialFunction):
    """Figures are typed into ``entry``, which takes arithmetic; Return hands it to ``enter``."""

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.entry = Entry()

    @abstractmethod
    def take(self, text: str) -> bool:
        """Whether what was typed is taken. Raises EntryError where it is no good figure."""

    def enter(self) -> None:
        """Take what was typed, or say why it is refused."""
        try:
            if self.take(self.entry.text):
                self.entry.text = ""
        except EntryError as error:
            self.entry.text = refused(self.entry.text)
            self.desk.refuse(str(error))

    def takes(self, key: str) -> bool:
        """Whether a character is a figure or a sign."""
        return self.entry.takes(key)

    def typed(self, key: str) -> bool:
        """Figures are typed, Return takes them."""
        if key == "Enter":
            self.enter()
            return True
        if self.entry.type(key):
            self.desk.clear()
            return True
        return False

    def escape(self) -> bool:
        """Take an entry back that was begun; False when there was none."""
        begun, self.entry.text = bool(self.entry.text), ""
        return begun

    def left(self) -> None:
        """The function goes: nothing stays typed."""
        self.entry.text = ""


@dataclass(slots=True)
class SpecialFunctions:
    """``at`` is the function that is shown; while ``inside`` the keys are its own, else the list's."""

    functions: Sequence[SpecialFunction]
    worker: Latest
    at: int = 0
    inside: bool = False
    number: str = ""  # as typed in the list so far

    @property
    def current(self) -> SpecialFunction:
        """The function that is shown."""
        return self.functions[self.at]

    def show(self, number: int) -> None:
        """Another function, seen from the list."""
        self.number = ""
        number = max(0, min(len(self.functions) - 1, number))
        if number != self.at or self.inside:
            self.current.desk.clear()
            self.current.left()
            self.at, self.inside = number, False
            self.current.opened()

    def enter(self, number: int) -> None:
        """Open a function: the keys are its own now."""
        self.show(number)
        self.inside = True

    def typed(self, key: str) -> bool:
        """Mark a function by arrows or by its number, and open it by Return; in a function its own keys."""
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
        """Mark the function of the number typed so far; a digit that names none after it begins another."""
        numbers = range(1, len(self.functions) + 1)
        typed = next((each for each in (self.number + digit, digit) if int(each) in numbers), "")
        if not typed:
            words = tr("FUNCTION {number} DOES NOT EXIST: TYPE 1 TO {last}")
            self.current.desk.say(tr(Message(words, number=self.number + digit, last=len(self.functions))))
            return
        self.show(int(typed) - 1)
        self.number = typed

    def takes(self, key: str) -> bool:
        """Whether a character is text now."""
        return self.current.takes(key) if self.inside else key.isascii() and key.isdigit()

    def escape(self) -> bool:
        """One step back; False from the list."""
        shown = self.current
        if not self.inside:
            return False
        if shown.desk.notice:
            shown.desk.clear()
        elif not shown.escape():
            self.inside = False
        return True

    def prompt(self) -> str:
        """Of the function, or how to choose one."""
        if self.inside:
            return self.current.prompt()
        return "TAP A FUNCTION OR TYPE ITS NUMBER   ENTER: OPEN   ESC: BACK"

    def opened(self) -> None:
        """The page comes up with the list."""
        self.inside, self.number = False, ""
        self.current.opened()

    def leave(self) -> None:
        """The page goes: nothing stays open."""
        self.current.left()
        self.inside = False

    def look(self) -> None:
        """Once a frame: what the worker has found."""
        self.worker.poll()

    def close(self) -> None:
        """End the worker, and what a function has under way."""
        for function in self.functions:
            function.close()
        self.worker.close()
