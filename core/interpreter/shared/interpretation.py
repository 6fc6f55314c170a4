"""One pass through a program in any language: what it is asked for, its lines, the way to its first."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import copysign
from typing import Generic, Protocol, TypeVar

from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import Begin, Checkpoint, CTurn, FunctionStep, Leg
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind, Series
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.machine_requirements import Need
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import Diagnostic, refusal
from core.message import Message

MOST_BLOCKS = 5_000_000
MOST_LINES = 10_000_000
"""More of either is made by no program that anybody means to run."""

MOST_LINES_WITHOUT_BLOCK = 200_000
"""A loop that reckons so long and moves nothing never ends."""

DEEPEST_CALL = 16
"""Subroutines that may call each other in a chain."""


class ToolUse:
    """Tool numbers asked for so far, in the order of first use, and those whose offset has never been set."""

    def __init__(self) -> None:
        self.used: list[int] = []
        self.missing: list[int] = []

    def call(self, number: int) -> None:
        """This tool is used from now on, whoever tells its measures."""
        if number not in self.used:
            self.used.append(number)

    def offset(self, number: int, offsets: Mapping[int, ToolOffset]) -> ToolOffset | None:
        """The offset of this tool, which is used from now on; None where it has never been set."""
        self.call(number)
        if number not in offsets and number not in self.missing:
            self.missing.append(number)
        return offsets.get(number)


class Interpretation(ABC):
    """One pass. It raises nothing at its user: what is wrong is in ``diagnostics``.

    No block comes after an error, but the pass goes on as well as it can to find the other errors. All that
    it reports grows while blocks are taken.
    """

    def __init__(self, log: Log) -> None:
        self._log = log
        self._tools = ToolUse()
        self._lacking: list[Need] = []
        self._stopped = False  # an error has been met: no more blocks
        self.stop_before: Callable[[int], bool] | None = None  # asked of each line of the main program
        self.stopped_before = False  # a line is about to be executed at which the pass was asked to stop

    @abstractmethod
    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """The elementary blocks, made as they are asked for. To be called once.

        At the first error the blocks end. What is left of the program is then still gone through for its
        errors before the iterator ends, unless ``to_first_error`` (what runs a program wants no delay).
        """

    def series(self) -> Iterator[Block | Series]:
        """The same, for whoever goes through all of a program: straight moves in series where there are."""
        return self.blocks()

    @property
    @abstractmethod
    def source_blocks(self) -> int:
        """Lines that hold more than a comment."""

    @property
    @abstractmethod
    def modal(self) -> Modal:
        """The state after the last block that was taken."""

    @property
    def checkpoint(self) -> Checkpoint:
        """What the line inherits that would be executed next: here the modal state alone."""
        return Checkpoint(self.modal)

    @property
    def waits_for(self) -> str:
        """Why no other pass can go on from here, in words: moves that wait for lines to come; empty."""
        return ""

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings so far, those of reading the program first."""
        return self._log.found

    @property
    def failed(self) -> bool:
        """Whether there is an error among the findings so far."""
        return bool(self._log.errors)

    @property
    def used_tools(self) -> list[int]:
        """Tool numbers asked for so far, in the order of first use."""
        return self._tools.used

    @property
    def lacking(self) -> list[Need]:
        """What the program asks of the machine's builder and nothing on this machine answers."""
        return self._lacking

    @property
    def missing_tools(self) -> list[int]:
        """Those of them whose offset has never been set."""
        return self._tools.missing

    def _stop_endless(self, line: int, hint: str) -> None:
        """A program that makes more than anybody runs ends at this line."""
        self._stopped = True
        text = Message(
            "The program produces more than {most_blocks} blocks or executes more than {most_lines} lines.",
            most_blocks=f"{MOST_BLOCKS:,}",
            most_lines=f"{MOST_LINES:,}",
        )
        self._log.add(refusal(line, 0, "too-many-blocks", text, hint))


class RefusedPass(Interpretation):
    """A program that this machine cannot run at all: one finding, and no block."""

    source_blocks = 0
    modal = Modal()

    def __init__(self, why: str, hint: str) -> None:
        super().__init__(Log([refusal(0, 0, "machine-kind", why, hint)]))

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """None."""
        del to_first_error
        return iter(())


class Numbered(Protocol):
    """A line of a program; ``number`` from 1."""

    @property
    def number(self) -> int: ...


Line = TypeVar("Line", bound=Numbered)


class LinePass(Interpretation, Generic[Line]):
    """The lines of a program in the order in which they are executed, up to the limits of a program."""

    def __init__(self, log: Log) -> None:
        super().__init__(log)
        self._approach: Iterator[Block] = iter(())
        self._taken: Line | None = None  # a line at which block search has stopped
        self._left = MOST_LINES
        self._made = 0  # blocks so far

    @abstractmethod
    def _can_stop(self, line: Line) -> bool:
        """Whether block search may stop before this line: one of the main file that does something."""

    @abstractmethod
    def _never_ends(self, line: Line) -> None:
        """Tell that more has been executed than any program is meant to."""

    def _lines(self, take: Callable[[], Line | None]) -> Iterator[Line]:
        """The lines as ``take`` gives them, until a stop of block search or more than anybody runs."""
        idle = blocks = 0
        while True:
            line, self._taken = self._taken or take(), None
            if line is None:
                return
            if self.stop_before is not None and self._can_stop(line) and self.stop_before(line.number):
                self._taken, self.stopped_before = line, True
                return
            self._left -= 1
            idle, blocks = (idle + 1, blocks) if self._made == blocks else (0, self._made)
            if self._left < 0 or idle > MOST_LINES_WITHOUT_BLOCK or blocks >= MOST_BLOCKS:
                self._never_ends(line)
                self._left = -1
                return
            yield line


def approach_blocks(
    begin: Begin, modal: Modal, start: Sequence[float], rpm_at: Callable[[float], float]
) -> Iterator[Block]:
    """The blocks of the way, numbered so that the first block of the line keeps its number of a full run.

    ``start`` is where the slides stand, ``rpm_at`` the speed commanded at a radius of the program's frame.
    """
    point, offsets = begin.checkpoint, (modal.offset_x, modal.offset_z, modal.offset_c)
    at = [value - offset for value, offset in zip(start, offsets, strict=False)]
    turning = 0.0
    for number, step in enumerate(begin.approach, start=point.blocks - len(begin.approach) + 1):
        x0, z0, c0 = at
        kind, feed, action = Kind.ACTION, 0.0, None
        match step:
            case Leg():
                kind, feed = Kind.RAPID if step.rapid else Kind.FEED, step.feed
                at[0] = x0 if step.x is None else step.x - modal.offset_x
                at[1] = z0 if step.z is None else step.z - modal.offset_z
            case CTurn():
                kind, feed = Kind.ROTATE, step.speed
                at[2] = step.c - modal.offset_c
            case FunctionStep():
                action = step.action
                if isinstance(action, SpindleRun | SpindleStop):
                    turning = rpm_at(at[0]) if isinstance(action, SpindleRun) else 0.0
        rpm = copysign(feed / 6.0, at[2] - c0) if kind is Kind.ROTATE else turning
        css = modal.surface_speed if modal.css and turning else None
        yield Block(
            number, begin.line, kind, step.text, x0, z0, c0, at[0], at[1], at[2],
            modal.offset_x, modal.offset_z, modal, feed, False, rpm, css, action=action,
        )  # fmt: skip
