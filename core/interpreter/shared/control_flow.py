"""Where a program goes on: calls under way, repeats that are left, and loops that never end; all dialects."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field, replace
from typing import Any, Generic, TypeVar

from core.language.diagnostics import Diagnostic
from core.message import Message

ENDLESS = "endless-loop"
"""The code of a loop that never ends, in every language."""

Routine = TypeVar("Routine")


@dataclass(slots=True)
class Frame(Generic[Routine]):
    """The main program, or a subprogram that is being executed. Positions are indices of lines, from 0.

    ``at`` is where it goes on when what it has called ends, ``end`` is one past its last line. ``left`` is
    how often each repeat under way will yet go back, by its line, outermost first. A program of another file
    has the ``file``'s name, and is shown at ``place``, the line of the main file that has called it.
    """

    routine: Routine
    at: int
    end: int
    left: dict[int, int] = field(default_factory=dict)
    file: str = ""
    place: int = 0

    @property
    def standing(self) -> tuple[object, ...]:
        """Where it goes on and what is left of its repeats, to be compared."""
        return self.file, self.at, tuple(sorted(self.left.items()))


AnyFrame = TypeVar("AnyFrame", bound=Frame[Any])


class ControlFlow(Generic[AnyFrame]):
    """The place in a program: ``at`` is the index of the line to execute next, ``end`` where it stops."""

    def __init__(self, main: AnyFrame) -> None:
        self.at, self.end = main.at, main.end
        self.here = main  # what is being executed; its ``at`` is kept when it calls
        self.frames = [main]

    @property
    def called(self) -> bool:
        """Whether the place is in a subprogram."""
        return len(self.frames) > 1

    @property
    def outside(self) -> bool:
        """Whether the place is in a program of another file."""
        return bool(self.here.place)

    def enter(self, frame: AnyFrame) -> None:
        """Go on in a subprogram."""
        self.here.at = self.at
        self.frames.append(frame)
        self.here, self.at, self.end = frame, frame.at, frame.end

    def leave(self) -> None:
        """Go on behind the call of the subprogram."""
        self.frames.pop()
        self._go_on()

    def _go_on(self) -> None:
        """In the last frame, where it stands."""
        self.here = here = self.frames[-1]
        self.at, self.end = here.at, here.end

    def end_all(self) -> None:
        """End the program: nothing comes any more."""
        del self.frames[1:]
        self._go_on()
        self.at = self.end

    def shown_line(self, number: int) -> int:
        """The line of the main file that stands for line ``number`` of the program under way."""
        return self.here.place or number

    def located(self, found: Diagnostic) -> Diagnostic:
        """A finding in a program of another file: told at its call, with file and line in its text."""
        here = self.here
        if not here.place:
            return found
        message = Message(
            "{source} line {line}: {value}", source=here.file, line=found.line, value=found.message
        )
        return replace(found, line=here.place, column=0, message=message)


class LoopWatch:
    """Compares what jumps go by whenever a program jumps back.

    A program does the same again from the same state. So when a jump back comes round with the same state as
    an earlier time, the loop has no end. What is kept for comparison is renewed at the 1st, 2nd, 4th, 8th …
    jump (Brent's cycle detection), so a round of any length is found within three of it at most, and a loop
    that ends costs one comparison a jump, which stops at the first difference.
    """

    def __init__(self) -> None:
        self._jumps = 0
        self._renew = 1
        self._kept: object = None

    def comes_round(self, flow: ControlFlow[AnyFrame], *held: object) -> bool:
        """Whether a jump back meets what an earlier one met.

        ``held`` is all that later jumps may go by beside the place, compared by its values.
        """
        flow.here.at = flow.at
        now = [each.standing for each in flow.frames], held
        if now == self._kept:
            return True
        self._jumps += 1
        if self._jumps == self._renew:
            self._renew *= 2
            self._kept = deepcopy(now)
        return False
