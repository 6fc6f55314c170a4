"""The proof of the part, which simulates material removal from the stock and reports faults.

All moves are collected first, because stock and tools that are not specified are derived from the moves.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.message import Message
from core.part.stock_spec import StockSpec
from core.part.turned_part import PartedPiece
from core.proving.part_simulation import PartSimulation
from core.proving.program_timeline import BlockGroup, MotionSpan, RestSpan
from core.proving.program_tools import PartSettings, ProgramTools
from core.proving.proof_report import PartReport, ProofReport, sort_findings
from core.proving.prove_program import ReportProgress, prove
from core.proving.tip_moves import ProgramStep, StepConverter, TipMove

MAX_MOVES = 50_000
"""Number of moves above which the part is made only if the stock is specified.

A million moves take half a minute. On the operator screen, long programs are never made because they would
slow the machine: see ``part_history``.
"""

_CHECK_INTERVAL = 200  # moves between two calls of ``check_canceled``


def prove_program_and_part(
    program: ProgramSource | SharedProgram,
    setup: InterpreterSetup,
    machine: Machine,
    part_settings: PartSettings,
    report_progress: ReportProgress | None = None,
    *,
    is_ideal: bool = False,
    on_span: Callable[[MotionSpan | RestSpan], None] | None = None,
    check_canceled: Callable[[float], None] | None = None,
) -> tuple[ProofReport, PartReport | None]:
    """Return the proof of a program, with the findings about its part.

    The proof of a mill program includes no part. ``on_span`` receives each span, as in ``prove``.
    ``check_canceled`` may raise to cancel while the part is made.
    """
    if machine.kind != "lathe":
        return prove(program, setup, machine, report_progress, is_ideal=is_ideal, on_span=on_span), None
    gathered = PartProof(part_settings)

    def process_span(span: MotionSpan | RestSpan) -> None:
        gathered.add_span(span)
        if on_span is not None:
            on_span(span)

    report = prove(program, setup, machine, report_progress, is_ideal=is_ideal, on_span=process_span)
    part = gathered.make_report(check_canceled)
    # findings of the reading, which does not know the stock
    known = {(each.line, each.code) for each in report.diagnostics}
    found = [each for each in part.findings if (each.line, each.code) not in known]
    left = _remove_weaker_findings(report.diagnostics, found)
    return replace(report, diagnostics=sort_findings((*left, *found))), part


def require_tool_offsets(report: ProofReport, setup: InterpreterSetup) -> ProofReport:
    """Return the report of ``prove`` with missing tool offsets as errors, if any offsets are known.

    The machine would not start with a missing offset. The operator screen and the command ``run`` reject
    such a start themselves.
    """
    if not setup.tools:
        return report
    found = (
        replace(each, severity=Severity.ERROR) if each.code == "tool-offset-missing" else each
        for each in report.diagnostics
    )
    return replace(report, diagnostics=tuple(found))


_WEAKER_CHECKS = {
    "cut-standing": {"spindle-off", "live-tool-off"},
    "drill-without-limit": {"no-speed-limit"},
    "arc-loop": {"arc-over-half"},
}
"""Warnings found without the stock, by the part check that reports the same problem with more certainty."""


def _remove_weaker_findings(report: Iterable[Diagnostic], findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics without the warnings that an error about the part makes redundant.

    For each error, only the last such warning on its line or before its block is removed.
    """
    left = list(report)
    for error in findings:
        if error.severity is not Severity.ERROR or error.code not in _WEAKER_CHECKS:
            continue
        weaker = [
            each
            for each in left
            if each.code in _WEAKER_CHECKS[error.code]
            and each.severity is Severity.WARNING
            and (each.line == error.line or 0 < each.block_number <= error.block_number)
        ]
        if weaker:
            left.remove(max(weaker, key=lambda each: each.block_number))
    return left


def _not_made(moves: int) -> PartReport:
    words = Message("with {moves} moves, the part cannot be computed unless stock is specified", moves=moves)
    return PartReport(None, 0.0, 0.0, 0.0, None, False, (), (words,), ())


class PartProof:
    """The proof of the part, calculated from the blocks that are collected during a pass."""

    def __init__(self, part_settings: PartSettings, parts: Iterable[BlockGroup] = ()) -> None:
        self._setting = part_settings
        self._parts: list[BlockGroup] = list(parts)
        self._moves = sum(map(len, self._parts))

    def add_span(self, span: MotionSpan | RestSpan) -> None:
        """Add the blocks of the next span of the program."""
        if isinstance(span, MotionSpan):
            parts = span.block_groups
        else:
            parts = ([span.block],) if span.block is not None else ()
        self._moves += sum(map(len, parts))
        if self._too_many:
            self._parts.clear()
        else:
            self._parts += parts

    @property
    def _too_many(self) -> bool:
        return self._moves > MAX_MOVES and self._setting.stock is None

    def make_report(self, check_canceled: Callable[[float], None] | None = None) -> PartReport:
        """Return the report on the part after the whole program.

        A very long program needs a specified stock. ``check_canceled`` regularly receives the number of
        completed moves and may raise to cancel.
        """
        if self._too_many:
            return _not_made(self._moves)
        making, steps = self._start_part()
        for done, step in enumerate(steps):
            if check_canceled is not None and done % _CHECK_INTERVAL == 0:
                check_canceled(done)
            making.apply_step(step)
        return making.make_report()

    def find_material_before_blocks(self, blocks: Collection[int]) -> dict[int, PartedPiece]:
        """Return the material before each of the given elementary blocks, by block number.

        Material that live tools remove is not subtracted.
        """
        making, steps = self._start_part()
        held: dict[int, PartedPiece] = {}
        for step in steps:
            if isinstance(step, TipMove) and step.n in blocks and making.part is not None:
                held.setdefault(step.n, making.part.make_remaining_piece())
            making.apply_step(step)
        return held

    def _start_part(self) -> tuple[PartSimulation, list[ProgramStep]]:
        """Return the part simulation with the stock in the chuck, and the steps of the program."""
        reading = StepConverter(self._setting.tips)
        steps = [step for part in self._parts for step in reading.convert_blocks(part)]
        tools = ProgramTools(steps, self._setting)
        stock = self._setting.stock or tools.assume_stock()
        if isinstance(stock, StockSpec):
            stock = stock.stock(tools.back_z_mm, tools.unit_mm)
        return PartSimulation(tools, stock, self._setting), steps
