"""Tool tables of LinuxCNC: values by hand, and rejected lines with their places."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.extras.tool_tables.linuxcnc_table import format_table
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolTableError
from core.tool_edges import TIP_DIRECTIONS
from tests.coded import raises_code
from tests.extras.tool_tables.hand import table_of, tool_of


def test_inch_line_is_read(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.tbl", "T3 P3 X1.5 Z-2 D0.0312 I85 J25 Q2 ;roughing\n")
    assert tool.tool_number == 3
    assert tool.offset_values == {
        "x": pytest.approx(38.1),
        "z": pytest.approx(-50.8),
        "nose_radius": pytest.approx(0.39624),  # half of .0312 in
        "quadrant": 3,
        "remark": "roughing",
    }
    assert tool.shape_values == {}


def test_millimeters_and_leading_points_are_read(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.tbl", "T1 P1 X.5 Z+1. D.8\r\n", TableReadingOptions(unit="mm"))
    assert (tool.offset_values["x"], tool.offset_values["z"], tool.offset_values["nose_radius"]) == (
        0.5,
        1.0,
        0.4,
    )


@pytest.mark.parametrize(
    ("orientation", "z", "x"),
    [(1, 1, -1), (2, -1, -1), (3, -1, 1), (4, 1, 1), (5, 1, 0), (6, 0, -1), (7, -1, 0), (8, 0, 1)],
)
def test_tip_orientation_matches_linuxcnc_compensation(
    tmp_path: Path, orientation: int, z: int, x: int
) -> None:
    """LinuxCNC subtracts the radius from X for 1, 2 and 6, and from Z for 2, 3 and 7."""
    tool = tool_of(tmp_path, "a.tbl", f"T1 X1 Z1 D.03 Q{orientation}\n")
    assert TIP_DIRECTIONS[int(tool.offset_values["quadrant"])] == (z, x)


def test_codes_in_the_remark_are_the_shape(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.tbl", "T1 P1 X1 Z1 D.0315 Q2 ;OD CNMG 431 MCLNR-124B\n")
    assert tool.shape_values == {
        "kind": "turning",
        "hand": "right",
        "insert": "CNMG431",
        "holder": "MCLNR-124B",
    }
    assert tool.notes == ()  # 1/64 in is half of .0315 in


def test_a_radius_entered_as_diameter_is_noted(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.tbl", "T1 D.8 ;CNMG120408\n", TableReadingOptions(unit="mm"))
    assert tool.offset_values["nose_radius"] == 0.4
    (note,) = tool.notes
    assert "0.400" in note
    assert "0.800" in note


def test_drill_has_a_diameter_and_no_nose_radius(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.tbl", "T4 Z2 X1 D.25 ;1/4 drill\n")
    assert tool.shape_values == {"kind": "drill", "diameter": pytest.approx(6.35)}
    assert "nose_radius" not in tool.offset_values


def test_tool_at_zero_is_treated_as_not_measured(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.tbl", "T1 P1 X0 Z0 A0 B0 C0 U0 V0 W0 D.03 I0 J0 Q2 ;rem\n")
    assert tool.offset_values.keys() == {"nose_radius", "quadrant", "remark"}
    assert len(tool.notes) == 1


def test_only_selected_tools_are_read(tmp_path: Path) -> None:
    text = "T1 X1 Z1\nT2 X1 Z1\nT10001 X1 Z1\n"
    table = table_of(
        tmp_path, "a.tbl", text, TableReadingOptions(unit="in", selected_tool_numbers=frozenset({2, 3}))
    )
    assert list(table.tools) == [2]


def test_comments_and_empty_lines_are_skipped(tmp_path: Path) -> None:
    assert list(table_of(tmp_path, "a.tbl", ";head\n\n  \nT7 P1\n").tools) == [7]


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("T0 P1 X1 Z1\n", "unknown-number", "line 1"),
        ("T1\nT99 P1\n", "unknown-number", "line 2"),
        ("T1.5\n", "unknown-number", "line 1"),
        ("T-1\n", "unknown-number", "line 1"),
        ("T1 X1\n;x\nT1 X2\n", "tool-twice", "line 3"),
        ("T1 X1 X2\n", "word-twice", "line 1, column 7"),
        ("T1 Xnan\n", "not-a-number", "line 1, column 4"),
        ("T1 X1e999\n", "not-a-number", "line 1, column 4"),
        ("T1 Xinf\n", "not-a-number", "line 1, column 4"),
        ("T1 X1,5\n", "not-a-number", "line 1, column 4"),
        (f"T1 X{'1' * 500}\n", "not-a-number", "line 1, column 4"),
        ("T1 X60\n", "out-of-range", "line 1"),
        ("T1 D9\n", "out-of-range", "line 1"),
        ("T1 Q10\n", "unknown-orientation", "line 1"),
        ("T1 Q2.5\n", "unknown-orientation", "line 1"),
        ("P3 X1\n", "no-number", "line 1"),
        ("POC FMS LEN\n", "unknown-word", "line 1, column 5"),
        ("tool,x,z\n", "not-a-number", "line 1, column 1"),
    ],
)
def test_invalid_lines_are_rejected(tmp_path: Path, text: str, code: str, place: str) -> None:
    with pytest.raises(ToolTableError) as raised:
        table_of(tmp_path, "a.tbl", text)
    assert code in raised.value.code.split()
    assert str(raised.value).startswith("a.tbl: ")
    assert f"{place}:" in str(raised.value)


def test_missing_unit_is_reported_once(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "unit-missing", "--unit"):
        table_of(tmp_path, "a.tbl", "T1 X1 Z1\nT2 X1 Z1\n", TableReadingOptions())
    assert list(table_of(tmp_path, "a.tbl", "T1 P1 Q2 X0\n", TableReadingOptions()).tools) == [
        1
    ]  # without a length


def test_many_errors_are_summarized_in_one_message(tmp_path: Path) -> None:
    with pytest.raises(ToolTableError) as raised:
        table_of(tmp_path, "a.tbl", "T99 P1\n" * 5000)
    assert raised.value.code == "unknown-number"
    assert str(raised.value).count("T99") == 10
    assert "4990" in str(raised.value)


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"\x0aendmill 12\0\0\0", "binary-table"),
        (b"T1 ;\xff\n", "not-utf8"),
        (b"", "no-tools"),
        (b";\n", "no-tools"),
    ],
)
def test_files_that_are_not_tables_are_rejected(tmp_path: Path, data: bytes, code: str) -> None:
    with raises_code(ToolTableError, code, "a.tbl"):
        table_of(tmp_path, "a.tbl", data)


def test_written_table_is_read_back_unchanged(tmp_path: Path) -> None:
    text = "T3 X1.5 Z-2 D.0315 Q2 ;CNMG431 rough\nT4 X1 Z2 D.25 Q7 ;drill\nT5 X2 Z1 D.02 Q9\n"
    tools = table_of(tmp_path, "a.tbl", text).tools
    for unit in ("in", "mm"):
        again = table_of(
            tmp_path, "b.tbl", format_table(tools.values(), unit), TableReadingOptions(unit=unit)
        ).tools
        assert again.keys() == tools.keys()
        for number, tool in tools.items():
            assert again[number].offset_values == pytest.approx(tool.offset_values, abs=2e-5)
            assert again[number].shape_values == pytest.approx(tool.shape_values, abs=2e-5)
