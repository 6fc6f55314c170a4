"""Program flow for all dialects: active calls, remaining repeats, and detection of endless loops."""

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
    """The main program or an active subprogram. Positions are line indices from 0.

    ``at`` is the line at which execution continues after a call, and ``end`` is one past the last line.
    ``left`` maps the line of each active repeat to the number of repeats that remain, the outermost first. A
    program from another file has the name ``file``. Its lines are shown at ``place``, the line of the main
    file with the call.
    """

    routine: Routine
    at: int
    end: int
    left: dict[int, int] = field(default_factory=dict)
    file: str = ""
    place: int = 0

    @property
    def standing(self) -> tuple[object, ...]:
        """The file, the next line and the remaining repeats, for comparison."""
        return self.file, self.at, tuple(sorted(self.left.items()))


AnyFrame = TypeVar("AnyFrame", bound=Frame[Any])


class ControlFlow(Generic[AnyFrame]):
    """Position in a program.

    ``at`` is the index of the next line, and ``end`` is the index at which execution ends.
    """

    def __init__(self, main: AnyFrame) -> None:
        self.at, self.end = main.at, main.end
        self.here = main  # the active frame; its ``at`` is updated when it calls another frame
        self.frames = [main]

    @property
    def called(self) -> bool:
        """Whether a subprogram is active."""
        return len(self.frames) > 1

    @property
    def outside(self) -> bool:
        """Whether a program from another file is active."""
        return bool(self.here.place)

    def enter(self, frame: AnyFrame) -> None:
        """Continue in a subprogram."""
        self.here.at = self.at
        self.frames.append(frame)
        self.here, self.at, self.end = frame, frame.at, frame.end

    def leave(self) -> None:
        """Return from a subprogram to the line after its call."""
        self.frames.pop()
        self._go_on()

    def _go_on(self) -> None:
        """Continue at the saved position of the last frame."""
        self.here = here = self.frames[-1]
        self.at, self.end = here.at, here.end

    def end_all(self) -> None:
        """End the program, including all active calls."""
        del self.frames[1:]
        self._go_on()
        self.at = self.end

    def shown_line(self, number: int) -> int:
        """Return the line of the main file at which line ``number`` of the active program is shown."""
        return self.here.place or number

    def located(self, found: Diagnostic) -> Diagnostic:
        """Return a finding for the main file.

        A finding in another file is moved to the line of the call, and its text states the file and the line.
        """
        here = self.here
        if not here.place:
            return found
        message = Message(
            "{source} line {line}: {value}", source=here.file, line=found.line, value=found.message
        )
        return replace(found, line=here.place, column=0, message=message)


class LoopWatch:
    """Detector of endless loops, which compares the program state at each jump back.

    A program always does the same from the same state. If a jump back occurs in the same state as an earlier
    jump, the loop is endless. The reference state is renewed at jumps 1, 2, 4, 8 and so on (Brent's cycle
    detection), so that a loop of any length is detected within three rounds. Each jump of a normal loop costs
    one comparison, which ends at the first difference.
    """

    def __init__(self) -> None:
        self._jumps = 0
        self._renew = 1
        self._kept: object = None

    def comes_round(self, flow: ControlFlow[AnyFrame], *held: object) -> bool:
        """Return whether a jump back occurs in the same state as an earlier jump.

        ``held`` are all values, other than the position, on which later jumps can depend.
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
