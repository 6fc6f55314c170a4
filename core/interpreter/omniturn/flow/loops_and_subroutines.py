"""Loops, subroutines and program end of OmniTurn programs.

They are located before a program is executed, so that the program flow can follow them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from copy import copy
from dataclasses import replace
from typing import NamedTuple

from core.interpreter.omniturn.codes.code_table import FLOW_CODES
from core.interpreter.omniturn.omniturn_statement import UNREADABLE_FLOW, Statement
from core.interpreter.shared.checkpoint import CallLevel, FlowPosition
from core.interpreter.shared.control_flow import ControlFlow, FlowFrame
from core.interpreter.shared.interpretation import MAX_CALL_DEPTH
from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.message import Message

_CONTOUR_CYCLE = re.compile(r"G7[58](?![0-9])", re.IGNORECASE)


class ProgramStructure(NamedTuple):
    """Structure of a program, with all positions as line indices from 0."""

    loop_ends: dict[int, int]  # index of LS → index of its LF
    loop_starts: dict[int, int]
    subroutine_starts: dict[int, int]  # number → index of its }n
    subroutine_ends: dict[int, int]  # number → index of its M99
    main_end_index: int  # one past the last line of the main program
    contour_ends: dict[int, int]  # index of a G75 or G78 without P → index of its RF


class _Finder:
    """Collector of the loops, subroutines and contours of a program, statement by statement."""

    def __init__(self, length: int) -> None:
        self.structure = ProgramStructure({}, {}, {}, {}, length, {})
        self.problems: list[Diagnostic] = []
        self._loops: list[Statement] = []
        self._inside: int | None = None  # number of the subroutine that is being read
        self._job_end: int | None = None  # line index of an M30 or M02 in it that no other statement follows
        self._ended = False
        self._stray = False  # an unreachable line has been reported
        self._contour: Statement | None = None  # G75 or G78 without its RF so far
        self._contour_lost = False  # the G75 or G78 is on a line that cannot be read

    def accept_statement(self, statement: Statement) -> None:
        if self._in_contour(statement):
            return
        if statement.flow_code == "}":
            self._open_subroutine(statement)
            return
        ends_job = _ends_program(statement) and not statement.has_block_delete
        self._job_end = statement.line - 1 if ends_job and self._inside is not None else None
        if statement.flow_code == "M99":
            self._close_subroutine(statement)
        elif self._ended and self._inside is None:
            if statement.flow_code != UNREADABLE_FLOW or statement.text.strip():
                self._unreachable(statement)
        elif statement.flow_code == "LS" or _is_probably(statement, "LS"):
            self._loops.append(statement)
        elif statement.flow_code == "LF":
            self._close_loop(statement)
        elif _is_probably(statement, "LF") and self._loops:
            self._loops.pop()
        elif self._inside is None and ends_job:
            self._end_main(statement.line)

    def _in_contour(self, statement: Statement) -> bool:
        """Return whether the line belongs to a contour or is the RF that ends it.

        Such lines do not affect the structure.
        """
        if statement.flow_code == "RF":
            if self._contour is None and not self._contour_lost:
                self._refuse(
                    statement,
                    "rf-alone",
                    "RF has no matching G75 or G78.",
                    "Add G75 or G78, or remove RF.",
                )
            elif self._contour is not None:
                self.structure.contour_ends[self._contour.line - 1] = statement.line - 1
            self._contour, self._contour_lost = None, False
            return True
        if statement.flow_code == UNREADABLE_FLOW and _CONTOUR_CYCLE.search(statement.text):
            self._contour_lost = True  # The error is already reported, so its RF must not cause another one.
        if statement.flow_code in {"}", "M99"} or statement.ends_program:
            self._open_contour()
        inside = self._contour is not None
        if not inside and statement.is_contour_cycle and "P" not in statement.words:
            self._contour = statement
        return inside

    def _open_contour(self) -> None:
        statement, self._contour = self._contour, None
        if statement is not None:
            text = Message("The contour of G{one_shot} has no RF.", one_shot=statement.one_shot_code)
            hint = "Write RF alone on the line after the contour, or P with a subroutine number."
            self._refuse(statement, "contour-open", text, hint)

    def _end_main(self, line: int) -> None:
        self._ended = True
        self._unclosed_loops()
        self.structure = self.structure._replace(main_end_index=min(line, self.structure.main_end_index))

    def _open_subroutine(self, statement: Statement) -> None:
        if self._inside is not None and not self._closed_by_job_end(self._inside):
            self._refuse(
                statement,
                "subroutine-open",
                Message("Subroutine {inside} has no M99 before this line.", inside=self._inside),
                "Add M99.",
            )
        elif not self._ended:
            self._no_end(statement.line - 1)
        self._unclosed_loops()
        self._job_end = None
        number = int(statement.get_value("}") or 0)
        if number in self.structure.subroutine_starts:
            first = self.structure.subroutine_starts[number] + 1
            text = Message("Subroutine {number} already begins on line {first}.", number=number, first=first)
            self._refuse(statement, "subroutine-twice", text, "Use a different number.")
        else:
            self.structure.subroutine_starts[number] = statement.line - 1
        self._inside, self._stray = number, False

    def _close_subroutine(self, statement: Statement) -> None:
        if self._inside is None:
            hint = "Write M30 at the end of the program, or delete this line."
            self._refuse(statement, "m99-outside", "M99 is not in a subroutine.", hint)
            return
        self._unclosed_loops()
        self.structure.subroutine_ends.setdefault(self._inside, statement.line - 1)
        self._inside = None

    def _closed_by_job_end(self, number: int) -> bool:
        """Return whether M30 or M02, instead of M99, ends the subroutine with this number."""
        if self._job_end is None:
            return False
        self.structure.subroutine_ends.setdefault(number, self._job_end)
        return True

    def _close_loop(self, statement: Statement) -> None:
        if not self._loops:
            self._refuse(
                statement, "loop-unopened", "LF has no matching LS.", "Add LS with a count, or remove LF."
            )
            return
        start = self._loops.pop().line - 1
        self.structure.loop_ends[start] = statement.line - 1
        self.structure.loop_starts[statement.line - 1] = start

    def _unclosed_loops(self) -> None:
        for statement in self._loops:
            if statement.flow_code == UNREADABLE_FLOW:
                continue  # already reported
            self._refuse(
                statement,
                "loop-open",
                Message("{text} has no matching LF.", text=statement.text),
                "Add LF where the loop ends.",
            )
        self._loops.clear()

    def _unreachable(self, statement: Statement) -> None:
        late_end = statement.ends_program and any(each.code == "no-end" for each in self.problems)
        if not self._stray and not late_end:
            self._stray = True
            text = "This line is after the end of the program but not in a subroutine."
            self._refuse(
                statement, "after-end", text, "Move this line before M30, or start a subroutine with }n."
            )

    def _no_end(self, line: int) -> None:
        self._ended = True
        self.structure = self.structure._replace(main_end_index=line)
        if any(problem.code == "m99-outside" for problem in self.problems):
            return  # M99 was intended as the end of the program.
        text = "The main program ends without M30 or M02."
        self.problems.append(
            make_error_diagnostic(line, 0, "no-end", text, "Write M30 before the subroutines.")
        )

    def finish_search(self, length: int) -> None:
        self._open_contour()
        self._unclosed_loops()
        if not self._ended:
            self._no_end(length)
        elif self._inside is not None and not self._closed_by_job_end(self._inside):
            text = Message("Subroutine {inside} has no M99.", inside=self._inside)
            line = self.structure.subroutine_starts[self._inside] + 1
            self.problems.append(
                make_error_diagnostic(
                    line, 1, "subroutine-open", text, "Add M99 at the end of the subroutine."
                )
            )

    def _refuse(self, statement: Statement, code: str, text: str, hint: str) -> None:
        self.problems.append(make_error_diagnostic(statement.line, 1, code, text, hint))


def _ends_program(statement: Statement) -> bool:
    """Return whether the line ends the program.

    The result is also True for an unreadable line that was probably intended to contain M30 or M02.
    """
    return statement.ends_program or _is_probably(statement, "M0*(?:30|2)(?![0-9])")


def _is_probably(statement: Statement, word: str) -> bool:
    """Return whether an unreadable line was probably intended to contain a certain word.

    ``word`` is the pattern of this word.
    """
    return statement.flow_code == UNREADABLE_FLOW and re.search(word, statement.text.upper()) is not None


def find_structure(statements: Iterable[Statement], length: int) -> tuple[ProgramStructure, list[Diagnostic]]:
    """Return the structure of a program of ``length`` lines, and the errors of the structure.

    ``statements`` are, in order, the lines that contain words other than X and Z.
    """
    finder = _Finder(length)
    calls: list[Statement] = []
    for statement in statements:
        finder.accept_statement(statement)
        if statement.calls_subroutine or (statement.is_contour_cycle and statement.get_value("P")):
            calls.append(statement)
    finder.finish_search(length)
    for statement in calls:
        number = get_subroutine_number(statement)
        if number not in finder.structure.subroutine_starts:
            column, hint = statement.get_column("P") or 1, "Write the subroutine after M30."
            text = Message(
                "Subroutine {number} is called, but the program does not contain }}{number2}.",
                number=number,
                number2=number,
            )
            finder.problems.append(
                make_error_diagnostic(statement.line, column, "subroutine-missing", text, hint)
            )
    return finder.structure, finder.problems


def get_subroutine_number(statement: Statement) -> int:
    """Return the number of the called subroutine, which is always 1 for M95."""
    return 1 if statement.flow_code == "M95" else int(statement.get_value("P") or 0)


def get_input_terminal(statement: Statement) -> str:
    """Return the name of the input terminal that a conditional call reads."""
    return FLOW_CODES[statement.flow_code].required_input[0] or f"{statement.get_value('I'):.0f}"


def is_call_made(statement: Statement, read_input: Callable[[str], bool]) -> bool:
    """Return whether a conditional call is made in the current state of the inputs."""
    return read_input(get_input_terminal(statement)) == is_called_when_closed(statement)


def is_called_when_closed(statement: Statement) -> bool:
    """Return whether a conditional call is made if its input is closed (True) or open (False)."""
    return statement.flow_code == "M95" or statement.get_value("C") == 1


class Flow(ControlFlow[FlowFrame[ProgramStructure]]):
    """Execution position in a program, with an optional line at which execution stops."""

    def __init__(self, structure: ProgramStructure) -> None:
        super().__init__(FlowFrame(structure, 0, structure.main_end_index))
        self._stop: int | None = None  # index of the line before which execution stops

    def copy_position(self) -> Flow:
        """Return an independent copy of this position."""
        twin = copy(self)
        twin.frames = [replace(each, remaining_repeats=dict(each.remaining_repeats)) for each in self.frames]
        twin.active_frame = twin.frames[-1]
        return twin

    def stop_here(self) -> None:
        """End the program at the current position, so that no further line is executed."""
        self._stop = None
        self.end_index = self.next_index

    def stop_before(self, line: int) -> None:
        """Stop execution when it next reaches this line (from 1), in any loop execution or call."""
        self._stop = line - 1
        self._update_end()

    @property
    def is_at_stop_line(self) -> bool:
        """Return whether the next line is the line passed to ``stop_before``."""
        return self._stop is not None and self.next_index == self._stop

    def skip_stop_once(self) -> None:
        """Execute the line passed to ``stop_before`` once, and stop when execution reaches it again."""
        self.end_index = self.active_frame.end_index

    @property
    def position(self) -> FlowPosition:
        """Return the position, including all active loops and calls from the outermost to the innermost.

        Programs at equal positions continue identically.
        """
        self.active_frame.next_index = self.next_index
        return tuple(
            CallLevel(each.next_index, each.end_index, tuple(each.remaining_repeats.items()))
            for each in self.frames
        )

    def restore_position(self, line: int, position: FlowPosition) -> None:
        """Set the next line (counted from 1) and the active loops and calls."""
        if position:
            structure = self.active_frame.routine
            self.frames = [
                FlowFrame(structure, run.return_index, run.end_index, dict(run.remaining_repeats))
                for run in position
            ]
            self._resume_frame()
        self.next_index = line - 1

    def _update_end(self) -> None:
        """Set the end of execution to the end of the call frame or to the stop line, if it is earlier."""
        stop, end = self._stop, self.active_frame.end_index
        self.end_index = stop if stop is not None and self.next_index <= stop < end else end

    def get_remaining_repeats(self, start: int) -> int:
        """Return how often the innermost loop is still to be repeated.

        The result is 0 if the LS of this loop is not at the index ``start``.
        """
        left = self.active_frame.remaining_repeats
        return left[start] if left and next(reversed(left)) == start else 0

    def record_loop_executions(self, start: int, execution_count: int) -> None:
        """Record ``execution_count`` executions of the loop whose LS is at index ``start``.

        After each execution, the position is at the first line of the loop.
        """
        self.active_frame.remaining_repeats[start] -= execution_count

    def execute_flow_line(self, statement: Statement) -> None:
        """Execute a line with LS, LF or M99."""
        flow, self.next_index = statement.flow_code, statement.line
        frame, here = self.active_frame, statement.line - 1
        if flow == "LF":
            self._loop_end(frame.remaining_repeats, frame.routine.loop_starts.get(here))
        elif flow == "LS" and here in frame.routine.loop_ends:
            frame.remaining_repeats[here] = int(statement.get_value("LS") or 1) - 1
        elif flow == "M99" and len(self.frames) > 1:
            self.return_to_caller()
        if self._stop is not None:
            self._update_end()

    def call_subroutine(self, statement: Statement) -> None:
        """Enter the subroutine that the line calls. Raises ProgramError if calls are nested too deeply."""
        number, structure = get_subroutine_number(statement), self.active_frame.routine
        self.next_index = statement.line
        start = structure.subroutine_starts.get(number)
        if start is None:
            return  # already reported when the program was read
        if len(self.frames) > MAX_CALL_DEPTH:
            text = Message(
                "Subroutine calls are nested more than {deepest_call} levels deep.",
                deepest_call=MAX_CALL_DEPTH,
            )
            raise statement.make_error("P", "recursion", text, "A subroutine must not call itself.")
        self.enter_subprogram(
            FlowFrame(structure, start + 1, structure.subroutine_ends.get(number, start) + 1)
        )
        if self._stop is not None:
            self._update_end()

    def skip_contour(self, statement: Statement) -> range | None:
        """Skip the contour of a G75 or G78, and return the indices of its lines.

        Returns None if the contour is missing; parsing has already reported this error.
        """
        structure = self.active_frame.routine
        if "P" not in statement.words:
            end = structure.contour_ends.get(statement.line - 1)
            if end is None:
                return None
            self.next_index = end + 1
            return range(statement.line, end)
        number = int(statement.get_value("P") or 0)
        start = structure.subroutine_starts.get(number)
        return None if start is None else range(start + 1, structure.subroutine_ends.get(number, start))

    def _loop_end(self, remaining: dict[int, int], start: int | None) -> None:
        """Jump back to the line after LS if repeats remain.

        Only the LF of the innermost loop causes the jump.
        """
        if start is None or next(reversed(remaining), None) != start:
            return
        if remaining[start] > 0:
            remaining[start] -= 1
            self.next_index = start + 1
        else:
            del remaining[start]
