"""One pass through a program in any language: its results, its lines and the approach to its first line."""

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
    """Tool numbers used so far, in the order of first use, and the used tools whose offset was never set."""

    def __init__(self) -> None:
        self.used: list[int] = []
        self.missing: list[int] = []

    def call(self, number: int) -> None:
        """Record the use of a tool whose dimensions may come from another source."""
        if number not in self.used:
            self.used.append(number)

    def offset(self, number: int, offsets: Mapping[int, ToolOffset]) -> ToolOffset | None:
        """Record the use of a tool and return its offset, or None if its offset was never set."""
        self.call(number)
        if number not in offsets and number not in self.missing:
            self.missing.append(number)
        return offsets.get(number)


class Interpretation(ABC):
    """One pass through a program. It raises no exceptions; all problems are in ``diagnostics``.

    No block follows an error, but the pass continues as far as possible to find other errors. All results
    grow while blocks are generated.
    """

    def __init__(self, log: Log) -> None:
        self._log = log
        self._tools = ToolUse()
        self._lacking: list[Need] = []
        self._stopped = False  # an error occurred, and no more blocks follow
        # called with each line number of the main program
        self.stop_before: Callable[[int], bool] | None = None
        self.stopped_before = False  # the next line is a line at which ``stop_before`` requested a stop

    @abstractmethod
    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """Return an iterator that generates the elementary blocks. Call this method once.

        The blocks end at the first error. By default, the rest of the program is then checked for errors
        before the iterator ends. With ``to_first_error``, the iterator ends without delay.
        """

    def series(self) -> Iterator[Block | Series]:
        """Return the same blocks, with straight moves combined in series where possible."""
        return self.blocks()

    @property
    @abstractmethod
    def source_blocks(self) -> int:
        """Number of lines that contain more than a comment."""

    @property
    @abstractmethod
    def modal(self) -> Modal:
        """Modal state after the last generated block."""

    @property
    def checkpoint(self) -> Checkpoint:
        """State that the next line inherits; in this base class, only the modal state."""
        return Checkpoint(self.modal)

    @property
    def waits_for(self) -> str:
        """Reason why no other pass can continue from here, or an empty text.

        For example, some moves may wait for later lines.
        """
        return ""

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings so far, beginning with the findings from reading the program."""
        return self._log.found

    @property
    def failed(self) -> bool:
        """Whether the findings so far include an error."""
        return bool(self._log.errors)

    @property
    def used_tools(self) -> list[int]:
        """Tool numbers used so far, in the order of first use."""
        return self._tools.used

    @property
    def lacking(self) -> list[Need]:
        """Functions of the machine builder that the program needs and this machine does not have."""
        return self._lacking

    @property
    def missing_tools(self) -> list[int]:
        """Used tools whose offset was never set."""
        return self._tools.missing

    def _stop_endless(self, line: int, hint: str) -> None:
        """Report a program with too many blocks or lines and end the pass at this line."""
        self._stopped = True
        text = Message(
            "The program produces more than {most_blocks} blocks or executes more than {most_lines} lines.",
            most_blocks=f"{MOST_BLOCKS:,}",
            most_lines=f"{MOST_LINES:,}",
        )
        self._log.add(refusal(line, 0, "too-many-blocks", text, hint))


class RefusedPass(Interpretation):
    """Pass through a program that this machine cannot run at all: one finding and no blocks."""

    source_blocks = 0
    modal = Modal()

    def __init__(self, why: str, hint: str) -> None:
        super().__init__(Log([refusal(0, 0, "machine-kind", why, hint)]))

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """Return an empty iterator."""
        del to_first_error
        return iter(())


class Numbered(Protocol):
    """A line of a program with its ``number``, from 1."""

    @property
    def number(self) -> int: ...


Line = TypeVar("Line", bound=Numbered)


class LinePass(Interpretation, Generic[Line]):
    """The lines of a program in the order of execution, up to the limits of a program."""

    def __init__(self, log: Log) -> None:
        super().__init__(log)
        self._approach: Iterator[Block] = iter(())
        self._taken: Line | None = None  # the line at which block search stopped
        self._left = MOST_LINES
        self._made = 0  # number of blocks so far

    @abstractmethod
    def _can_stop(self, line: Line) -> bool:
        """Return whether block search may stop before this line, a line with a function in the main file."""

    @abstractmethod
    def _never_ends(self, line: Line) -> None:
        """Report that the program exceeds the maximum number of blocks or lines."""

    def _lines(self, take: Callable[[], Line | None]) -> Iterator[Line]:
        """Yield the lines that ``take`` returns, until block search stops or a limit is exceeded."""
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
    """Yield the blocks of the approach, numbered so that later blocks have the same numbers as in a full run.

    ``start`` is the present machine position. ``rpm_at`` returns the commanded spindle speed at a radius in
    the program frame.
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
