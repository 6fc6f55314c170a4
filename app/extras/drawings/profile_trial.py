"""Trial run of a program from a drawing: its proof, and the comparison of part and drawing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from core.extras.drawings.drawing_placement import ContourProfile, ContourSide
from core.extras.drawings.part_comparison import DrawingComparison, compare_part_with_drawing
from core.extras.drawings.profile_program import NoseOffset
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.message import Message
from core.part.stock_spec import StockSpec
from core.part.tool_shape import ToolShape
from core.proving.part_proof import prove_program_and_part
from core.tool_edges import make_edge_row_number

_SPARE = 10.0  # mm of stock beyond the part
_HOME = ToolOffset(12.7, -76.2)


@dataclass(frozen=True, slots=True)
class TrialStock:
    """Stock of a trial run: bar diameter, face allowance and predrilled hole diameter, all in mm."""

    bar_diameter_mm: float
    face_stock_mm: float = 0.0
    hole_diameter_mm: float = 0.0


@dataclass(frozen=True, slots=True)
class TrialResult:
    """Result of a trial run.

    ``comparison`` is None if the program does not cut a part. ``errors`` are the errors of the proof.
    """

    comparison: DrawingComparison | None
    errors: tuple[str, ...] = ()


def run_profile_trial(
    program_text: str,
    profile: ContourProfile,
    stock: TrialStock,
    nose_offset: NoseOffset | None,
    machine: Machine,
    tool_shapes: Mapping[int, ToolShape],
    report_progress: Callable[[float], None] | None = None,
    dialect: Dialect = Dialect.OMNITURN,
) -> TrialResult:
    """Prove the program and compare the simulated part with the contour profile.

    The trial uses the same offsets for all tools, and ``nose_offset`` as the tool nose offset that the
    program requires.
    """
    of_edge = nose_offset is not None and nose_offset.quadrant
    secondary = (
        {nose_offset.offset_number: SecondaryOffset(nose_offset.x, nose_offset.z, nose_offset.nose_radius)}
        if nose_offset and not of_edge
        else {}
    )
    tools = dict.fromkeys(range(1, 33), _HOME)
    if nose_offset is not None and of_edge:
        edge = replace(_HOME, nose_radius=nose_offset.nose_radius, quadrant=nose_offset.quadrant)
        tools |= {make_edge_row_number(n, nose_offset.offset_number): edge for n in tools}
    setup = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets=secondary)
    setting = make_part_settings(machine, {}, tool_shapes)
    front = profile.front_z_mm + stock.face_stock_mm
    length = front - profile.back_z_mm + _SPARE
    bar = StockSpec("bar", stock.bar_diameter_mm, stock.hole_diameter_mm, length, front)
    setting = replace(setting, stock=bar, clamping=None, gang={}, travel=None)
    report, part = prove_program_and_part(
        ProgramSource("drawing", program_text, dialect),
        setup,
        machine,
        setting,
        check_canceled=report_progress,
    )
    errors = tuple(_said(each) for each in report.diagnostics if each.severity is Severity.ERROR)
    made = None if part is None or part.last_piece is None else part.last_piece
    side = (
        None
        if made is None
        else made.bore_profile
        if profile.side is ContourSide.INSIDE
        else made.outside_profile
    )
    return TrialResult(compare_part_with_drawing(profile, side) if side else None, errors)


def _said(found: Diagnostic) -> str:
    return Message("LINE {line}: {value} {hint}", line=found.line, value=found.text, hint=found.hint).strip()
