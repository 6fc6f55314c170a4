"""All paths through a program: at M95 and M97, both states of the input are proved before the start.

The first path uses the given inputs. At each conditional call, a copy of the pass is stored for the other
state. A path ends where it reaches a line in the same state as an earlier path, because everything after that
has been proved. Paths that are not proved are listed.
"""

from __future__ import annotations

import heapq
from array import array
from collections import Counter
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from typing import NamedTuple

from core.interpreter.dialects import ReadProgram
from core.interpreter.omniturn.flow.conditional_calls import Branching
from core.interpreter.omniturn.flow.loops_and_subroutines import terminal
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import AskInput
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.machine_requirements import first_needs
from core.language.diagnostics import Diagnostic, Severity
from core.machine.machine_model import Machine
from core.message import Message
from core.proving.checks.machine_checks import CuttingChecks
from core.proving.program_timeline import MotionSpan, RestSpan, RestState, Timeline
from core.proving.proof_pass import MAX_FINDINGS, ProofPass
from core.proving.proof_report import Range, Report, Ways, in_order
from core.proving.spindle_forecast import SETTLING

# --- cycle times of all paths ---------------------------------------------------------------------------


class Fork(NamedTuple):
    """The place where another path leaves a path: blocks executed before, the time, and the other path."""

    blocks: int
    t: float
    other: Branch


@dataclass(slots=True, eq=False)
class Branch:
    """One path through the program, in seconds from its start.

    ``ends`` contains the end times of its blocks from ``first`` + 1 on.
    """

    first: int = 0
    start: float = 0.0
    duration: float = 0.0  # time of its end, or of the point where it meets an earlier path
    ends: array[float] = field(default_factory=lambda: array("d"))
    forks: list[Fork] = field(default_factory=list)
    merged: tuple[Branch, int] | None = None  # the earlier path, and its number of blocks at this point
    proved: bool = False
    failed: bool = False

    def at(self, blocks: int) -> float:
        """Return the time in seconds when ``blocks`` blocks have been executed."""
        made = blocks - self.first
        if made <= 0 or not self.ends:
            return self.start
        return self.ends[min(made, len(self.ends)) - 1]


_Node = tuple[Branch, int]
"""A way right before one of its forks; behind the last one, up to its end."""


def cycle_range(first: Branch) -> Range:
    """Return the least and the greatest cycle time of all proved paths."""
    known: dict[tuple[int, int], Range] = {}
    todo: list[_Node] = [(first, 0)]
    while todo:
        branch, at = node = todo[-1]
        missing = [n for n, _ in _next(node) if (id(n[0]), n[1]) not in known]
        if missing:
            todo += missing
            continue
        todo.pop()
        ends = [(t + known[id(n[0]), n[1]][0], t + known[id(n[0]), n[1]][1]) for n, t in _next(node)]
        if at == len(branch.forks) and branch.merged is None:
            ends = [(branch.duration - _time(node),) * 2]
        known[id(branch), at] = (min(low for low, _ in ends), max(high for _, high in ends))
    low, high = known[id(first), 0]
    before = _time((first, 0))
    return before + low, before + high


def _time(node: _Node) -> float:
    branch, at = node
    if at < len(branch.forks):
        return branch.forks[at].t
    return branch.forks[-1].t if branch.forks else branch.start


def _next(node: _Node) -> list[tuple[_Node, float]]:
    """Return the nodes that follow, each with the seconds to it."""
    branch, at = node
    if at < len(branch.forks):
        here, other = branch.forks[at].t, branch.forks[at].other
        follows: list[tuple[_Node, float]] = [((branch, at + 1), _time((branch, at + 1)) - here)]
        if other.proved and not other.failed:
            follows.append(((other, 0), _time((other, 0)) - other.start))
        return follows
    if branch.merged is None:
        return []
    there, blocks = branch.merged
    fork = next((k for k, each in enumerate(there.forks) if each.blocks >= blocks), len(there.forks))
    node = there, fork
    return [(node, branch.duration - _time((branch, at)) + _time(node) - there.at(blocks))]


# --- uncalled subroutines -------------------------------------------------------------------------------


def uncalled(reading: ReadProgram) -> Iterator[Diagnostic]:
    """Yield a note for each subroutine that the main program never calls."""
    program = reading.program
    if program is None or not program.structure.subroutines:
        return
    reached = _reached(program)
    for number, at in sorted(program.structure.subroutines.items()):
        if number not in reached:
            text = Message("Subroutine {number} is never called, so it was not proved.", number=number)
            hint = Message("Call the subroutine with M98P{number}, or remove the subroutine.", number=number)
            yield Diagnostic(
                at + 1, 0, Severity.NOTE, "unreached-branch", text, hint, check="unreached-branch"
            )


def _reached(program: Program) -> set[int]:
    structure = program.structure
    calls: dict[int, set[int]] = {}
    for line, number in program.calls:
        calls.setdefault(_home(program, line - 1), set()).add(number)
    reached: set[int] = set()
    todo = [0]
    while todo:
        for number in calls.get(todo.pop(), ()):
            if number in structure.subroutines and number not in reached:
                reached.add(number)
                todo.append(number)
    return reached


def _home(program: Program, at: int) -> int:
    """Return the number of the subroutine that contains the line with this index; 0 for the main program."""
    structure = program.structure
    if at < structure.main_end:
        return 0
    starts = [(start, number) for number, start in structure.subroutines.items() if start <= at]
    return max(starts)[1] if starts else 0


MOST_WAYS = 400
MOST_WORK = 200_000
"""Blocks of all ways but the first together; three times those of the first where that is more. A motion from
rest to rest is as much work as a hundred blocks."""

_SPAN = 100

_MOST_WAITING = 2000
_MOST_STATES = 500_000


@dataclass(frozen=True, slots=True)
class Choice:
    """The assumed state of one input at one line."""

    line: int
    terminal: str
    on: bool

    @property
    def words(self) -> str:
        """The choice as a text for the operator."""
        name = "7" if self.terminal == "TB2-9" else self.terminal
        return Message(
            "input {number} is {state} at line {line}",
            number=name,
            state="on" if self.on else "off",
            line=self.line,
        )


@dataclass(slots=True)
class _BranchPass:
    """One path through the program that is being proved or waits for its proof."""

    branch: Branch
    source: Branching | None
    choices: tuple[Choice, ...] = ()
    rest_state: RestState | None = None  # None: not reached, because the path before it has errors
    checks: CuttingChecks | None = None
    asked: list[_BranchPass | None] = field(default_factory=list)  # in the order of its conditional calls
    answered: int = 0


def _with(choices: Sequence[Choice], message: str) -> str:
    """Return a message with the last two inputs of its path, which the operator can check."""
    if len(choices) == 1:
        return Message("If {input}: {message}", input=choices[0].words, message=message)
    return Message(
        "If {input} and {second}: {message}",
        input=choices[-2].words,
        second=choices[-1].words,
        message=message,
    )


class Branches:
    """Proves all paths of a program: the first one in ``spans``, the others in ``report_of_all``."""

    def __init__(self, reading: ReadProgram, setup: Setup, machine: Machine, *, ideal: bool) -> None:
        self._reading, self._setup, self._machine, self._ideal = reading, setup, machine, ideal
        self.root = reading.branching(setup, self)
        self._current = _BranchPass(Branch(), self.root)
        self._known: dict[Hashable, tuple[Branch, int]] = {}
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

    def known(self, branch: Branching) -> bool:
        """Return whether an earlier path has been in this state."""
        key = branch.key
        found = self._known.get(key)
        if found is not None and found[0] is not self._current.branch:
            self._current.branch.merged = found
            return True
        if len(self._known) < _MOST_STATES:
            self._known[key] = self._current.branch, branch.count
        return False

    def asked(self, branch: Branching, made: Statement, takes: bool) -> None:
        """Store a copy of the pass for the other state of a conditional call."""
        on = takes == (made.flow == "M95" or made.value("C") == 1)
        self._covered.add((made.line, on))
        if branch.stopped:
            return
        seen = self._seen[made.line, not on]
        if len(self._waiting) >= _MOST_WAITING and seen:
            self._unproved += 1
            self._current.asked.append(None)
            return
        self._seen[made.line, not on] += 1
        choice = Choice(made.line, terminal(made), not on)
        other = branch.other(made, takes)
        branch_pass = _BranchPass(
            Branch(first=branch.count), other, (*self._current.choices, choice), asked=[None]
        )
        self._current.asked.append(branch_pass)
        rank = (int(other.unlikely), seen, len(branch_pass.choices), next(self._turn))
        heapq.heappush(self._waiting, (rank, branch_pass))

    # Called by the proof:

    def spans(self, proof_pass: ProofPass, timeline: Timeline) -> Iterator[MotionSpan | RestSpan]:
        """Yield the spans of the present path while it is executed."""
        if self.root is None:
            yield from timeline.spans()
            return
        now = self._current
        for span in timeline.spans():
            yield span
            if isinstance(span, MotionSpan):
                shift = span.t0 - span.chunk.t
                self._work += _SPAN + len(span.chunk.t1)
                now.branch.ends.extend((span.chunk.t1 + shift).tolist())
            elif span.block is not None:
                now.branch.ends.append(span.t1)
                if isinstance(span.block.action, AskInput):
                    self._stands(now, proof_pass, timeline)
        now.branch.duration = timeline.t
        if now.branch.merged is not None and proof_pass.last is proof_pass.last_move:
            now.branch.duration -= 0.0 if self._ideal else SETTLING  # the motion would have continued
        now.branch.failed = timeline.errors

    def _stands(self, now: _BranchPass, proof_pass: ProofPass, timeline: Timeline) -> None:
        """Record the state at a conditional call, from which the copy continues."""
        branch_pass = now.asked[now.answered] if now.answered < len(now.asked) else None
        now.answered += 1
        if branch_pass is not None:
            branch_pass.rest_state, branch_pass.checks = timeline.rest_state, proof_pass.checks.twin()
            branch_pass.branch.start = timeline.t
            now.branch.forks.append(Fork(branch_pass.branch.first, timeline.t, branch_pass.branch))

    def report_of_all(self, report: Report, progress: Callable[[float], None] | None) -> Report:
        """Return the report of the first path together with the findings of all other paths."""
        found = [*report.diagnostics, *uncalled(self._reading)]
        if self.root is None:
            return replace(report, diagnostics=in_order(found), ways=Ways(cycle=(report.times.cycle,) * 2))
        self._reported = {(each.line, each.code) for each in report.diagnostics}
        first = self._current.branch
        needs = report.needs
        most, self._work = max(MOST_WORK, 3 * self._work), 0
        while self._waiting and self._proved < MOST_WAYS and self._work < most:
            _, branch_pass = heapq.heappop(self._waiting)
            if branch_pass.rest_state is not None:
                other = self._prove(branch_pass, most, progress)
                needs = first_needs((*needs, *other.needs))
        found += [*self._found[:MAX_FINDINGS], *self._unreached()]
        return replace(
            report,
            diagnostics=in_order(found),
            tools=tuple(sorted(self._tools.union(report.tools))),
            missing_tools=tuple(sorted(self._missing.union(report.missing_tools))),
            needs=needs,
            ways=Ways(self._proved, self._unproved + len(self._waiting), cycle_range(first)),
        )

    def _prove(self, branch_pass: _BranchPass, most: int, progress: Callable[[float], None] | None) -> Report:
        assert branch_pass.source is not None
        assert branch_pass.rest_state is not None
        assert branch_pass.checks is not None
        self._current, self._proved = branch_pass, self._proved + 1
        self._covered.add((branch_pass.choices[-1].line, branch_pass.choices[-1].on))
        timeline = Timeline(branch_pass.source, self._setup, self._machine, ideal=self._ideal)
        timeline.go_on(branch_pass.rest_state)
        proof_pass = ProofPass(self._machine, branch_pass.checks)
        for span in self.spans(proof_pass, timeline):
            proof_pass.add(span)
            if progress is not None and proof_pass.last is not None:
                progress(proof_pass.last.n)
            if self._work > most:
                self._unproved += 1
                branch_pass.branch.failed = True  # the time of this path is unknown
                break
        branch_pass.branch.proved = True
        report = proof_pass.report(timeline, self._reading.source)
        self._tools.update(report.tools)
        self._missing.update(report.missing_tools)
        self._report(branch_pass, report)
        branch_pass.source = None
        return report

    def _report(self, branch_pass: _BranchPass, report: Report) -> None:
        unlikely = branch_pass.source is not None and branch_pass.source.unlikely
        for each in report.diagnostics:
            if each.severity is Severity.NOTE or (each.line, each.code) in self._reported:
                continue
            self._reported.add((each.line, each.code))
            weight = Severity.WARNING if unlikely else each.severity
            self._found.append(
                replace(each, severity=weight, message=_with(branch_pass.choices, each.message))
            )

    def _unreached(self) -> Iterator[Diagnostic]:
        """Yield a warning that names the paths that were not proved."""
        left = self._unproved + len(self._waiting)
        if not left:
            return
        last = [branch_pass.choices[-1] for _, branch_pass in self._waiting]
        never = {choice.words for choice in last if (choice.line, choice.on) not in self._covered}
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
        yield Diagnostic(line, 0, Severity.WARNING, "unreached-branch", text, hint, check="unreached-branch")
