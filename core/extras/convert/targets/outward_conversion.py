"""Conversion of an OmniTurn program to another lathe control, with its proof."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.extras.convert.conversion import Conversion
from core.extras.convert.conversion_proof import Proof
from core.extras.convert.source_options import ConversionOptions, SourceControl, TargetControl
from core.extras.convert.targets.gcode_writers import FanucWriter, LinuxCncWriter
from core.extras.convert.targets.omniturn_steps import interpret_source
from core.extras.convert.targets.program_writer import ProgramForm, ProgramWriter
from core.extras.convert.targets.read_back_proof import prove_by_reading
from core.interpreter.shared.job_setup import ControlLimits
from core.language.diagnostics import ProgramError, Severity

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
) -> Conversion:
    """Convert the lines of an OmniTurn program to LinuxCNC or Fanuc, and prove the result.

    ``limits`` are the limits of the lathe for which the program was written. ``title`` is the comment in the
    first line. X remains a radius or a diameter, except that a Fanuc program always has diameters.
    """
    program = interpret_source(texts, options, limits)
    if any(each.severity is Severity.ERROR for each in program.findings):
        return Conversion((), tuple(program.findings), Proof())
    make_writer, reader = _WRITERS[target]
    form = ProgramForm(
        title,
        program.is_metric,
        program.is_diameter or target is TargetControl.FANUC,
        options.front,
        options.writes_comments,
    )
    writer = make_writer(form)
    try:
        writer.write_program(program.steps)
    except ProgramError as error:
        return Conversion((), (*program.findings, *writer.findings, error.diagnostic), Proof())
    proof = prove_by_reading(
        writer.lines,
        reader,
        program,
        has_front_tool_post=options.front,
        resolution_mm=writer.unit_mm / 10**writer.places,
    )
    findings = sorted((*program.findings, *writer.findings), key=lambda each: each.line)
    return Conversion(tuple(writer.lines), (*findings, *proof.errors), proof)
