"""Program flow for all dialects, with active calls, remaining repeats and detection of endless loops."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field, replace
from typing import Any, Generic, NamedTuple, TypeVar

from core.language.diagnostics import Diagnostic
from core.message import Message

ENDLESS_LOOP_CODE = "endless-loop"
"""Error code of an endless loop, in every program language."""

RoutineType = TypeVar("RoutineType")


class CallSite(NamedTuple):
    """The place in the main file at which the lines of a called program are displayed.

    ``file_name`` is the name of a program from another file, and ``line`` is the line of its call. Both are
    empty in the main file.
    """

    file_name: str = ""
    line: int = 0

    def relocate_finding(self, finding: Diagnostic) -> Diagnostic:
        """Return a finding with its location in the main file.

        A finding in another file is moved to the line of the call, and the file and line are added to its
        text.
        """
        if not self.line:
            return finding
        message = Message(
            "{source} line {line}: {value}", source=self.file_name, line=finding.line, value=finding.message
        )
        return replace(finding, line=self.line, column=0, message=message)


MAIN_FILE = CallSite()
"""The place of lines that are in the main file."""


@dataclass(slots=True)
class FlowFrame(Generic[RoutineType]):
    """The main program or an active subprogram, with positions as line indices from 0.

    ``next_index`` is the line at which execution continues after a call. ``end_index`` is the index after
    the last line. ``remaining_repeats`` maps the line of each active repeat to the number of remaining
    repeats, from the outermost to the innermost. ``file_name`` is the name of a program from another file.
    Its lines are displayed at ``call_line``, the line of the call in the main file.
    """

    routine: RoutineType
    next_index: int
    end_index: int
    remaining_repeats: dict[int, int] = field(default_factory=dict)
    file_name: str = ""
    call_line: int = 0

    @property
    def comparison_key(self) -> tuple[object, ...]:
        """Return the file name, the next line and the remaining repeats for comparison."""
        return self.file_name, self.next_index, tuple(sorted(self.remaining_repeats.items()))


FrameType = TypeVar("FrameType", bound=FlowFrame[Any])


class ControlFlow(Generic[FrameType]):
    """The execution position in a program and its subprograms.

    ``next_index`` is the index of the next line, and ``end_index`` is the index at which execution ends.
    """

    def __init__(self, main_frame: FrameType) -> None:
        self.next_index, self.end_index = main_frame.next_index, main_frame.end_index
        self.active_frame = (
            main_frame  # the active frame; its ``next_index`` is updated when it calls another frame
        )
        self.frames = [main_frame]

    @property
    def is_in_subprogram(self) -> bool:
        """Return whether a subprogram is active."""
        return len(self.frames) > 1

    @property
    def is_in_other_file(self) -> bool:
        """Return whether a program from another file is active."""
        return bool(self.active_frame.call_line)

    def enter_subprogram(self, frame: FrameType) -> None:
        """Continue execution in a subprogram."""
        self.active_frame.next_index = self.next_index
        self.frames.append(frame)
        self.active_frame, self.next_index, self.end_index = frame, frame.next_index, frame.end_index

    def return_to_caller(self) -> None:
        """Return from a subprogram to the line after its call."""
        self.frames.pop()
        self._resume_frame()

    def _resume_frame(self) -> None:
        """Continue execution at the saved position of the innermost frame."""
        self.active_frame = here = self.frames[-1]
        self.next_index, self.end_index = here.next_index, here.end_index

    def end_program(self) -> None:
        """End the program, including all active calls."""
        del self.frames[1:]
        self._resume_frame()
        self.next_index = self.end_index

    def get_displayed_line(self, number: int) -> int:
        """Return the line of the main file that is displayed for a line of the active program.

        In a called program, this is the line of the call. Otherwise it is ``number``.
        """
        return self.active_frame.call_line or number

    @property
    def call_site(self) -> CallSite:
        """Return the place in the main file at which the active program is displayed."""
        return CallSite(self.active_frame.file_name, self.active_frame.call_line)

    def relocate_finding(self, finding: Diagnostic) -> Diagnostic:
        """Return a finding of the active program with its location in the main file."""
        return self.call_site.relocate_finding(finding)


class EndlessLoopDetector:
    """Detector of endless loops that compares the program state at each backward jump.

    Execution from the same state always continues identically. If a backward jump occurs in the same state
    as an earlier jump, the loop is therefore endless. The reference state is renewed at jumps 1, 2, 4, 8
    and so on (Brent's cycle detection), so that a loop of any length is detected within three rounds. In a
    normal loop, each jump costs one comparison, which ends at the first difference.
    """

    def __init__(self) -> None:
        self._jumps = 0
        self._renew = 1
        self._kept: object = None

    def is_repeated_state(self, flow: ControlFlow[FrameType], *held: object) -> bool:
        """Return whether a backward jump repeats an earlier state, so that the loop is endless.

        ``held`` contains all values, other than the execution position, on which later jumps can depend.
        """
        flow.active_frame.next_index = flow.next_index
        now = [each.comparison_key for each in flow.frames], held
        if now == self._kept:
            return True
        self._jumps += 1
        if self._jumps == self._renew:
            self._renew *= 2
            self._kept = deepcopy(now)
        return False
