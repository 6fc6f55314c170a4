"""Blocks of one pass through the program, pulled no further than the next standstill."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from core.executor.raised_alarm import AlarmError
from core.geometry.lines_and_arcs import arc_length
from core.interpreter.actions import SpindleRun
from core.interpreter.checkpoint import Checkpoint
from core.interpreter.elementary_blocks import Block, Kind
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.machine.machine_model import Axis, Machine


class ProgramPass(NamedTuple):
    """One pass through a program: its blocks as they come, and what the interpreter has to say so far.

    ``left`` tells what a line of MDI leaves to the next one; a program has none, it ends with M30 or M02.
    """

    blocks: Iterator[Block]
    problems: Callable[[], Sequence[Diagnostic]]
    left: Callable[[], Checkpoint] | None = None


def needs_speed(block: Block) -> bool:
    """Whether this block must not begin before the spindle is at its speed; rapids may."""
    return block.moves and not block.rapid


class ReadAhead:
    """``pending`` may be moved in one stretch; ``stop`` waits behind it for a standstill.

    A standstill is needed by every action, by the first block after a change of speed that is no rapid, and
    before and behind each thread pass, which is the thread and what pulls out of it.
    Nothing behind ``stop`` is read before it has been carried out, so that a program that asks inputs asks
    them at their time.
    """

    def __init__(self, source: ProgramPass, check: Callable[[Block], None]) -> None:
        self._source = source
        self._check = check
        self._said = 0
        self._new_speed = False
        self._pass = 0  # blocks of the thread pass that is being read
        self.pending: deque[Block] = deque()
        self.seconds = 0.0  # what the pending blocks take at least
        self.stop: Block | None = None
        self.trouble: AlarmError | None = None  # what ends the pass once all before it is done
        self.ended = False

    @property
    def next_block(self) -> Block | None:
        """What comes after the blocks that were taken."""
        return self.pending[0] if self.pending else self.stop

    @property
    def dry(self) -> bool:
        """Nothing more can be pulled before a standstill."""
        return self.stop is not None or self.ended or self.trouble is not None

    def pull(self, blocks: int, seconds: float) -> None:
        """Read on until so many blocks were read or so many seconds are pending, pull-outs of threads too."""
        for _ in range(blocks):
            if self.dry or (self.seconds >= seconds and not self._pass):
                return
            block = self._next()
            if block is not None:
                self._sort(block)

    def take(self) -> list[Block]:
        """The pending blocks, for moving."""
        taken = list(self.pending)
        self.pending.clear()
        self.seconds = 0.0
        return taken

    def pass_stop(self) -> None:
        """The standstill has been used: an action is done, a cutting block may start."""
        block, self.stop = self.stop, None
        if block is None or block.action is not None:
            return
        self._new_speed = self._new_speed and not needs_speed(block)
        self._pass = int(block.kind is Kind.THREAD)
        self._append(block)

    def _next(self) -> Block | None:
        try:
            block = next(self._source.blocks)
        except StopIteration:
            self._find_error()
            self.ended = True
            return None
        except ProgramError as error:
            self.trouble = AlarmError("program", error.diagnostic.message, error.diagnostic.line)
            return None
        self._find_error()
        return None if self.trouble else block

    def _find_error(self) -> None:
        """An error that the live run met and the proof could not."""
        problems = self._source.problems()
        for problem in problems[self._said :]:
            if problem.severity is Severity.ERROR and self.trouble is None:
                self.trouble = AlarmError("program", problem.message, problem.line)
        self._said = len(problems)

    def _sort(self, block: Block) -> None:
        try:
            self._check(block)
        except AlarmError as trouble:
            self.trouble = trouble
            return
        if block.action is not None:
            self._new_speed = self._new_speed or isinstance(block.action, SpindleRun)
            self.stop = block
        elif self._pass == 1 and _pulls_out(block):
            self._pass = 2
            self._append(block)
        elif self._pass or block.kind is Kind.THREAD or (self._new_speed and needs_speed(block)):
            self.stop = block
        else:
            self._append(block)

    def _append(self, block: Block) -> None:
        self.pending.append(block)
        self.seconds += nominal_seconds(block)


def _pulls_out(block: Block) -> bool:
    """Behind a thread: its pull-out, or a rapid straight out."""
    return block.kind is Kind.THREAD or (block.kind is Kind.RAPID and block.z == block.z0)


def nominal_seconds(block: Block) -> float:
    """Seconds the block takes at its programmed speed: never more than it will take."""
    if block.travel is not None:
        way = block.travel.length
    elif block.kind is Kind.ARC:
        ends = (block.x0, block.z0), (block.x, block.z)
        way = arc_length(*ends, (block.cx, block.cz), clockwise=block.clockwise)
    elif block.plane is not None:
        way = block.plane.length
    else:
        way = math.hypot(block.x - block.x0, block.z - block.z0)
    way = way or abs(block.c - block.c0)
    speed = (
        block.feed * abs(block.rpm) / 60.0 if block.per_rev and block.kind is not Kind.RAPID else block.feed
    )
    return way / speed if speed > 0.0 else 0.0


# --- checked again before it moves ----------------------------------------------------------------------


_TRAVEL_ROUNDING = 1e-6  # mm


def check_block(block: Block, machine: Machine) -> None:
    """Raises TroubleError for a move out of the travel, one fed by the turns of a spindle that stands, and
    one of C while the spindle that is C turns.
    """
    if not block.moves:
        return
    if block.per_rev and block.kind is not Kind.RAPID and block.rpm == 0.0 and block.c == block.c0:
        raise AlarmError("spindle-still", f"line {block.line} feeds by the revolution", block.line)
    if block.c != block.c0 and block.modal.spindle and machine.spindle_is_c:
        raise AlarmError("c-is-spindle", f"line {block.line} moves C while the spindle turns", block.line)
    for axis, (low, high) in zip(machine.axes, block.machine_reach(), strict=True):
        _check(block, axis, low, high)


def _check(block: Block, axis: Axis, low: float, high: float) -> None:
    if axis.travel is None:
        return
    if low < axis.travel[0] - _TRAVEL_ROUNDING or high > axis.travel[1] + _TRAVEL_ROUNDING:
        unit = "degrees" if axis.rotary else "mm"
        far = low if low < axis.travel[0] else high
        raise AlarmError(
            "travel", f"line {block.line} moves {axis.name} to {far:.3f} {unit} from home", block.line
        )
