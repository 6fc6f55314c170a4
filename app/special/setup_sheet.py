"""Setup sheet of a program for lathe or mill: tools, offsets, stock, chuck, stops and time per part."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from app.desk.status.readouts import rotary_angle
from app.desk.translation import tr
from app.report.run_record import RunRecord, Stop, ToolTime
from core.geometry.rotary_axes import DatumPreset
from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.job_setup import MillTool, SecondaryOffset, Setup, ToolOffset, ZeroOffset
from core.interpreter.shared.working_plane import Corners
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from core.machine.machine_model import Machine
from core.message import Message
from core.part.stock import Clamping, Stock
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Piece
from core.proving.part_proof import prove_with_part
from core.proving.program_tools import PartSetting
from core.proving.prove_program import Progress

Length = Callable[[float], str]


@dataclass(frozen=True, slots=True)
class MillSetup:
    """Setup of a mill: ``blank`` contains the corners of BLK FORM in mm.

    The rest is from the tool table.
    """

    blank: Corners | None
    preset: int
    datum: DatumPreset | None  # row of the preset; None for preset 0, which is in the machine file
    names: Mapping[int, str]
    tools: Mapping[int, MillTool]

    def stock_words(self, length: Length) -> str:
        """Return length, width and height of the blank as text."""
        if self.blank is None:
            return tr("stock not specified because the program has no BLK FORM")
        low, high = self.blank
        return Message("BLK FORM  {b}", b=" × ".join((length(b - a) for a, b in zip(low, high, strict=True))))

    def preset_words(self, length: Length) -> str:
        """Return the active preset and its position relative to home as text."""
        if self.datum is None:
            return f"{self.preset}   {tr('zero point from the machine file')}"
        places = (f"{name} {length(at)}" for name, at in zip("XYZ", self.datum.origin, strict=True))
        turned = (f"{name} {rotary_angle(at)}°" for name, at in self.datum.zeros if at)
        rotation = (
            (Message("ROT {rotation}°", rotation=rotary_angle(self.datum.rotation)),)
            if self.datum.rotation
            else ()
        )
        return f"{self.preset}   " + "   ".join((*places, *turned, *rotation))

    def tool_words(self, number: int) -> str:
        """Return name, point angle and number of teeth of a tool as text."""
        row = self.tools.get(number, MillTool())
        words = (
            self.names.get(number, ""),
            f"{tr('POINT ANGLE')} {row.point:g}°" if row.point else "",
            f"{row.teeth} {tr('teeth')}" if row.teeth else "",
        )
        return ", ".join(filter(None, words)) or tr("no tool name in the tool table")


def mill_setup(setup: Setup, blank: Corners | None) -> MillSetup | None:
    """Return the mill setup of a job, or None on a lathe."""
    if setup.kinematics is None:
        return None
    datum = setup.presets.get(setup.preset) if setup.preset else None
    names = {number: name for name, number in setup.tool_names.items()}
    return MillSetup(blank, setup.preset, datum, names, setup.mill_tools)


def offset_words(offset: ToolOffset, length: Length) -> str:
    """Return tool length L and radius R as text, including DL and DR."""
    return f"L {length(offset.z)}   R {length(offset.nose_radius)}"


_MM_PER_INCH = 25.4


@dataclass(frozen=True, slots=True)
class SheetTool:
    """Tool of the setup sheet.

    ``assumed`` means an incomplete shape, and ``offset`` is None if not measured.
    """

    number: int
    shape: ToolShape | None
    assumed: bool
    offset: ToolOffset | None
    time: ToolTime


@dataclass(frozen=True, slots=True)
class SetupSheet:
    """Setup data for starting a program, in mm and seconds."""

    metric: bool
    cycle: float
    found: tuple[Diagnostic, ...]  # findings of the proof, with their severity at the machine
    stock: Stock | None
    part: Piece | None
    milled: bool
    clamping: Clamping | None
    tools: tuple[SheetTool, ...]
    secondary: tuple[tuple[int, SecondaryOffset], ...]
    zero: tuple[tuple[int, ZeroOffset], ...]
    stops: tuple[Stop, ...]
    mill: MillSetup | None = None
    omniturn: bool = True  # an OmniTurn program, which uses M00 instead of M0

    @property
    def errors(self) -> int:
        """Number of errors, which prevent a run."""
        return sum(each.severity is Severity.ERROR for each in self.found)

    @property
    def warnings(self) -> int:
        """Number of warnings."""
        return sum(each.severity is Severity.WARNING for each in self.found)

    @property
    def verdict(self) -> str:
        """Summary of errors and warnings as text, or an empty string without them."""
        if self.errors == 1:
            return tr("1 ERROR: this program will not run as it is")
        if self.errors:
            return tr(Message("{count} ERRORS: this program will not run as it is", count=self.errors))
        if self.warnings == 1:
            return tr("1 WARNING: check it before the first part")
        if self.warnings:
            return tr(Message("{count} WARNINGS: check them before the first part", count=self.warnings))
        return ""

    def length(self, mm: float) -> str:
        """Return a length with its unit, in the unit of the program."""
        return (
            Message("{unit} mm", unit=f"{mm:.3f}") if self.metric else f"{mm / _MM_PER_INCH:.4f} {tr('in')}"
        )

    @property
    def stock_words(self) -> str:
        """Stock as text."""
        if self.mill is not None:
            return self.mill.stock_words(self.length)
        stock = self.stock
        if stock is None:
            return tr("unknown")
        round_ = f"Ø {self.length(2.0 * stock.radius)}"
        if stock.bore:
            round_ += ", " + tr(Message("bore {size}", size=self.length(2.0 * stock.bore[0][1])))
        if stock.given:
            return f"{round_} ({stock.given})"
        return tr(Message("at least {size} (assumed, not specified)", size=round_))

    @property
    def held_words(self) -> tuple[tuple[str, str], ...]:
        """Stick-out and clamping as pairs of name and text; on a mill, the preset."""
        if self.mill is not None:
            return ((tr("PRESET"), self.mill.preset_words(self.length)),)
        held = self.clamping
        if held is None or not held.diameter:
            return ((tr("STICK-OUT"), tr("unknown because the machine file has no values under [clamping]")),)
        chuck = f"Ø {self.length(held.diameter)}"
        if held.jaws:
            size = f"Ø {self.length(held.jaw_diameter)} × {self.length(held.jaws)}"
            chuck += ", " + tr(Message("jaws {size}", size=size))
        if held.max_rpm:
            chuck += ", " + tr(Message("max. {rpm} rpm", rpm=f"{held.max_rpm:.0f}"))
        rows = [(tr("STICK-OUT"), self.length(held.stick_out)), (tr("CHUCK"), chuck)]
        if held.quill:
            quill = f"Ø {self.length(held.quill)}, {held.point:g}°, Z {self.length(held.centre)}"
            rows.append((tr("TAILSTOCK"), quill))
        return tuple(rows)

    def shape_words(self, tool: SheetTool) -> str:
        """Return the shape of a tool as text."""
        if self.mill is not None:
            return self.mill.tool_words(tool.number)
        shape = tool.shape
        if shape is None:
            return tr("unknown")
        words = ", ".join(filter(None, self._of_shape(shape)))
        return tr(Message("{tool} (assumed)", tool=words)) if tool.assumed else words

    def _of_shape(self, shape: ToolShape) -> Iterator[str]:
        yield kind_word(shape.kind)
        yield shape.insert
        yield shape.holder
        for name, mm in (
            (tr("WIDTH"), shape.width), ("Ø", shape.diameter),
            (tr("PITCH"), shape.pitch), (tr("CUTTING LENGTH"), shape.length),
            (tr("STICK-OUT"), shape.stick_out),
        ):  # fmt: skip
            yield f"{name} {self.length(mm)}" if mm else ""
        yield f"{tr('POINT ANGLE')} {shape.point:g}°" if shape.point else ""
        yield f"{tr('TIP')} {shape.tip}" if shape.tip else ""

    def offset_words(self, tool: SheetTool) -> str:
        """Return the offset of a tool as text: X as a radius and Z, or on a mill length and radius."""
        if tool.offset is None:
            return tr("NOT SET")
        if self.mill is not None:
            return offset_words(tool.offset, self.length)
        x, z, r = (self.length(mm) for mm in (tool.offset.x, tool.offset.z, tool.offset.nose_radius))
        return tr(Message("X (radius) {x}   Z {z}   R {radius}", x=x, z=z, radius=r))

    def stop_word(self, stop: Stop) -> str:
        """Return the stop code in the notation of the program's language."""
        return f"M{'0' if self.omniturn else ''}{int(stop.optional)}"


def setup_sheet(
    program: ReadProgram, setup: Setup, machine: Machine, setting: PartSetting, watch: Progress | None = None
) -> SetupSheet:
    """Prove the program and return its setup sheet.

    ``watch`` is called during the proof and may raise an exception to cancel.
    """
    record = RunRecord(setting)
    report, part = prove_with_part(program, setup, machine, setting, watch, seen=record.see)
    shapes = part.shapes if part is not None else {}
    numbers = sorted({*report.tools, *(n for n, time in record.times.items() if n and time.total)})
    return SetupSheet(
        metric=report.metric or report.dialect is not Dialect.OMNITURN,
        cycle=report.times.cycle,
        found=report.diagnostics,
        stock=part.stock if part is not None else None,
        part=part.last if part is not None else None,
        milled=part is not None and part.milled,
        clamping=setting.clamping,
        tools=tuple(
            SheetTool(
                n,
                shapes.get(n),
                setting.shapes.get(n) != shapes.get(n),
                setup.tools.get(n),
                record.times.get(n, ToolTime()),
            )
            for n in numbers
        ),
        secondary=tuple((n, setup.secondary.get(n, SecondaryOffset())) for n in sorted(record.secondary)),
        zero=tuple((n, setup.zero.get(n, ZeroOffset())) for n in sorted(record.settable)),
        stops=tuple(record.stops),
        mill=mill_setup(setup, record.blank),
        omniturn=report.dialect is Dialect.OMNITURN,
    )


def kind_word(kind: ToolKind) -> str:
    """Return the display text of a tool kind."""
    words = kind.upper().replace("-", " ")
    return tr("FORM TOOL") if kind is ToolKind.FORM else tr(words)


def outside_words(sheet: SetupSheet) -> str:
    """Return the size of the finished part as text, or an empty string if nothing is turned."""
    if sheet.part is None or not sheet.part.outside:
        return ""
    outside = sheet.part.outside
    size = sheet.length(2.0 * max(r for _, r in outside))
    return f"Ø {size} × {sheet.length(outside[0][0] - outside[-1][0])}"
