"""Conversions to LinuxCNC, Fanuc and SINUMERIK, with their proofs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from core.extras.convert.conversion import Conversion
from core.extras.convert.conversion_messages import make_error, make_note, make_warning
from core.extras.convert.path_steps import MOVE_KINDS
from core.extras.convert.proof.conversion_proof import Proof, ReportLine, ignore_line, prove
from core.extras.convert.source_options import ConversionOptions, SourceControl, TargetControl
from core.extras.convert.source_reader import read_source
from core.extras.convert.targets.gcode_writers import FanucWriter, LinuxCncWriter
from core.extras.convert.targets.omniturn_steps import InterpretedProgram, interpret_source
from core.extras.convert.targets.program_writer import ProgramForm, ProgramWriter
from core.extras.convert.targets.read_back_proof import prove_by_reading
from core.extras.convert.targets.simplified_steps import (
    drop_short_blocks,
    drop_short_steps,
    simplify_steps,
)
from core.extras.convert.targets.sinumerik_writer import SinumerikWriter
from core.interpreter.shared.job_setup import ControlLimits
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.source import Dialect
from core.message import Message

_WRITERS: Mapping[TargetControl, tuple[type[ProgramWriter], SourceControl]] = {
    TargetControl.LINUXCNC: (LinuxCncWriter, SourceControl.LINUXCNC),
    TargetControl.FANUC: (FanucWriter, SourceControl.FANUC_A),
}
"""Writer of each control, and the control of the reader that proves its programs."""


def convert_from_omniturn(
    texts: Sequence[str],
    target: TargetControl,
    options: ConversionOptions,
    limits: ControlLimits,
    title: str,
    report_line: ReportLine = ignore_line,
) -> Conversion:
    """Convert the lines of an OmniTurn program to LinuxCNC or Fanuc, and prove the result.

    ``limits`` are the limits of the lathe for which the program was written. ``title`` is the comment in the
    first line. X remains a radius or a diameter, except that a Fanuc program always has diameters.
    ``report_line`` is called with the number of each line that is interpreted.
    """
    program = interpret_source(texts, options, limits, report_line)
    if any(each.severity is Severity.ERROR for each in program.findings):
        return Conversion((), tuple(program.findings), Proof())
    make_writer, reader = _WRITERS[target]
    form = ProgramForm(
        title,
        program.is_metric,
        program.is_diameter or target is TargetControl.FANUC,
        options.writes_comments,
    )
    writer = make_writer(form)
    program = _drop_short_moves(program, writer)
    try:
        writer.write_program(program.steps)
    except ProgramError as error:
        return Conversion((), (*program.findings, *writer.findings, error.diagnostic), Proof())
    proof = prove_by_reading(
        writer.lines,
        reader,
        program,
        resolution_mm=writer.unit_mm / 10**writer.places,
        feed_resolution_mm=writer.unit_mm / 10**writer.places_of_feed,
        speed_resolution=10**-writer.speed_places,
    )
    findings = sorted((*program.findings, *writer.findings), key=lambda each: each.line)
    return Conversion(tuple(writer.lines), (*findings, *proof.errors), proof)


def convert_to_sinumerik(
    texts: Sequence[str],
    options: ConversionOptions,
    limits: ControlLimits,
    title: str,
    *,
    is_omniturn: bool = False,
    report_line: ReportLine = ignore_line,
) -> Conversion:
    """Convert the lines of a turning program to SINUMERIK, and prove the result with its interpreter.

    The source is a program of ``options.control`` or, if ``is_omniturn`` is True, an OmniTurn program.
    ``report_line`` is called with the number of each line that is proved.
    """
    program = _read_source(texts, options, limits, is_omniturn=is_omniturn)
    if any(each.severity is Severity.ERROR for each in program.findings):
        return Conversion((), tuple(program.findings), Proof())
    form = ProgramForm(title, program.is_metric, program.is_diameter, options.writes_comments)
    writer = SinumerikWriter(form)
    program = _drop_short_moves(program, writer)
    try:
        writer.write_program(program.steps)
    except ProgramError as error:
        return Conversion((), (*program.findings, *writer.findings, error.diagnostic), Proof())
    lines = tuple(writer.lines)
    proof = prove(
        "".join(f"{each.text}\n" for each in lines),
        [each.source_line_number for each in lines],
        program.steps,
        limits,
        is_metric=program.is_metric,
        dialect=Dialect.SINUMERIK,
        resolution_mm=writer.unit_mm / 10**writer.places,
        report_line=report_line,
    )
    findings = sorted((*program.findings, *writer.findings), key=lambda each: each.line)
    return Conversion(lines, (*findings, *proof.errors), proof)


def _drop_short_moves(program: InterpretedProgram, writer: ProgramWriter) -> InterpretedProgram:
    """Return a program without the moves that are too short for the resolution of the writer."""
    steps = drop_short_steps(program.steps, writer.round_point)
    return replace(program, steps=steps, blocks=drop_short_blocks(program.blocks, writer.round_point))


def _adapt_to_sinumerik(finding: Diagnostic) -> Diagnostic:
    """Return a finding of the reader in the form that applies to a SINUMERIK control.

    A second offset of a tool is an error, because T would index another tool. In OmniTurn, T only selects an
    offset.
    """
    if not isinstance(finding.message, Message):
        return finding
    values, place = finding.message.values, (finding.line, finding.column)
    match finding.code:
        case "tool-of-offset":
            return make_error(*place, "tool-and-offset", word=values["word"]).diagnostic
        case "nose-offset":
            return make_warning(*place, "nose-table", number=values["number"])
        case "work-offset-used":
            return make_note(*place, "work-offset-g54", word=values["word"])
    return finding


def _read_source(
    texts: Sequence[str], options: ConversionOptions, limits: ControlLimits, *, is_omniturn: bool
) -> InterpretedProgram:
    """Read a program, with steps in the form that a SINUMERIK control needs.

    A program of another control has no blocks, and X becomes a diameter.
    """
    if is_omniturn:
        program = interpret_source(texts, options, limits)
    else:
        state, findings = read_source(texts, options)
        findings = [_adapt_to_sinumerik(each) for each in findings]
        program = InterpretedProgram((), state.steps, findings, bool(state.is_metric))
    if any(each.severity is Severity.ERROR for each in program.findings):
        return program
    try:
        steps, notes = simplify_steps(program.steps, limits.max_rpm)
    except ProgramError as error:
        return replace(program, findings=[*program.findings, error.diagnostic])
    if not any(each.kind in MOVE_KINDS for each in steps):
        notes.append(make_error(0, 0, "file-empty").diagnostic)
    return replace(program, steps=steps, findings=[*program.findings, *notes])
