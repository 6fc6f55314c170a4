"""The state in which a line of a program begins: the program gone through up to that line, and no further.

Where the slides stood at Cycle Start and what inputs answered is not known. A second pass, from another start
and with other answers, goes beside the first until both agree; while they differ, no line is good.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import replace

from core.interpreter.actions import AskInput, ProgramEnd
from core.interpreter.begin import Begin
from core.interpreter.blocks import Block, Kind
from core.interpreter.program import Program, read_program
from core.interpreter.restart.found import Clear, Found, NotGood
from core.interpreter.restart.good import Lines
from core.interpreter.restart.side import works_inside
from core.interpreter.setup import Setup
from core.interpreter.statement import Statement
from core.interpreter.walk import Walk
from core.language.source import Source

Watch = Callable[[float], None]

_ELSEWHERE = (7.3, -11.9, 0.0)  # mm: the other start; no program's words fall together with it
_SAME = 1e-7  # mm
_WATCHED = 2000  # blocks between two looks at whether the work is still wanted
_NEAR = 64  # lines looked at one by one for the place from which positions are known
_UP, _DOWN = 3, 500  # lines tried


class Rebuild:
    """One program under fixed circumstances; a later line goes on from where an earlier one was found.

    ``watch`` is told how many blocks have passed and may raise to give the work up.
    """

    def __init__(self, source: Source, setup: Setup, watch: Watch) -> None:
        self._setup = replace(setup, begin=None, inputs=lambda _terminal: False)
        self.watch = watch
        self._program: Program = read_program(source, setup.strict)
        self.lines = Lines(self._program)
        self._asks = _asks(self._program, self.lines)
        self._begin_anew()

    def find(self, line: int) -> Found | NotGood:
        """What line ``line`` inherits, or why the program cannot go on from it."""
        why = self.lines.why_not(line) or self._goes_to(line)
        if not why:
            return self._found(line)
        return NotGood(line, why, self._good(line, -1), self._good(line, 1))

    def _found(self, line: int) -> Found:
        point = self._walk.checkpoint
        ahead = Walk(self._program, replace(self._setup, begin=Begin(point, line)))
        inside = works_inside(point.machine[0] - point.modal.tool_x, ahead.blocks(to_first_error=True))
        return Found(line, point, Clear(self._z, self._stock, dict(self._x)), inside)

    def _good(self, line: int, way: int) -> int:
        """The nearest line that the pass itself confirms; few upwards, where each costs a pass of its own."""
        for _ in range(_DOWN if way > 0 else _UP):
            line = self.lines.after(line) if way > 0 else self.lines.before(line)
            if not line or not self._goes_to(line):
                return line
        return 0

    def _begin_anew(self) -> None:
        self._at, self._count = 1, 0
        self._z, self._stock = -math.inf, 0.0
        self._x: dict[int, tuple[float, float]] = {}
        self._ended = 0
        self._asked = 0  # line whose input the second pass answers differently
        self._lost = ""  # why nothing is known any more
        self._walk = Walk(self._program, self._setup)
        self._other: Walk | None = Walk(self._program, replace(self._setup, start=_ELSEWHERE))

    def _goes_to(self, line: int) -> str:
        """Go to the line; why it is not good, empty when it is."""
        if line < self._at:
            self._begin_anew()
        while self._at < line and not (self._ended or self._lost or self._walk.failed):
            if self._at in self._asks:
                self._ask()
            self._pass_to(self._stop(line))
            other = self._other
            if other is not None and not other.failed and _alike(self._walk, other):
                self._other = None
        return self._why_not(line)

    def _stop(self, line: int) -> int:
        """Where both passes are compared next: behind each line while little is known, at each input."""
        near = self._at + (1 if self._at < _NEAR else self._at) if self._other is not None else line
        if self._at in self._asks:
            return self._at + 1
        place = bisect_right(self._asks, self._at)
        ask = self._asks[place] if place < len(self._asks) else line
        return min(line, near, ask)

    def _pass_to(self, line: int) -> None:
        """Both passes to the line; the first one tells what is asked and how far out it goes."""
        asked, self._at = self._at, line
        for block in self._walk.before(line):
            self._count += 1
            if self._count % _WATCHED == 0:
                self.watch(self._count)
            if block.action is None:
                self._see(block)
            elif isinstance(block.action, ProgramEnd):
                self._ended = block.line
            elif isinstance(block.action, AskInput) and (self._walk.called or block.line != asked):
                self._lost = f"what input {block.action.terminal} answered on line {block.line} is not known."
        if self._other is not None:
            for _ in self._other.before(line):
                pass

    def _see(self, block: Block) -> None:
        x, z, tool = block.x + block.offset_x, block.z + block.offset_z, block.modal.tool
        self._z = max(self._z, z)
        low, high = self._x.get(tool, (x, x))
        self._x[tool] = (min(low, x), max(high, x))
        if block.kind is not Kind.RAPID:
            centre = block.modal.tool_x
            self._stock = max(self._stock, abs(x - centre), abs(block.x0 + block.offset_x - centre))

    def _ask(self) -> None:
        """From here on the second pass is the one in which the input of this line answers otherwise."""
        if self._other is not None:
            self._lost = f"what the input of line {self._at} answered is not known."
            return
        begin = Begin(self._walk.checkpoint, self._at)
        self._asked = self._at
        self._other = Walk(self._program, replace(self._setup, begin=begin, inputs=lambda _terminal: True))

    def _why_not(self, line: int) -> str:
        walk, known = self._walk, self._other is None
        reasons = (
            (walk.failed, f"The program has errors before line {line}."),
            (self._ended, f"The program ends on line {self._ended}, before line {line}."),
            (self._lost, f"Line {line} is no place to go on: {self._lost}"),
            (walk.shaping, f"Line {line} is under nose compensation or in a corner."),
            (walk.checkpoint.modal.mill, f"Line {line} is in plane switching."),
            (not known and self._asked, f"Line {line} depends on the input that line {self._asked} asks."),
            (
                not known and not self._x,
                f"Nothing has moved before line {line}: start the program from its first line.",
            ),
            (not known, f"Where the slides stand at line {line} depends on where they stood at Cycle Start."),
        )
        return next((why for wrong, why in reasons if wrong), "")


def _asks(program: Program, lines: Lines) -> list[int]:
    """Lines of the main program, loops apart, that ask an input; in order."""
    steps = enumerate(program.steps, start=1)
    asking = [n for n, step in steps if isinstance(step, Statement) and step.flow in {"M95", "M97"}]
    return [number for number in asking if not lines.why_not(number)]


def _alike(one: Walk, other: Walk) -> bool:
    """Whether both passes stand at one point in one state, so that what follows is the same."""
    a, b = one.checkpoint, other.checkpoint
    if one.next_line != other.next_line or one.shaping or other.shaping or a.modal != b.modal:
        return False
    near = all(abs(p - q) < _SAME for p, q in zip(a.machine, b.machine, strict=True))
    near = near and abs(a.px - b.px) < _SAME and abs(a.pz - b.pz) < _SAME
    return near and a[6:-1] == b[6:-1]
