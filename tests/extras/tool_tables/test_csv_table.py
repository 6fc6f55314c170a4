"""CSV tool tables: headings, units, assigned columns, and rejected files with their places."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.extras.tool_tables.csv_table import format_table
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolTableError
from tests.coded import raises_code
from tests.extras.tool_tables.hand import table_of, tool_of

RADIUS = TableReadingOptions(unit="in", x_meaning="radius")


def test_headings_of_a_lathe_are_recognized(tmp_path: Path) -> None:
    text = "Tool,Description,X Offset,Z Offset,Tip Radius,Tip Direction,X Wear\n3,rough,1.5,-2,.0156,3,.001\n"
    table = table_of(tmp_path, "a.csv", text, RADIUS)
    assert table.tools[3].offset_values == {
        "x": pytest.approx(38.1),
        "z": pytest.approx(-50.8),
        "nose_radius": pytest.approx(0.39624),
        "quadrant": 3,
        "remark": "rough",
    }
    assert "X Wear" in table.notes[0]  # wear is never imported


def test_a_diameter_is_halved(tmp_path: Path) -> None:
    text = "T,X,Z\nT1,3,1\n"
    assert tool_of(tmp_path, "a.csv", text, TableReadingOptions("in", "diameter")).offset_values[
        "x"
    ] == pytest.approx(38.1)
    text = "T,X Dia (mm),Z (mm),Nose diameter (mm)\n1,30,10,0.8\n"
    offset = tool_of(tmp_path, "a.csv", text, TableReadingOptions()).offset_values
    assert offset == {"x": 15.0, "z": 10.0, "nose_radius": 0.4}


def test_columns_are_assigned(tmp_path: Path) -> None:
    columns = {"number": "pos", "x": "Dia", "z": "Length"}
    text = "Pos;Dia;Length;X\n7;76,2;-50,8;99\n"
    tool = tool_of(tmp_path, "a.csv", text, TableReadingOptions("mm", "", columns))
    assert (tool.tool_number, dict(tool.offset_values)) == (7, {"x": 38.1, "z": -50.8})


def test_a_unit_in_the_heading_precedes_the_option(tmp_path: Path) -> None:
    text = "T,X radius [in],Z (mm)\n1,1,10\n"
    assert dict(tool_of(tmp_path, "a.csv", text, TableReadingOptions("mm")).offset_values) == {
        "x": 25.4,
        "z": 10.0,
    }


def test_shapes_are_read(tmp_path: Path) -> None:
    text = "T\tKind\tHand\tInsert\tHolder\tStick out\n5\tBoring\tL\tCCMT 060204\tS16R-SCLCL06\t2\n"
    tool = tool_of(tmp_path, "a.csv", text, RADIUS)
    assert tool.shape_values == {
        "kind": "boring",
        "hand": "left",
        "insert": "CCMT 060204",
        "holder": "S16R-SCLCL06",
        "stick_out": pytest.approx(50.8),
    }


def test_quotes_line_ends_and_byte_order_mark_are_read(tmp_path: Path) -> None:
    text = b'\xef\xbb\xbf"T","Remark"\r\n"2","one, ""two"""\r\n\r\n'
    assert tool_of(tmp_path, "a.csv", text, RADIUS).offset_values == {"remark": 'one, "two"'}


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("T,Z\n0,1\n", "unknown-number", "line 2, column T"),
        ("T,Z\n99,1\n", "unknown-number", "line 2, column T"),
        ("T,Z\nT33,1\n", "unknown-number", "line 2, column T"),
        ("T,Z\n1,1\n2,1\n1,2\n", "tool-twice", "line 4, column T"),
        ("T,Z\n,1\n", "no-number", "line 2, column T"),
        ("T,Z\none,1\n", "not-a-number", "line 2, column T"),
        ("T,Z\n1,NaN\n", "not-a-number", "line 2, column Z"),
        ("T,Z\n1,0x10\n", "not-a-number", "line 2, column Z"),
        ("T,Z\n1,1 mm\n", "not-a-number", "line 2, column Z"),
        ("T,Z\n1,51\n", "out-of-range", "line 2"),
        ("T,Quadrant\n1,10\n", "out-of-range", "line 2"),
        ("T,Quadrant\n1,2.5\n", "out-of-range", "line 2"),
        ("T,Kind\n1,laser\n", "unknown-word", "line 2, column Kind"),
        ("T,Kind,Rear\n1,form,maybe\n", "not-a-flag", "line 2, column Rear"),
        ("T,Z,Z offset\n1,1,2\n", "column-twice", "line 1"),
        ("X,Z\n1,1\n", "no-number-column", "line 1"),
        ('T,Remark\n1,"open\n', "not-csv", "line 2"),
        ('T,Remark\n1,"a"b\n', "not-csv", "line 2"),
        (f"T,Remark\n1,{'a' * 200_000}\n", "not-csv", "line 2"),
    ],
)
def test_invalid_tables_are_rejected(tmp_path: Path, text: str, code: str, place: str) -> None:
    with raises_code(ToolTableError, code, f"a.csv: {place}:"):
        table_of(tmp_path, "a.csv", text, RADIUS)


def test_x_without_radius_or_diameter_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "x-unclear", "--x"):
        table_of(tmp_path, "a.csv", "T,X,Z\n1,1,1\n")


def test_missing_unit_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "unit-missing", "--unit"):
        table_of(tmp_path, "a.csv", "T,Z\n1,1\n", TableReadingOptions())


def test_unknown_assigned_column_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "unknown-column", "did you mean Diam"):
        table_of(tmp_path, "a.csv", "T,Diam\n1,1\n", TableReadingOptions("in", "", {"x": "Dia"}))


def test_binary_mach_table_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "binary-table", "CSV"):
        table_of(tmp_path, "tools.dat", b"\x05Empty" + bytes(40))


def test_mach_text_table_is_read(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "tools.dat", "Tool,Name,X Offset,Z Offset\n1,rough,1,2\n", RADIUS)
    assert tool.offset_values["remark"] == "rough"


def test_overlong_table_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "too-long", "line 10001"):
        table_of(tmp_path, "a.csv", "T,Z\n" + "1,1\n" * 20_000, RADIUS)


def test_written_table_is_read_back_unchanged(tmp_path: Path) -> None:
    text = (
        "T,X radius,Z,R,Quadrant,Kind,Insert,Holder,Diameter,Flutes,Point,Rear,Remark\n"
        "1,1.5,-2,.0156,3,turning,CNMG432,MCLNR-124B,,,,1,=HYPERLINK()\n"
        "2,1,-1,,7,drill,,,.25,2,118,,drill\n"
    )
    tools = table_of(tmp_path, "a.csv", text).tools
    out = format_table(tools.values(), "mm")
    assert "\n1,38.1" in out
    assert ", =HYPERLINK" in out  # no formula for a spreadsheet
    again = table_of(tmp_path, "b.csv", out, TableReadingOptions()).tools
    assert again.keys() == tools.keys()
    for number, tool in tools.items():
        assert again[number].offset_values == pytest.approx(tool.offset_values, abs=2e-6)
        assert again[number].shape_values == pytest.approx(tool.shape_values, abs=2e-6)
