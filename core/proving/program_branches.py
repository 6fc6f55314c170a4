"""All paths through a program, with both states of the input proved at each M95 and M97.

The first path uses the current inputs. At each conditional call, a copy of the pass is stored for the other
state. A path ends where it reaches a line in the same state as an earlier path, because the rest has
already been proved. Paths that are not proved are listed.
"""

from __future__ import annotations

import heapq
from array import array
from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from typing import NamedTuple

from core.interpreter.dialects import SharedProgram
from core.interpreter.omniturn.flow.conditional_calls import BranchingPass
from core.interpreter.omniturn.flow.loops_and_subroutines import get_input_terminal
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import InputRead
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.machine_requirements import remove_repeated_requirements
from core.language.diagnostics import Diagnostic, Severity
from core.machine.machine_model import Machine
from core.message import Message
from core.proving.checks.machine_checks import CuttingChecks
from core.proving.program_timeline import MotionSpan, RestSpan, RestState, Timeline
from core.proving.proof_pass import MAX_FINDINGS, ProofPass
from core.proving.proof_report import BranchSummary, ProofReport, ValueRange, sort_findings
from core.proving.spindle_forecast import SETTLING_TIME_S

# --- cycle times of all paths ---------------------------------------------------------------------------


class BranchFork(NamedTuple):
    """A point at which a second path branches off.

    It contains the number of blocks executed up to this point, the time in seconds, and the second path.
    """

    block_count: int
    time_s: float
    other_branch: ProgramBranch


@dataclass(slots=True, eq=False)
class ProgramBranch:
    """One path through the program; times are in seconds from the start of the program.

    ``block_end_times`` contains the end times of the blocks that follow the first ``preceding_block_count``
    blocks.
    """

    preceding_block_count: int = 0
    start_time_s: float = 0.0
    duration_s: float = 0.0  # time of its end, or of the point where it meets an earlier path
    block_end_times: array[float] = field(default_factory=lambda: array("d"))
    forks: list[BranchFork] = field(default_factory=list)
    merge_point: tuple[ProgramBranch, int] | None = (
        None  # the earlier path, and its number of blocks at this point
    )
    is_proved: bool = False
    has_failed: bool = False

    def get_time_after_blocks(self, block_count: int) -> float:
        """Return the time in seconds at which the first ``block_count`` blocks have been executed."""
        made = block_count - self.preceding_block_count
        if made <= 0 or not self.block_end_times:
            return self.start_time_s
        return self.block_end_times[min(made, len(self.block_end_times)) - 1]


_Node = tuple[ProgramBranch, int]
"""Branch and the index of a fork right after this point. After the last fork, it is the end of the branch."""


def find_cycle_time_range(first_branch: ProgramBranch) -> ValueRange:
    """Return the least and the greatest cycle time of all proved paths, in seconds."""
    known: dict[tuple[int, int], ValueRange] = {}
    todo: list[_Node] = [(first_branch, 0)]
    while todo:
        branch, at = node = todo[-1]
        missing = [n for n, _ in _next_nodes(node) if (id(n[0]), n[1]) not in known]
        if missing:
            todo += missing
            continue
        todo.pop()
        ends = [(t + known[id(n[0]), n[1]][0], t + known[id(n[0]), n[1]][1]) for n, t in _next_nodes(node)]
        if at == len(branch.forks) and branch.merge_point is None:
            ends = [(branch.duration_s - _time(node),) * 2]
        known[id(branch), at] = (min(low for low, _ in ends), max(high for _, high in ends))
    low, high = known[id(first_branch), 0]
    before = _time((first_branch, 0))
    return before + low, before + high


def _time(node: _Node) -> float:
    branch, at = node
    if at < len(branch.forks):
        return branch.forks[at].time_s
    return branch.forks[-1].time_s if branch.forks else branch.start_time_s


def _next_nodes(node: _Node) -> list[tuple[_Node, float]]:
    """Return the nodes that follow a node, each with the time in seconds to reach it."""
    branch, at = node
    if at < len(branch.forks):
        here, other = branch.forks[at].time_s, branch.forks[at].other_branch
        follows: list[tuple[_Node, float]] = [((branch, at + 1), _time((branch, at + 1)) - here)]
        if other.is_proved and not other.has_failed:
            follows.append(((other, 0), _time((other, 0)) - other.start_time_s))
        return follows
    if branch.merge_point is None:
        return []
    there, blocks = branch.merge_point
    fork = next((k for k, each in enumerate(there.forks) if each.block_count >= blocks), len(there.forks))
    node = there, fork
    return [
        (node, branch.duration_s - _time((branch, at)) + _time(node) - there.get_time_after_blocks(blocks))
    ]


# --- uncalled subroutines -------------------------------------------------------------------------------


def find_uncalled_subroutines(reading: SharedProgram) -> Iterator[Diagnostic]:
    """Yield a note for each subroutine that the main program never calls."""
    program = reading.omniturn_program
    if program is None or not program.structure.subroutine_starts:
        return
    reached = _reached(program)
    for number, at in sorted(program.structure.subroutine_starts.items()):
        if number not in reached:
            text = Message("Subroutine {number} is never called, so it was not proved.", number=number)
            hint = Message("Call the subroutine with M98P{number}, or remove the subroutine.", number=number)
            yield Diagnostic(
                at + 1, 0, Severity.NOTE, "unreached-branch", text, hint, check_name="unreached-branch"
            )


def _reached(program: Program) -> set[int]:
    structure = program.structure
    calls: dict[int, set[int]] = {}
    for line, number in program.subroutine_calls:
        calls.setdefault(_enclosing_subroutine(program, line - 1), set()).add(number)
    reached: set[int] = set()
    todo = [0]
    while todo:
        for number in calls.get(todo.pop(), ()):
            if number in structure.subroutine_starts and number not in reached:
                reached.add(number)
                todo.append(number)
    return reached


def _enclosing_subroutine(program: Program, line_index: int) -> int:
    """Return the number of the subroutine that contains the line with this index.

    The result is 0 for the main program.
    """
    structure = program.structure
    if line_index < structure.main_end_index:
        return 0
    starts = [(start, number) for number, start in structure.subroutine_starts.items() if start <= line_index]
    return max(starts)[1] if starts else 0


MAX_BRANCHES = 400
MAX_BRANCH_WORK = 200_000
"""Maximum work for all branches except the first, in blocks.

The limit is three times the work of the first branch if that is more. A motion from rest to rest counts as
100 blocks.
"""

_SPAN = 100

_MAX_WAITING = 2000
_MAX_STATES = 500_000


@dataclass(frozen=True, slots=True)
class InputChoice:
    """The assumed state of one input at one program line."""

    line: int
    terminal_name: str
    is_on: bool

    @property
    def description(self) -> str:
        """Return the choice as text for the operator."""
        name = "7" if self.terminal_name == "TB2-9" else self.terminal_name
        return Message(
            "input {number} is {state} at line {line}",
            number=name,
            state="on" if self.is_on else "off",
            line=self.line,
        )


@dataclass(slots=True)
class _BranchPass:
    """One path through the program that is being proved or is waiting to be proved."""

    branch: ProgramBranch
    interpreter_pass: BranchingPass | None
    choices: tuple[InputChoice, ...] = ()
    rest_state: RestState | None = None  # None: not reached, because the path before it has errors
    checks: CuttingChecks | None = None
    branches_by_call: list[_BranchPass | None] = field(
        default_factory=list
    )  # in the order of its conditional calls
    processed_call_count: int = 0


def _add_choices(choices: Sequence[InputChoice], message: str) -> str:
    """Return the message preceded by a condition that names the last two input states of its path."""
    if len(choices) == 1:
        return Message("If {input}: {message}", input=choices[0].description, message=message)
    return Message(
        "If {input} and {second}: {message}",
        input=choices[-2].description,
        second=choices[-1].description,
        message=message,
    )


class BranchProof:
    """The proof of all paths of a program.

    ``iter_spans`` proves the first path, and ``report_all_branches`` proves the other paths.
    """

    def __init__(
        self, reading: SharedProgram, setup: InterpreterSetup, machine: Machine, *, ideal: bool
    ) -> None:
        self._reading, self._setup, self._machine, self._ideal = reading, setup, machine, ideal
        self.root_pass = reading.start_branching_pass(setup, self)
        self._current = _BranchPass(ProgramBranch(), self.root_pass)
        self._known: dict[Hashable, tuple[ProgramBranch, int]] = {}
        self._waiting: list[tuple[tuple[int, ...], _BranchPass]] = []
        self._seen: Counter[tuple[int, bool]] = Counter()  # number of stored copies by line and state
        self._covered: set[tuple[int, bool]] = set()  # lines with the states of their inputs that were proved
        self._turn = count()
        self._unproved = 0
        self._proved = 1
        self._found: list[Diagnostic] = []
        self._reported: set[tuple[int, str]] = set()
        self._tools: set[int] = set()
        self._missing: set[int] = set()
        self._work = 0

    # Called by the interpreter:

    def is_state_known(self, branch: BranchingPass) -> bool:
        """Return whether an earlier path has already reached the state of ``branch``."""
        key = branch.state_key
        found = self._known.get(key)
        if found is not None and found[0] is not self._current.branch:
            self._current.branch.merge_point = found
            return True
        if len(self._known) < _MAX_STATES:
            self._known[key] = self._current.branch, branch.block_count
        return False

    def record_branch(self, branch: BranchingPass, statement: Statement, is_call_made: bool) -> None:
        """Store a copy of the pass at a conditional call, for the other state of the input."""
        on = is_call_made == (statement.flow_code == "M95" or statement.get_value("C") == 1)
        self._covered.add((statement.line, on))
        if branch.is_stopped:
            return
        seen = self._seen[statement.line, not on]
        if len(self._waiting) >= _MAX_WAITING and seen:
            self._unproved += 1
            self._current.branches_by_call.append(None)
            return
        self._seen[statement.line, not on] += 1
        choice = InputChoice(statement.line, get_input_terminal(statement), not on)
        other = branch.copy_for_other_branch(statement, is_call_made)
        branch_pass = _BranchPass(
            ProgramBranch(preceding_block_count=branch.block_count),
            other,
            (*self._current.choices, choice),
            branches_by_call=[None],
        )
        self._current.branches_by_call.append(branch_pass)
        rank = (int(other.has_input_change), seen, len(branch_pass.choices), next(self._turn))
        heapq.heappush(self._waiting, (rank, branch_pass))

    # Called by the proof:

    def iter_spans(self, proof_pass: ProofPass, timeline: Timeline) -> Iterator[MotionSpan | RestSpan]:
        """Yield the spans of the current path while the path is executed."""
        if self.root_pass is None:
            yield from timeline.iter_spans()
            return
        now = self._current
        for span in timeline.iter_spans():
            yield span
            if isinstance(span, MotionSpan):
                shift = span.start_time_s - span.planned_chunk.start_time_s
                self._work += _SPAN + len(span.planned_chunk.block_ends_s)
                now.branch.block_end_times.extend((span.planned_chunk.block_ends_s + shift).tolist())
            elif span.block is not None:
                now.branch.block_end_times.append(span.end_time_s)
                if isinstance(span.block.action, InputRead):
                    self._record_rest_state(now, proof_pass, timeline)
        now.branch.duration_s = timeline.time_s
        if now.branch.merge_point is not None and proof_pass.last_block is proof_pass.last_moving_block:
            now.branch.duration_s -= (
                0.0 if self._ideal else SETTLING_TIME_S
            )  # the motion would have continued
        now.branch.has_failed = timeline.has_errors

    def _record_rest_state(
        self, current_pass: _BranchPass, proof_pass: ProofPass, timeline: Timeline
    ) -> None:
        """Record the machine state at a conditional call, from which the other path continues."""
        branch_pass = (
            current_pass.branches_by_call[current_pass.processed_call_count]
            if current_pass.processed_call_count < len(current_pass.branches_by_call)
            else None
        )
        current_pass.processed_call_count += 1
        if branch_pass is not None:
            branch_pass.rest_state, branch_pass.checks = (
                timeline.rest_state,
                proof_pass.cutting_checks.copy_for_branch(),
            )
            branch_pass.branch.start_time_s = timeline.time_s
            current_pass.branch.forks.append(
                BranchFork(branch_pass.branch.preceding_block_count, timeline.time_s, branch_pass.branch)
            )

    def report_all_branches(
        self, report: ProofReport, report_progress: Callable[[float], None] | None
    ) -> ProofReport:
        """Return the report of the first path, together with the findings of all other paths."""
        found = [*report.diagnostics, *find_uncalled_subroutines(self._reading)]
        if self.root_pass is None:
            return replace(
                report,
                diagnostics=sort_findings(found),
                branch_summary=BranchSummary(cycle_time_range=(report.program_times.cycle_time_s,) * 2),
            )
        self._reported = {(each.line, each.code) for each in report.diagnostics}
        first = self._current.branch
        needs = report.required_functions
        most, self._work = max(MAX_BRANCH_WORK, 3 * self._work), 0
        while self._waiting and self._proved < MAX_BRANCHES and self._work < most:
            _, branch_pass = heapq.heappop(self._waiting)
            if branch_pass.rest_state is not None:
                other = self._prove(branch_pass, most, report_progress)
                needs = remove_repeated_requirements((*needs, *other.required_functions))
        found += [*self._found[:MAX_FINDINGS], *self._unproved_findings()]
        return replace(
            report,
            diagnostics=sort_findings(found),
            tool_numbers=tuple(sorted(self._tools.union(report.tool_numbers))),
            missing_tool_numbers=tuple(sorted(self._missing.union(report.missing_tool_numbers))),
            required_functions=needs,
            branch_summary=BranchSummary(
                self._proved, self._unproved + len(self._waiting), find_cycle_time_range(first)
            ),
        )

    def _prove(
        self, branch_pass: _BranchPass, most: int, progress: Callable[[float], None] | None
    ) -> ProofReport:
        assert branch_pass.interpreter_pass is not None
        assert branch_pass.rest_state is not None
        assert branch_pass.checks is not None
        self._current, self._proved = branch_pass, self._proved + 1
        self._covered.add((branch_pass.choices[-1].line, branch_pass.choices[-1].is_on))
        timeline = Timeline(branch_pass.interpreter_pass, self._setup, self._machine, ideal=self._ideal)
        timeline.continue_from(branch_pass.rest_state)
        proof_pass = ProofPass(self._machine, branch_pass.checks)
        for span in self.iter_spans(proof_pass, timeline):
            proof_pass.add_span(span)
            if progress is not None and proof_pass.last_block is not None:
                progress(proof_pass.last_block.n)
            if self._work > most:
                self._unproved += 1
                branch_pass.branch.has_failed = True  # the time of this path is unknown
                break
        branch_pass.branch.is_proved = True
        report = proof_pass.make_report(timeline, self._reading.source)
        self._tools.update(report.tool_numbers)
        self._missing.update(report.missing_tool_numbers)
        self._report(branch_pass, report)
        branch_pass.interpreter_pass = None
        return report

    def _report(self, branch_pass: _BranchPass, report: ProofReport) -> None:
        unlikely = branch_pass.interpreter_pass is not None and branch_pass.interpreter_pass.has_input_change
        for each in report.diagnostics:
            if each.severity is Severity.NOTE or (each.line, each.code) in self._reported:
                continue
            self._reported.add((each.line, each.code))
            weight = Severity.WARNING if unlikely else each.severity
            self._found.append(
                replace(each, severity=weight, message=_add_choices(branch_pass.choices, each.message))
            )

    def _unproved_findings(self) -> Iterator[Diagnostic]:
        """Yield a warning that names the unproved paths."""
        left = self._unproved + len(self._waiting)
        if not left:
            return
        last = [branch_pass.choices[-1] for _, branch_pass in self._waiting]
        never = {choice.description for choice in last if (choice.line, choice.is_on) not in self._covered}
        text = Message(
            "{left} input-dependent paths through the program were not proved; {proved} paths were proved.",
            left=left,
            proved=self._proved,
        )
        if never:
            text = Message(
                "{what} Branches not proved: {never}.", what=text, never=", ".join(sorted(never)[:5])
            )
        hint = (
            "Use fewer conditional calls in loops, or end each subroutine at its start position, "
            "so that TurnDesk can prove every possible path."
        )
        line = min((choice.line for choice in last), default=0)
        yield Diagnostic(
            line, 0, Severity.WARNING, "unreached-branch", text, hint, check_name="unreached-branch"
        )
