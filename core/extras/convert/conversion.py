"""Conversion of a source program: reading the source, writing the result and proving it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.omniturn_writer import OmniTurnWriter, WrittenLine
from core.extras.convert.path_steps import MOVE_KINDS
from core.extras.convert.proof.conversion_proof import Proof, ReportLine, ignore_line, prove
from core.extras.convert.source_options import ConversionOptions
from core.extras.convert.source_reader import read_source
from core.interpreter.shared.job_setup import ControlLimits
from core.language.diagnostics import Diagnostic, ProgramError, Severity


@dataclass(frozen=True, slots=True)
class Conversion:
    """A converted program with its findings and its proof.

    ``findings`` refer to lines of the source. If they include an error, the converted ``lines`` must not be
    used.
    """

    lines: tuple[WrittenLine, ...]
    findings: tuple[Diagnostic, ...]
    proof: Proof

    @property
    def errors(self) -> Sequence[Diagnostic]:
        """Return the findings that prevent the conversion."""
        return [each for each in self.findings if each.severity is Severity.ERROR]

    @property
    def text(self) -> str:
        """Return the text of the converted program."""
        return "".join(f"{each.text}\n" for each in self.lines)


def group_findings(findings: Sequence[Diagnostic]) -> list[tuple[Diagnostic, str]]:
    """Return the first of each group of equal findings, with the line numbers of the others.

    Findings are equal if they have the same code and message. The line numbers are separated by commas.
    """
    first: dict[tuple[str, str], tuple[Diagnostic, list[int]]] = {}
    for each in findings:
        _, lines = first.setdefault((each.code, each.message), (each, []))
        lines.append(each.line)
    return [(each, ", ".join(str(line) for line in lines[1:])) for each, lines in first.values()]


def convert_program(
    texts: Sequence[str],
    options: ConversionOptions,
    limits: ControlLimits,
    report_line: ReportLine = ignore_line,
) -> Conversion:
    """Convert the lines of a source program to OmniTurn, and prove the result.

    ``limits`` are the limits of the control for which the result is proved. ``report_line`` is called with
    the number of each line that is proved.
    """
    state, findings = read_source(texts, options)
    if any(each.severity is Severity.ERROR for each in findings):
        return Conversion((), tuple(findings), Proof())
    if not any(step.kind in MOVE_KINDS for step in state.steps):
        return Conversion((), (*findings, make_error(0, 0, "file-empty").diagnostic), Proof())
    metric = bool(state.is_metric)
    writer = OmniTurnWriter(metric, options)
    try:
        writer.write_steps(state.steps)
    except ProgramError as error:
        return Conversion((), (*findings, *writer.warnings, error.diagnostic), Proof())
    lines = tuple(writer.lines)
    proof = prove(
        "".join(f"{each.text}\n" for each in lines),
        [each.source_line_number for each in lines],
        state.steps,
        limits,
        is_metric=metric,
        report_line=report_line,
    )
    return Conversion(lines, (*findings, *writer.warnings, *proof.errors), proof)
