"""Conversion of a source program: reading the source, writing the result and proving it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from core.extras.convert.conversion_messages import make_error, make_note
from core.extras.convert.omniturn_writer import OmniTurnWriter, WrittenLine
from core.extras.convert.path_steps import MOVE_KINDS
from core.extras.convert.proof.conversion_proof import Proof, ReportLine, ignore_line, prove
from core.extras.convert.source_lines import split_lines
from core.extras.convert.source_options import ConversionOptions
from core.extras.convert.source_reader import read_source
from core.interpreter.shared.job_setup import ControlLimits
from core.language.diagnostics import Diagnostic, ProgramError, Severity

_SWITCH = re.compile(r"/\d?")


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
    deletable = find_deletable_lines(texts, options)
    kept = _convert_with_block_delete(texts, options, limits, deletable, report_line) if deletable else None
    if kept is not None:
        return kept
    metric = bool(state.is_metric)
    writer = OmniTurnWriter(metric, options, title=find_program_title(texts, options))
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


def find_program_title(texts: Sequence[str], options: ConversionOptions) -> str:
    """Return the program number of the main program, such as O1000, or an empty string."""
    for line in split_lines(texts, options.control):
        if line.code.strip():
            return f"O{line.o_word}" if line.o_word.isdecimal() and not line.o_keyword else ""
    return ""


def find_deletable_lines(texts: Sequence[str], options: ConversionOptions) -> frozenset[int]:
    """Return the lines that begin with /, or none if they have several numbers, such as /2 and /3.

    OmniTurn has only one switch for block delete.
    """
    lines = [each for each in split_lines(texts, options.control) if each.has_block_delete]
    switches = {found[0] for each in lines if (found := _SWITCH.match(each.code.strip())) is not None}
    return frozenset(each.line_number for each in lines) if len(switches) == 1 else frozenset()


def _convert_with_block_delete(
    texts: Sequence[str],
    options: ConversionOptions,
    limits: ControlLimits,
    deletable: frozenset[int],
    report_line: ReportLine,
) -> Conversion | None:
    """Convert a program whose lines with / keep their /, or return None if this cannot be proved.

    The program is proved twice: with all lines, and without the lines that block delete skips.
    """
    without = ["" if line in deletable else text for line, text in enumerate(texts, start=1)]
    (state, findings), (other, other_findings) = read_source(texts, options), read_source(without, options)
    metric = bool(state.is_metric)
    if any(each.severity is Severity.ERROR for each in other_findings) or bool(other.is_metric) is not metric:
        return None
    title = find_program_title(texts, options)
    for repeats_axes in (True, False):  # a move after these lines has both axes, or only those of its line
        writer = OmniTurnWriter(
            metric, options, deletable_lines=deletable, repeats_axes=repeats_axes, title=title
        )
        try:
            writer.write_steps(state.steps)
        except ProgramError:
            return None
        text = "".join(f"{each.text}\n" for each in writer.lines)
        sources = [each.source_line_number for each in writer.lines]
        proof = prove(text, sources, state.steps, limits, is_metric=metric, report_line=report_line)
        skipped = prove(text, sources, other.steps, limits, is_metric=metric, has_block_delete=True)
        if not proof.errors and not skipped.errors:
            shown = [_note_block_delete(each, texts) for each in findings]
            return Conversion(tuple(writer.lines), (*shown, *writer.warnings), proof)
    return None


def _note_block_delete(finding: Diagnostic, texts: Sequence[str]) -> Diagnostic:
    """Return a note instead of the warning that / is left out, and any other finding unchanged."""
    if finding.code != "block-delete":
        return finding
    word = texts[finding.line - 1].strip()
    return make_note(finding.line, finding.column, "block-delete-kept", word=word)
