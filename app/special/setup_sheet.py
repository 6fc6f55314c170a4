"""Setup sheet of a program, for a lathe or a mill.

The sheet lists tools, offsets, stock, clamping, program stops and time per part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from app.desk.status.readouts import format_rotary_angle
from app.desk.translation import tr
from app.report.run_record import PlannedStop, ReportRecorder, ToolTimes
from core.geometry.rotary_axes import DatumPreset
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import (
    InterpreterSetup,
    MillTool,
    SecondaryOffset,
    ToolOffset,
    ZeroOffset,
)
from core.interpreter.shared.working_plane import BlankCorners
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from core.machine.machine_model import Machine
from core.message import Message
from core.part.stock import Clamping, Stock
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import PartedPiece
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.prove_program import ReportProgress

FormatLength = Callable[[float], str]


@dataclass(frozen=True, slots=True)
class MillSetup:
    """Setup data of a mill: blank, preset and tools.

    ``blank_corners`` contains the corners of BLK FORM in mm. The other values are from the preset and tool
    tables.
    """

    blank_corners: BlankCorners | None
    preset_number: int
    datum_preset: DatumPreset | None  # row of the preset; None for preset 0, which is in the machine file
    tool_names: Mapping[int, str]
    mill_tools: Mapping[int, MillTool]

    def format_stock(self, format_length: FormatLength) -> str:
        """Return the length, width and height of the blank as text."""
        if self.blank_corners is None:
            return tr("stock not specified because the program has no BLK FORM")
        low, high = self.blank_corners
        return Message(
            "BLK FORM  {b}", b=" × ".join((format_length(b - a) for a, b in zip(low, high, strict=True)))
        )

    def format_preset(self, format_length: FormatLength) -> str:
        """Return the active preset and its position relative to home as text."""
        if self.datum_preset is None:
            return f"{self.preset_number}   {tr('zero point from the machine file')}"
        places = (
            f"{name} {format_length(at)}" for name, at in zip("XYZ", self.datum_preset.origin, strict=True)
        )
        turned = (f"{name} {format_rotary_angle(at)}°" for name, at in self.datum_preset.axis_zeros if at)
        rotation = (
            (Message("ROT {rotation}°", rotation=format_rotary_angle(self.datum_preset.rotation_deg)),)
            if self.datum_preset.rotation_deg
            else ()
        )
        return f"{self.preset_number}   " + "   ".join((*places, *turned, *rotation))

    def describe_tool(self, number: int) -> str:
        """Return the name, point angle and number of teeth of a tool as text."""
        row = self.mill_tools.get(number, MillTool())
        words = (
            self.tool_names.get(number, ""),
            f"{tr('POINT ANGLE')} {row.point_angle_deg:g}°" if row.point_angle_deg else "",
            f"{row.tooth_count} {tr('teeth')}" if row.tooth_count else "",
        )
        return ", ".join(filter(None, words)) or tr("no tool name in the tool table")


def make_mill_setup(setup: InterpreterSetup, blank_corners: BlankCorners | None) -> MillSetup | None:
    """Return the mill setup of a job, or None on a lathe."""
    if setup.kinematics is None:
        return None
    datum = setup.presets.get(setup.preset) if setup.preset else None
    names = {number: name for name, number in setup.tool_names.items()}
    return MillSetup(blank_corners, setup.preset, datum, names, setup.mill_tools)


def format_tool_offset(offset: ToolOffset, format_length: FormatLength) -> str:
    """Return the tool length L and the radius R as text, including the oversizes DL and DR."""
    return f"L {format_length(offset.z)}   R {format_length(offset.nose_radius)}"


_MM_PER_INCH = 25.4


@dataclass(frozen=True, slots=True)
class SetupSheetTool:
    """Tool of the setup sheet.

    ``is_shape_incomplete`` is True if the tool shape is incomplete and TurnDesk assumes the missing values.
    ``tool_offset`` is None if the tool is not measured.
    """

    tool_number: int
    tool_shape: ToolShape | None
    is_shape_incomplete: bool
    tool_offset: ToolOffset | None
    tool_times: ToolTimes


@dataclass(frozen=True, slots=True)
class SetupSheet:
    """Data needed to set up the machine for a program, in mm and seconds."""

    is_metric: bool
    cycle_time_s: float
    diagnostics: tuple[Diagnostic, ...]  # findings of the proof, with their severity at the machine
    stock: Stock | None
    finished_part: PartedPiece | None
    is_milled: bool
    clamping: Clamping | None
    setup_tools: tuple[SetupSheetTool, ...]
    secondary_offsets: tuple[tuple[int, SecondaryOffset], ...]
    zero_offsets: tuple[tuple[int, ZeroOffset], ...]
    program_stops: tuple[PlannedStop, ...]
    mill_setup: MillSetup | None = None
    is_omniturn: bool = True  # an OmniTurn program, which uses M00 instead of M0

    @property
    def error_count(self) -> int:
        """Return the number of program errors. A program with errors cannot run."""
        return sum(each.severity is Severity.ERROR for each in self.diagnostics)

    @property
    def warning_count(self) -> int:
        """Return the number of warnings about the program."""
        return sum(each.severity is Severity.WARNING for each in self.diagnostics)

    @property
    def findings_summary(self) -> str:
        """Return a summary of the errors and warnings as text, or an empty string if there are none."""
        if self.error_count == 1:
            return tr("1 ERROR: this program will not run as it is")
        if self.error_count:
            return tr(Message("{count} ERRORS: this program will not run as it is", count=self.error_count))
        if self.warning_count == 1:
            return tr("1 WARNING: check it before the first part")
        if self.warning_count:
            return tr(Message("{count} WARNINGS: check them before the first part", count=self.warning_count))
        return ""

    def format_length(self, mm: float) -> str:
        """Return a length in mm as text with its unit, in the unit of the program."""
        return (
            Message("{unit} mm", unit=f"{mm:.3f}")
            if self.is_metric
            else f"{mm / _MM_PER_INCH:.4f} {tr('in')}"
        )

    @property
    def stock_text(self) -> str:
        """Return the description of the stock."""
        if self.mill_setup is not None:
            return self.mill_setup.format_stock(self.format_length)
        stock = self.stock
        if stock is None:
            return tr("unknown")
        round_ = f"Ø {self.format_length(2.0 * stock.max_radius_mm)}"
        if stock.bore_profile:
            round_ += ", " + tr(
                Message("bore {size}", size=self.format_length(2.0 * stock.bore_profile[0][1]))
            )
        if stock.specification_text:
            return f"{round_} ({stock.specification_text})"
        return tr(Message("at least {size} (assumed, not specified)", size=round_))

    @property
    def clamping_texts(self) -> tuple[tuple[str, str], ...]:
        """Return the stick-out and the clamping as pairs of a name and a text.

        On a mill, return the preset instead of these.
        """
        if self.mill_setup is not None:
            return ((tr("PRESET"), self.mill_setup.format_preset(self.format_length)),)
        held = self.clamping
        if held is None or not held.chuck_diameter:
            return ((tr("STICK-OUT"), tr("unknown because the machine file has no values under [clamping]")),)
        chuck = f"Ø {self.format_length(held.chuck_diameter)}"
        if held.jaw_length:
            size = f"Ø {self.format_length(held.jaw_diameter)} × {self.format_length(held.jaw_length)}"
            chuck += ", " + tr(Message("jaws {size}", size=size))
        if held.max_rpm:
            chuck += ", " + tr(Message("max. {rpm} rpm", rpm=f"{held.max_rpm:.0f}"))
        rows = [(tr("STICK-OUT"), self.format_length(held.stick_out)), (tr("CHUCK"), chuck)]
        if held.quill_diameter:
            quill = (
                f"Ø {self.format_length(held.quill_diameter)}, {held.center_angle_deg:g}°, Z "
                f"{self.format_length(held.center_z_mm)}"
            )
            rows.append((tr("TAILSTOCK"), quill))
        return tuple(rows)

    def describe_tool_shape(self, tool: SetupSheetTool) -> str:
        """Return the shape of a tool as text."""
        if self.mill_setup is not None:
            return self.mill_setup.describe_tool(tool.tool_number)
        shape = tool.tool_shape
        if shape is None:
            return tr("unknown")
        words = ", ".join(filter(None, self._of_shape(shape)))
        return tr(Message("{tool} (assumed)", tool=words)) if tool.is_shape_incomplete else words

    def _of_shape(self, shape: ToolShape) -> Iterator[str]:
        yield translate_tool_kind(shape.kind)
        yield shape.insert
        yield shape.holder
        for name, mm in (
            (tr("WIDTH"), shape.width), ("Ø", shape.diameter),
            (tr("PITCH"), shape.pitch), (tr("CUTTING LENGTH"), shape.length),
            (tr("STICK-OUT"), shape.stick_out),
        ):  # fmt: skip
            yield f"{name} {self.format_length(mm)}" if mm else ""
        yield f"{tr('POINT ANGLE')} {shape.point:g}°" if shape.point else ""
        yield f"{tr('TIP')} {shape.tip}" if shape.tip else ""

    def format_offset(self, tool: SetupSheetTool) -> str:
        """Return the offset of a tool as text.

        On a lathe, the text contains Z, and X as a radius. On a mill, it contains length and radius.
        """
        if tool.tool_offset is None:
            return tr("NOT SET")
        if self.mill_setup is not None:
            return format_tool_offset(tool.tool_offset, self.format_length)
        x, z, r = (
            self.format_length(mm)
            for mm in (tool.tool_offset.x, tool.tool_offset.z, tool.tool_offset.nose_radius)
        )
        return tr(Message("X (radius) {x}   Z {z}   R {radius}", x=x, z=z, radius=r))

    def format_stop_code(self, stop: PlannedStop) -> str:
        """Return the code of a program stop (such as M0 or M01) in the program's language."""
        return f"M{'0' if self.is_omniturn else ''}{int(stop.is_optional)}"


def make_setup_sheet(
    program: SharedProgram,
    setup: InterpreterSetup,
    machine: Machine,
    part_settings: PartSettings,
    report_progress: ReportProgress | None = None,
) -> SetupSheet:
    """Prove the program, and return its setup sheet.

    ``report_progress`` is called during the proof. It can raise an exception to cancel the proof.
    """
    record = ReportRecorder(part_settings)
    report, part = prove_program_and_part(
        program, setup, machine, part_settings, report_progress, on_span=record.add_time_span
    )
    shapes = part.tool_shapes if part is not None else {}
    numbers = sorted(
        {*report.tool_numbers, *(n for n, time in record.tool_times.items() if n and time.total_time_s)}
    )
    return SetupSheet(
        is_metric=report.is_metric or report.dialect is not Dialect.OMNITURN,
        cycle_time_s=report.program_times.cycle_time_s,
        diagnostics=report.diagnostics,
        stock=part.stock if part is not None else None,
        finished_part=part.last_piece if part is not None else None,
        is_milled=part is not None and part.is_milled,
        clamping=part_settings.clamping,
        setup_tools=tuple(
            SetupSheetTool(
                n,
                shapes.get(n),
                part_settings.shapes.get(n) != shapes.get(n),
                setup.tools.get(n),
                record.tool_times.get(n, ToolTimes()),
            )
            for n in numbers
        ),
        secondary_offsets=tuple(
            (n, setup.secondary.get(n, SecondaryOffset())) for n in sorted(record.used_secondary_offsets)
        ),
        zero_offsets=tuple((n, setup.zero.get(n, ZeroOffset())) for n in sorted(record.used_zero_offsets)),
        program_stops=tuple(record.program_stops),
        mill_setup=make_mill_setup(setup, record.blank_corners),
        is_omniturn=report.dialect is Dialect.OMNITURN,
    )


def translate_tool_kind(kind: ToolKind) -> str:
    """Return the display text of a tool kind."""
    words = kind.upper().replace("-", " ")
    return tr("FORM TOOL") if kind is ToolKind.FORM else tr(words)


def format_finished_size(sheet: SetupSheet) -> str:
    """Return the size of the finished part as text, or an empty string if the part is not turned."""
    if sheet.finished_part is None or not sheet.finished_part.outside_profile:
        return ""
    outside = sheet.finished_part.outside_profile
    size = sheet.format_length(2.0 * max(r for _, r in outside))
    return f"Ø {size} × {sheet.format_length(outside[0][0] - outside[-1][0])}"
