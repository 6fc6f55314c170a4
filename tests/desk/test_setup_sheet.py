"""The setup sheet without a screen: what it says of the proof is what holds at the machine."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine, load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.special.setup_sheet import SetupSheet, make_setup_sheet
from core.geometry.rotary_axes import DatumPreset
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import MillTool, ToolOffset
from core.language.source import ProgramSource
from core.part.stock import Stock, make_bar_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.program_tools import PartSettings
from tests.texts import begins
from tests.texts import text as wording

TURNED = "G90G94F300\nM03S1500\nT1\nX.6Z.05\nX.4\nG95F.004Z-.5\nX.55\nG94F300Z1\nM30\n"
SLIP = TURNED.replace("G95F.004Z-.5", "G00Z-.5")
TOOL = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304")
ROD = make_bar_stock(25.4, 0.0, -60.0)


def sheet_of(text: str, stock: Stock | None = None, shapes: dict[int, ToolShape] | None = None) -> SetupSheet:
    machine = load_machine(None)
    setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    return make_setup_sheet(
        SharedProgram(ProgramSource("P", text)), setup, machine, PartSettings(stock, shapes or {})
    )


@pytest.mark.parametrize(("stock", "shapes"), [(None, {}), (None, {1: TOOL})])
def test_setup_sheet_lists_assumption_based_findings_as_warnings(
    stock: Stock | None, shapes: dict[int, ToolShape]
) -> None:
    sheet = sheet_of(SLIP, stock, shapes)
    assert sheet.error_count == 0
    one = wording("desk.one-warning")
    some = wording("desk.many-warnings", count=sheet.warning_count)
    assert sheet.findings_summary == (one if sheet.warning_count == 1 else some)


def test_single_warning_is_summarized_in_the_singular() -> None:
    assert sheet_of(SLIP).findings_summary == wording("desk.one-warning")


def test_finding_on_specified_stock_and_tool_is_an_error_on_setup_sheet() -> None:
    sheet = sheet_of(SLIP, ROD, {1: TOOL})
    assert begins(sheet.findings_summary, "desk.many-errors")
    assert sheet_of(TURNED, ROD, {1: TOOL}).findings_summary == ""


def test_groove_tool_without_width_is_marked_as_assumed() -> None:
    grooved = "G90G94F300\nM03S900\nT1\nX.6Z-.5\nG95F.002X.4\nG94F300X.6\nZ1\nM30\n"
    groover = ToolShape(ToolKind.GROOVING, tip=3, stick_out=30.0)
    (tool,) = sheet_of(grooved, ROD, {1: groover}).setup_tools
    assert tool.is_shape_incomplete
    assert tool.tool_shape is not None
    assert tool.tool_shape.width == 2.0
    (said,) = sheet_of(grooved, ROD, {1: ToolShape(ToolKind.GROOVING, tip=3, width=3.0)}).setup_tools
    assert not said.is_shape_incomplete


MILLED = """BEGIN PGM P MM
BLK FORM 0.1 Z X-2 Y-2 Z-20
BLK FORM 0.2 X+102 Y+72 Z+0
TOOL CALL 8 Z S2000 F100
L X+5 Y+5 Z+5 R0 FMAX M3
L Z-1
L Z+5 FMAX M1
M30
END PGM P MM
"""


def milled(preset: int = 0) -> SetupSheet:
    machine = load_shipped_machine("ac-table-mill")
    setup = replace(
        create_power_up_setup(
            machine, tool_offsets={8: ToolOffset(z=101.6, nose_radius=4.25)}, secondary_offsets={}
        ),
        tool_names={"DRILL 8.5": 8},
        mill_tools={8: MillTool(tooth_count=2, point_angle_deg=118.0)},
        preset=preset,
        presets={3: DatumPreset((10.0, -20.0, -81.5), 2.5, (("C", 30.0),))},
    )
    return make_setup_sheet(
        SharedProgram(ProgramSource("P.h", MILLED)), setup, machine, PartSettings(None, {})
    )


def test_mill_setup_sheet_has_blank_preset_and_tool_lengths() -> None:
    sheet = milled()
    assert sheet.stock_text == wording("desk.stock", size="104.000 mm × 74.000 mm × 20.000 mm")
    assert sheet.clamping_texts == (("PRESET", f"0   {wording('desk.of-machine-file')}"),)
    (tool,) = sheet.setup_tools
    assert sheet.describe_tool_shape(tool) == "DRILL 8.5, POINT ANGLE 118°, 2 teeth"
    assert sheet.format_offset(tool) == "L 101.600 mm   R 4.250 mm"
    assert [sheet.format_stop_code(stop) for stop in sheet.program_stops if stop.is_optional] == ["M1"]


def test_active_preset_is_listed_with_its_position() -> None:
    wanted = "3   X 10.000 mm   Y -20.000 mm   Z -81.500 mm   C 30.000°   ROT 2.500°"
    assert milled(preset=3).clamping_texts == (("PRESET", wanted),)
