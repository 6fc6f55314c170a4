"""FN 18 and FN 17 on the tool table and the control's other figures; texts (QS)."""

from __future__ import annotations

from typing import Any

import pytest

from core.interpreter.shared.job_setup import MillTool, ToolOffset
from tests.klartext.running import Ran, run

TABLE = {
    1: MillTool(100.0, 5.0, 1.0, 0.1, -0.02, 0.03, 4, 118.0, 45.0),
    7: MillTool(80.0, 3.0),
}
TOOLS = {1: ToolOffset(z=100.1, nose_radius=4.98), 7: ToolOffset(z=80.0, nose_radius=3.0)}


def with_table(text: str, **setup: Any) -> Ran:
    return run(text, tools=TOOLS, mill_tools=TABLE, **setup)


def read(place: str, before: str = "", **setup: Any) -> float:
    ran = with_table(f"{before}\nFN 18: SYSREAD Q1 = {place}", **setup)
    assert ran.codes == []
    return ran.state.q_values[1]


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("ID50 NR1", 100.0), ("ID50 NR2", 5.0), ("ID50 NR3", 1.0), ("ID50 NR4", 0.1), ("ID50 NR5", -0.02),
        ("ID50 NR6", 0.03), ("ID50 NR10", 45.0), ("ID50 NR15", 4.0), ("ID50 NR32", 118.0),
        ("ID50 NR1 IDX7", 80.0), ("ID50 NR2 IDX+7", 3.0), ("ID50 NR15 IDX7", 0.0),
    ],
)  # fmt: skip
def test_sysread_reads_columns_of_tool_table(place: str, value: float) -> None:
    assert read(place) == pytest.approx(value)


def test_lengths_are_in_the_unit_of_the_program() -> None:
    assert read("ID50 NR1", unit="INCH") == pytest.approx(100.0 / 25.4)
    assert read("ID50 NR15", unit="INCH") == 4.0


CALL = "TOOL CALL 1 Z S1200 F600 DL+1 DR-0.5 DR2:+0.25\nL X+7 Y+0 Z+50 R0 FMAX M3"


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("ID20 NR1", 1.0), ("ID20 NR3", 2.0), ("ID20 NR4", 1200.0), ("ID20 NR9", 600.0), ("ID25 NR1", 1.0),
        ("ID35 NR1", 0.0), ("ID60 NR3", 1200.0), ("ID60 NR4", 1.0), ("ID60 NR5", -0.5),
        ("ID200 NR1 IDX1", 5.0), ("ID200 NR1 IDX2", 4.98), ("ID200 NR1 IDX3", 4.48),
        ("ID200 NR2 IDX3", 101.1), ("ID210 NR6", 0.0), ("ID280 NR1", 0.0), ("ID230 NR5", 0.0),
        ("ID270 NR1 IDX1", 7.0), ("ID270 NR1 IDX6", 0.0), ("ID60 NR7", 0.25),
    ],
)  # fmt: skip
def test_sysread_reads_values_of_tool_call(place: str, value: float) -> None:
    assert read(place, CALL) == pytest.approx(value)


def test_sysread_reads_active_transformations() -> None:
    turned = "TRANS DATUM AXIS X+3 Y-4\nTRANS MIRROR AXIS X Y\nTRANS ROTATION ROT+30\nTRANS SCALE SCL0.5"
    found = [read(f"ID{place}", turned) for place in ("220 NR2 IDX2", "210 NR3", "210 NR2", "210 NR4 IDX1")]
    assert found == pytest.approx([-4.0, 3.0, 30.0, 0.5])
    assert read("ID210 NR6", "PLANE AXIAL A+30 C+0 STAY") == -1.0
    assert read("ID280 NR1", "M128") == -1.0


def test_sysread_uses_tool_def_length_when_program_defines_tool() -> None:
    assert read("ID50 NR1", "TOOL DEF 5 L+30 R+4\nTOOL CALL 5 Z S100 DL+1") == pytest.approx(30.0)
    assert read("ID50 NR2", 'TOOL DEF "MILL" L+30 R+4\nTOOL CALL "MILL" Z S100') == pytest.approx(4.0)


@pytest.mark.parametrize(("number", "empty"), [(36, 0.0), (22, 0.0), (19, 99999.9999)])
def test_sysread_of_missing_column_is_empty_and_reported(number: int, empty: float) -> None:
    """R-OFFS is preset to R, the tool's radius, which reads as 99999.9999."""
    ran = with_table(f"FN 18: SYSREAD Q1 = ID50 NR{number} IDX1")
    assert ran.codes == []
    assert ran.state.q_values[1] == empty
    assert [each.code for each in ran.diagnostics] == ["tool-table-column"]


@pytest.mark.parametrize(
    ("block", "code", "names"),
    [
        ("FN 18: SYSREAD Q1 = ID50 NR1 IDX9", "Tool not defined", "Tool 9"),
        ("FN 18: SYSREAD Q1 = ID50 NR11 IDX1", "Not supported", "NR11"),
        ("FN 18: SYSREAD Q1 = ID50 NR99 IDX1", "Not supported", "NR99"),
        ("FN 18: SYSREAD Q1 = ID230 NR2 IDX6", "Not supported", "ID230"),
        ("FN 18: SYSREAD Q1 = ID270 NR1 IDX5", "Not supported", "IDX5"),
        ("FN 18: SYSREAD Q1 = ID50", "Syntax error", "ID and NR"),
        ("FN 17: SYSWRITE ID50 NR4 IDX1 = +0", "Not supported", "DL of tool 1"),
        ("FN 17: SYSWRITE ID50 NR15 IDX7 = +3", "Not supported", "CUT of tool 7"),
        ("FN 17: SYSWRITE ID50 NR7 IDX7 = +1", "Not supported", "TL of tool 7"),
        ("FN 17: SYSWRITE ID50 NR4 IDX9 = +0", "Tool not defined", "Tool 9"),
        ("FN 17: SYSWRITE ID220 NR2 IDX1 = +5", "Not supported", "FN 17 with ID220"),
        ("FN 17: SYSWRITE ID50 NR4", "Syntax error", "="),
        ("FN 17: SYSWRITE NR4 = +0", "Syntax error", "ID and NR"),
        ("FN 17: ID50 NR4 = +0", "Syntax error", "SYSWRITE"),
    ],
)
def test_invalid_system_data_access_is_rejected(block: str, code: str, names: str) -> None:
    ran = with_table(f"Q1 = 5\n{block}")
    assert ran.codes == [code]
    assert any(names in each.message for each in ran.diagnostics)
    assert ran.state.q_values[1] == 5.0


def test_fn_17_values_are_read_back_and_reported_as_ignored() -> None:
    ran = with_table(
        "FN 17: SYSWRITE ID50 NR22 IDX7 = +0.2\nFN 17: SYSWRITE ID50 NR4 IDX7 = +0\n"
        "FN 18: SYSREAD Q1 = ID50 NR22 IDX7"
    )
    assert ran.codes == []
    assert ran.state.q_values[1] == 0.2
    assert [each.code for each in ran.diagnostics] == ["unheeded", "unheeded"]
    assert "RBREAK" in ran.diagnostics[0].message
