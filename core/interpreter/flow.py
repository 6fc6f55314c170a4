"""Where a program goes next: loops, subroutine calls, the end."""

from __future__ import annotations

from copy import copy

from core.interpreter.begin import FlowPlace, Run
from core.interpreter.log import refusal
from core.interpreter.statement import Statement
from core.interpreter.structure import Structure, call_target
from core.interpreter.told import DEEPEST_CALL
from core.language.diagnostics import ProgramError


class Flow:
    """The place in a program: ``at`` is the index of the line to execute next, ``end`` where it stops."""

    def __init__(self, structure: Structure) -> None:
        self.at = 0
        self.end = self._run_end = structure.main_end  # the latter of the subroutine under way, if any
        self._stop: int | None = None  # index of a line before which it stops, wherever it comes to it
        self._structure = structure
        self._loops: list[list[int]] = []  # index of LS, passes left
        self._calls: list[tuple[int, int, list[list[int]]]] = []  # where to go on, end there, loops there

    def twin(self) -> Flow:
        """The same place, to go on from there by itself."""
        twin = copy(self)
        twin._loops = [loop[:] for loop in self._loops]
        twin._calls = [(at, end, [loop[:] for loop in loops]) for at, end, loops in self._calls]
        return twin

    def stop(self) -> None:
        """Nothing comes any more."""
        self._stop = None
        self.end = self.at

    @property
    def called(self) -> bool:
        """Whether the place is in a subroutine."""
        return bool(self._calls)

    def until(self, line: int) -> None:
        """Stop before this line, counted from 1, in whatever pass or call it comes next."""
        self._stop = line - 1
        self._bound()

    @property
    def stopped(self) -> bool:
        """Whether the line of ``until`` is what would be executed next."""
        return self._stop is not None and self.at == self._stop

    def pass_stop(self) -> None:
        """Execute the line of ``until`` this time, and stop when it comes again."""
        self.end = self._run_end

    @property
    def place(self) -> FlowPlace:
        """The line, and the loops and calls under way, outermost first: equal where all to come is."""
        runs = [
            Run(back, end, tuple((start, left) for start, left in loops)) for back, end, loops in self._calls
        ]
        here = Run(self.at, self._run_end, tuple((start, left) for start, left in self._loops))
        return (*runs, here)

    def resume(self, line: int, place: FlowPlace) -> None:
        """Be before this line, counted from 1, with these loops and calls under way."""
        self.at = line - 1
        if place:
            self._calls = [(run.back, run.end, [list(each) for each in run.loops]) for run in place[:-1]]
            self._loops = [list(each) for each in place[-1].loops]
            self.end = self._run_end = place[-1].end

    def _bound(self) -> None:
        """The run goes to its end, or to where it has to stop before."""
        stop = self._stop
        self.end = stop if stop is not None and self.at <= stop < self._run_end else self._run_end

    def passes_left(self, start: int) -> int:
        """How often the inner loop will go back from its LF; 0 where its LS is not that of this index."""
        return self._loops[-1][1] if self._loops and self._loops[-1][0] == start else 0

    def passed(self, times: int) -> None:
        """The inner loop has been gone through so often, each time back to its first line."""
        self._loops[-1][1] -= times

    def steer(self, made: Statement) -> None:
        """Follow a line that steers. Raises ProgramError for calls nested too deep."""
        flow = made.flow
        here = made.line - 1
        self.at = here + 1
        if flow == "LS" and here in self._structure.loop_ends:
            self._loops.append([here, int(made.value("LS") or 1) - 1])
        elif flow == "LF":
            self._loop_end(here)
        elif flow == "M99":
            self._return()
        self._bound()

    def call(self, made: Statement) -> None:
        """Go to the subroutine that the line names."""
        number = call_target(made)
        self.at = made.line
        if number not in self._structure.subroutines:
            return  # told when the program was read
        if len(self._calls) >= DEEPEST_CALL:
            text = f"Subroutines call each other more than {DEEPEST_CALL} deep."
            raise ProgramError(
                refusal(made.line, made.column("P"), "recursion", text, "A subroutine must not call itself.")
            )
        self._calls.append((made.line, self._run_end, self._loops))
        self._loops = []
        self.at = self._structure.subroutines[number] + 1
        self._run_end = self._structure.subroutine_ends.get(number, self.at - 1) + 1
        self._bound()

    def contour(self, made: Statement) -> range | None:
        """Indices of the lines that describe the contour of a G75 or G78, which the flow passes by.

        None where there are none; that has been told when the program was read.
        """
        if "P" not in made.words:
            end = self._structure.contours.get(made.line - 1)
            if end is None:
                return None
            self.at = end + 1
            return range(made.line, end)
        number = int(made.value("P") or 0)
        start = self._structure.subroutines.get(number)
        return None if start is None else range(start + 1, self._structure.subroutine_ends.get(number, start))

    def _loop_end(self, here: int) -> None:
        start = self._structure.loop_starts.get(here)
        if start is None or not self._loops or self._loops[-1][0] != start:
            return
        loop = self._loops[-1]
        if loop[1] > 0:
            loop[1] -= 1
            self.at = start + 1
        else:
            self._loops.pop()

    def _return(self) -> None:
        if self._calls:
            self.at, self._run_end, self._loops = self._calls.pop()
