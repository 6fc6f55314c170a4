"""The proof of the part: the blocks of a program remove material from the stock, and faults are reported.

All moves are collected first, because unspecified stock and tools are derived from them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.job_setup import Setup
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Source
from core.machine.machine_model import Machine
from core.message import Message
from core.part.stock_spec import StockSpec
from core.part.turned_part import Piece
from core.proving.part_making import PartMaking
from core.proving.program_timeline import MotionSpan, Part, RestSpan
from core.proving.program_tools import PartSetting, ProgramTools
from core.proving.proof_report import PartReport, Report, in_order
from core.proving.prove_program import Progress, prove
from core.proving.tip_moves import Step, Steps, TipMove

MOST_MOVES = 50_000
"""Of a longer program the part is made when somebody has said its stock: a million take half a minute.

On the desk, where it would be in the way of a machine, never: ``part_history``.
"""

_WATCHED = 200  # moves between two calls of ``watch``


def prove_with_part(
    program: Source | ReadProgram, setup: Setup, machine: Machine, setting: PartSetting,
    progress: Progress | None = None, *, ideal: bool = False,
    seen: Callable[[MotionSpan | RestSpan], None] | None = None,
    watch: Callable[[float], None] | None = None,
) -> tuple[Report, PartReport | None]:  # fmt: skip
    """Return the proof of a program including the findings of its part. A mill has no part proof.

    ``seen`` receives each span, as in ``prove``. ``watch`` may cancel while the part is made.
    """
    if machine.kind != "lathe":
        return prove(program, setup, machine, progress, ideal=ideal, seen=seen), None
    gathered = PartProof(setting)

    def see(span: MotionSpan | RestSpan) -> None:
        gathered.see(span)
        if seen is not None:
            seen(span)

    report = prove(program, setup, machine, progress, ideal=ideal, seen=see)
    part = gathered.report(watch)
    # findings of the reading, which does not know the stock
    known = {(each.line, each.code) for each in report.diagnostics}
    found = [each for each in part.findings if (each.line, each.code) not in known]
    left = _without_weaker(report.diagnostics, found)
    return replace(report, diagnostics=in_order((*left, *found))), part


def refusing_missing_offsets(report: Report, setup: Setup) -> Report:
    """Return the report of ``prove`` with a missing tool offset as an error if offsets are known.

    The machine would not start with it. The operator screen and ``run`` refuse such a start themselves.
    """
    if not setup.tools:
        return report
    found = (
        replace(each, severity=Severity.ERROR) if each.code == "tool-offset-missing" else each
        for each in report.diagnostics
    )
    return replace(report, diagnostics=tuple(found))


_WEAKER = {
    "cut-standing": {"spindle-off", "live-tool-off"},
    "drill-without-limit": {"no-speed-limit"},
    "arc-loop": {"arc-over-half"},
}
"""By check of the part: the warnings, found without the stock, that say the same with less certainty."""


def _without_weaker(report: Iterable[Diagnostic], found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the report without warnings that an error of the part confirms.

    The error must be on the same line or later.
    """
    left = list(report)
    for error in found:
        if error.severity is not Severity.ERROR or error.code not in _WEAKER:
            continue
        weaker = [
            each
            for each in left
            if each.code in _WEAKER[error.code]
            and each.severity is Severity.WARNING
            and (each.line == error.line or 0 < each.n <= error.n)
        ]
        if weaker:
            left.remove(max(weaker, key=lambda each: each.n))
    return left


def _not_made(moves: int) -> PartReport:
    words = Message("with {moves} moves, the part cannot be computed unless stock is specified", moves=moves)
    return PartReport(None, 0.0, 0.0, 0.0, None, False, (), (words,), ())


class PartProof:
    """Collects the blocks of a pass and makes the part from them."""

    def __init__(self, setting: PartSetting, parts: Iterable[Part] = ()) -> None:
        self._setting = setting
        self._parts: list[Part] = list(parts)
        self._moves = sum(map(len, self._parts))

    def see(self, span: MotionSpan | RestSpan) -> None:
        """Add the next span of the program."""
        if isinstance(span, MotionSpan):
            parts = span.parts
        else:
            parts = ([span.block],) if span.block is not None else ()
        self._moves += sum(map(len, parts))
        if self._too_many:
            self._parts.clear()
        else:
            self._parts += parts

    @property
    def _too_many(self) -> bool:
        return self._moves > MOST_MOVES and self._setting.stock is None

    def report(self, watch: Callable[[float], None] | None = None) -> PartReport:
        """Return the part after the whole program. A very long program needs a specified stock.

        ``watch`` receives the number of moves done regularly and may raise to cancel.
        """
        if self._too_many:
            return _not_made(self._moves)
        making, steps = self._begun()
        for done, step in enumerate(steps):
            if watch is not None and done % _WATCHED == 0:
                watch(done)
            making.see(step)
        return making.report()

    def metal_at(self, blocks: Collection[int]) -> dict[int, Piece]:
        """Return the material before each of these elementary blocks, by number, without live tools."""
        making, steps = self._begun()
        held: dict[int, Piece] = {}
        for step in steps:
            if isinstance(step, TipMove) and step.n in blocks and making.part is not None:
                held.setdefault(step.n, making.part.rest())
            making.see(step)
        return held

    def _begun(self) -> tuple[PartMaking, list[Step]]:
        """Return the part with the stock in the chuck, and the steps of the program."""
        reading = Steps(self._setting.tips)
        steps = [step for part in self._parts for step in reading.of(part)]
        tools = ProgramTools(steps, self._setting)
        stock = self._setting.stock or tools.assumed_stock()
        if isinstance(stock, StockSpec):
            stock = stock.stock(tools.back, tools.unit)
        return PartMaking(tools, stock, self._setting), steps
