"""Base classes of a pass through a program in any dialect: its results, its lines and its approach."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import copysign
from typing import Generic, Protocol, TypeVar

from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import CAxisMove, Checkpoint, FunctionStep, PassStart, StraightLeg
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind, StraightMoveSeries
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.machine_requirements import MachineRequirement
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.message import Message

MAX_BLOCK_COUNT = 5_000_000
MAX_LINE_COUNT = 10_000_000
"""Maximum number of executed lines in a program. No usable program has more."""

MAX_LINE_COUNT_WITHOUT_BLOCK = 200_000
"""Number of lines without motion after which a loop is treated as endless."""

MAX_CALL_DEPTH = 16
"""Maximum depth of nested subroutine calls."""


class ToolUsage:
    """Record of the tools used so far.

    ``used_tools`` contains their tool numbers in the order of first use. ``tools_without_offset`` contains
    the numbers of the used tools whose offsets were never set.
    """

    def __init__(self) -> None:
        self.used_tools: list[int] = []
        self.tools_without_offset: list[int] = []

    def record_tool(self, number: int) -> None:
        """Record the use of a tool whose dimensions may come from another source."""
        if number not in self.used_tools:
            self.used_tools.append(number)

    def use_tool_offset(self, number: int, offsets: Mapping[int, ToolOffset]) -> ToolOffset | None:
        """Record the use of a tool and return its offset, or None if the offset was never set."""
        self.record_tool(number)
        if number not in offsets and number not in self.tools_without_offset:
            self.tools_without_offset.append(number)
        return offsets.get(number)


class InterpreterPass(ABC):
    """One pass through a program. It raises no exceptions and reports all errors in ``diagnostics``.

    No block follows an error, but the pass continues as far as possible to find other errors. While blocks
    are generated, the findings and other results are extended.
    """

    def __init__(self, log: DiagnosticLog) -> None:
        self._log = log
        self._tools = ToolUsage()
        self._lacking: list[MachineRequirement] = []
        self._stopped = False  # an error occurred, and no more blocks follow
        # called with each line number of the main program
        self.stop_condition: Callable[[int], bool] | None = None
        self.has_stopped_before_line = (
            False  # the next line is a line at which ``stop_condition`` requested a stop
        )

    @abstractmethod
    def generate_blocks(self, *, stops_at_first_error: bool = False) -> Iterator[Block]:
        """Generate the elementary blocks of the program. Call this method only once.

        The blocks end at the first error. By default, the rest of the program is then checked for errors
        before the iterator ends. With ``stops_at_first_error``, the iterator ends immediately.
        """

    def generate_series(self) -> Iterator[Block | StraightMoveSeries]:
        """Generate the same blocks as ``generate_blocks``, with straight moves combined into series.

        Some dialects do not combine moves. By default, all blocks are generated individually.
        """
        return self.generate_blocks()

    @property
    @abstractmethod
    def source_block_count(self) -> int:
        """Return the number of program lines that contain more than a comment."""

    @property
    @abstractmethod
    def modal_state(self) -> ModalState:
        """Return the modal state after the last generated block."""

    @property
    def checkpoint(self) -> Checkpoint:
        """Return a checkpoint for the next line, which in this base class contains only the modal state."""
        return Checkpoint(self.modal_state)

    @property
    def blocking_reason(self) -> str:
        """Return the reason why another pass cannot start at this line, or an empty string.

        For example, buffered moves may depend on later lines.
        """
        return ""

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Return all findings so far, starting with the findings from parsing the program."""
        return self._log.findings

    @property
    def has_errors(self) -> bool:
        """Return whether the findings so far include an error."""
        return bool(self._log.error_findings)

    @property
    def used_tools(self) -> list[int]:
        """Return the tool numbers used so far, in the order of first use."""
        return self._tools.used_tools

    @property
    def missing_functions(self) -> list[MachineRequirement]:
        """Return the machine-builder functions that the program needs but this machine lacks."""
        return self._lacking

    @property
    def tools_without_offset(self) -> list[int]:
        """Return the used tools whose offsets were never set."""
        return self._tools.tools_without_offset

    def _stop_endless(self, line: int, hint: str) -> None:
        """Report that a program has too many blocks or lines, and end the pass at this line."""
        self._stopped = True
        text = Message(
            "The program produces more than {most_blocks} blocks or executes more than {most_lines} lines.",
            most_blocks=f"{MAX_BLOCK_COUNT:,}",
            most_lines=f"{MAX_LINE_COUNT:,}",
        )
        self._log.add_finding(make_error_diagnostic(line, 0, "too-many-blocks", text, hint))


class RejectedPass(InterpreterPass):
    """Pass through a program that this machine cannot run, with one finding and no blocks."""

    source_block_count = 0
    modal_state = ModalState()

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(DiagnosticLog([make_error_diagnostic(0, 0, "machine-kind", message, hint)]))

    def generate_blocks(self, *, stops_at_first_error: bool = False) -> Iterator[Block]:
        """Return an empty iterator, because the program cannot run."""
        del stops_at_first_error
        return iter(())


class NumberedLine(Protocol):
    """A line of a program with its ``number``, counted from 1."""

    @property
    def line_number(self) -> int:
        """Return the number of the line in the program, counted from 1."""
        ...


LineType = TypeVar("LineType", bound=NumberedLine)


class LinePass(InterpreterPass, Generic[LineType]):
    """Base class of passes that execute a program line by line.

    The number of lines and blocks is limited.
    """

    def __init__(self, log: DiagnosticLog) -> None:
        super().__init__(log)
        self._approach: Iterator[Block] = iter(())
        self._taken: LineType | None = None  # the line at which block search stopped
        self._left = MAX_LINE_COUNT
        self._made = 0  # number of blocks so far

    @abstractmethod
    def _can_stop(self, line: LineType) -> bool:
        """Return whether block search may end before this line.

        Block search ends only before executable lines of the main file.
        """

    @abstractmethod
    def _report_limit(self, line: LineType) -> None:
        """Report that the program exceeds the maximum number of blocks or lines."""

    def _lines(self, read_next: Callable[[], LineType | None]) -> Iterator[LineType]:
        """Yield the lines that ``read_next`` returns, until block search stops or a limit is exceeded."""
        idle = blocks = 0
        while True:
            line, self._taken = self._taken or read_next(), None
            if line is None:
                return
            if (
                self.stop_condition is not None
                and self._can_stop(line)
                and self.stop_condition(line.line_number)
            ):
                self._taken, self.has_stopped_before_line = line, True
                return
            self._left -= 1
            idle, blocks = (idle + 1, blocks) if self._made == blocks else (0, self._made)
            if self._left < 0 or idle > MAX_LINE_COUNT_WITHOUT_BLOCK or blocks >= MAX_BLOCK_COUNT:
                self._report_limit(line)
                self._left = -1
                return
            yield line


def generate_lathe_approach(
    pass_start: PassStart, modal: ModalState, start: Sequence[float], compute_rpm: Callable[[float], float]
) -> Iterator[Block]:
    """Yield the blocks of the approach to a restart line on a lathe.

    The blocks are numbered so that later blocks have the same numbers as in a full run. ``start`` is the
    current machine position. ``compute_rpm`` returns the commanded spindle speed at a radius in the program
    frame.
    """
    point, offsets = pass_start.checkpoint, (modal.offset_x, modal.offset_z, modal.offset_c)
    at = [value - offset for value, offset in zip(start, offsets, strict=False)]
    turning = 0.0
    for number, step in enumerate(
        pass_start.approach_steps, start=point.blocks - len(pass_start.approach_steps) + 1
    ):
        x0, z0, c0 = at
        kind, feed, action = BlockKind.ACTION, 0.0, None
        match step:
            case StraightLeg():
                kind, feed = BlockKind.RAPID if step.is_rapid else BlockKind.FEED, step.feed_mm_s
                at[0] = x0 if step.x is None else step.x - modal.offset_x
                at[1] = z0 if step.z is None else step.z - modal.offset_z
            case CAxisMove():
                kind, feed = BlockKind.ROTATE, step.speed
                at[2] = step.angle_deg - modal.offset_c
            case FunctionStep():
                action = step.action
                if isinstance(action, SpindleRun | SpindleStop):
                    turning = compute_rpm(at[0]) if isinstance(action, SpindleRun) else 0.0
        rpm = copysign(feed / 6.0, at[2] - c0) if kind is BlockKind.ROTATE else turning
        css = modal.surface_speed if modal.css and turning else None
        yield Block(
            number, pass_start.line_number, kind, step.text, x0, z0, c0, at[0], at[1], at[2],
            modal.offset_x, modal.offset_z, modal, feed, False, rpm, css, action=action,
        )  # fmt: skip
