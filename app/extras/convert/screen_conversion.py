"""Conversion of a program for the special function CONVERT PROGRAM, which a worker executes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.extras.convert.conversion_settings import ConversionSettings, make_options
from core.extras.convert.source_options import SourceControl, TargetControl
from core.language.source import Dialect, ProgramSource

if TYPE_CHECKING:
    from core.extras.convert.conversion import Conversion
    from core.interpreter.shared.job_setup import ControlLimits
    from core.language.diagnostics import Diagnostic
    from core.machine.machine_model import Machine

ProgramControl = SourceControl | Dialect
"""Control of a program that is converted. ``Dialect.OMNITURN`` means an OmniTurn program."""

FILE_ENDINGS: Mapping[TargetControl, str] = {
    TargetControl.OMNITURN: "-omniturn.nc",
    TargetControl.SINUMERIK: "-sinumerik.mpf",
    TargetControl.LINUXCNC: "-linuxcnc.ngc",
    TargetControl.FANUC: "-fanuc.nc",
}
"""End of the file name of a converted program, which follows the name of the old program."""


@dataclass(frozen=True, slots=True)
class ConversionRequest:
    """Program and settings of a conversion.

    ``control`` None means that the control is recognized from the text. ``target`` None, or a target that
    is not possible for the control, means the first possible target.
    """

    source: ProgramSource
    control: ProgramControl | None
    target: TargetControl | None
    settings: ConversionSettings


@dataclass(frozen=True, slots=True)
class ConversionResult:
    """Result of a conversion, with the control of the program and the target.

    ``grouped_findings`` contains the first finding of each text, with the numbers of its further lines.
    """

    control: ProgramControl
    target: TargetControl
    conversion: Conversion
    grouped_findings: tuple[tuple[Diagnostic, str], ...]


def list_targets(control: ProgramControl, language: str) -> tuple[TargetControl, ...]:
    """Return the controls to which a program can be converted, with the default first.

    ``language`` is the language of the machine. An OmniTurn program can be converted to all other controls.
    """
    is_sinumerik = language == TargetControl.SINUMERIK
    if control is Dialect.OMNITURN:
        others = (TargetControl.LINUXCNC, TargetControl.FANUC)
        sinumerik = TargetControl.SINUMERIK
        return (sinumerik, *others) if is_sinumerik else (*others, sinumerik)
    targets = (TargetControl.OMNITURN, TargetControl.SINUMERIK)
    return targets[::-1] if is_sinumerik else targets


def convert_request(request: ConversionRequest, machine: Machine, limits: ControlLimits) -> ConversionResult:
    """Convert and prove a program."""
    from core.extras.convert.conversion import group_findings
    from core.extras.convert.recognition import recognize_other_control

    control = request.control or recognize_other_control(request.source.lines) or Dialect.OMNITURN
    targets = list_targets(control, machine.mdi_language)
    target = request.target if request.target in targets else targets[0]
    done = _convert(request, control, target, machine, limits)
    return ConversionResult(control, target, done, tuple(group_findings(done.findings)))


def _convert(
    request: ConversionRequest,
    control: ProgramControl,
    target: TargetControl,
    machine: Machine,
    limits: ControlLimits,
) -> Conversion:
    from core.extras.convert.conversion import convert_program
    from core.extras.convert.targets.target_conversion import convert_from_omniturn, convert_to_sinumerik

    lines, title = request.source.lines, request.source.name
    is_omniturn = not isinstance(control, SourceControl)
    options = make_options(
        control if isinstance(control, SourceControl) else SourceControl.LINUXCNC, request.settings, machine
    )
    if target is TargetControl.SINUMERIK:
        return convert_to_sinumerik(lines, options, limits, title, is_omniturn=is_omniturn)
    if is_omniturn:
        return convert_from_omniturn(lines, target, options, limits, title)
    return convert_program(lines, options, limits)
