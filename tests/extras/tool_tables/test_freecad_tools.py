"""Tool bits and libraries of FreeCAD: units, kinds, and rejected files."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolTableError
from tests.coded import raises_code
from tests.extras.tool_tables.hand import table_of, tool_of

NUMBERED = TableReadingOptions(default_tool_number=4)


def tool_bit(name: str, shape: str, **parameters: object) -> str:
    return json.dumps({"version": 2, "name": name, "shape": f"{shape}.fcstd", "parameter": parameters})


def test_drill_with_units(tmp_path: Path) -> None:
    text = tool_bit("5 mm drill", "drill", Diameter="5.0000 mm", TipAngle="118.00 °", Length="50 mm")
    tool = tool_of(tmp_path, "a.fctb", text, NUMBERED)
    assert (tool.tool_number, tool.shape_values) == (4, {"kind": "drill", "diameter": 5, "point": 118})
    assert "Length" in tool.notes[0]


def test_tap_in_inches_with_threads_per_inch(tmp_path: Path) -> None:
    """16 threads per inch are a pitch of 25.4 / 16 = 1.5875 mm."""
    text = tool_bit("tap", "tap", Diameter='0.375 "', Pitch="0.000 in", TPI="16", Flutes="3", TipAngle="90 °")
    shape = tool_of(tmp_path, "a.fctb", text, NUMBERED).shape_values
    assert shape == pytest.approx({"kind": "tap", "diameter": 9.525, "pitch": 1.5875, "flutes": 3})


def test_turning_tool_has_the_codes_of_its_name(tmp_path: Path) -> None:
    text = tool_bit("CCMT060204 SCLCR1212", "isoshape", TipRadius="0,40 mm", TipAngle="80 °", EdgeLength=6.35)
    tool = tool_of(tmp_path, "a.fctb", text, NUMBERED)
    assert tool.shape_values == {
        **{"kind": "turning", "hand": "right", "insert": "CCMT060204", "holder": "SCLCR1212"}
    }
    assert tool.offset_values["nose_radius"] == 0.4
    assert "EdgeLength" in tool.notes[0]


def test_library_finds_its_bits_in_both_folders(tmp_path: Path) -> None:
    (tmp_path / "Bit").mkdir()
    (tmp_path / "Library").mkdir()
    (tmp_path / "Bit" / "a.fctb").write_text(tool_bit("a", "reamer", Diameter=8))
    (tmp_path / "Library" / "b.fctb").write_text(tool_bit("center drill", "drill", Diameter="1/8"))
    entries = [{"nr": 2, "path": "a.fctb"}, {"nr": 99, "path": "missing.fctb"}]
    text = json.dumps({"tools": entries, "version": 1})
    table = table_of(
        tmp_path / "Library", "x.fctl", text, TableReadingOptions(selected_tool_numbers=frozenset({2}))
    )
    assert table.tools[2].shape_values == {"kind": "reamer", "diameter": 8}


def test_center_drill_and_shape_type(tmp_path: Path) -> None:
    text = json.dumps(
        {"name": "a", "shape-type": "Drill", "attribute": {"subtype": "center"}, "parameter": {}}
    )
    assert tool_of(tmp_path, "a.fctb", text, NUMBERED).shape_values["kind"] == "centre-drill"


def test_what_is_not_imported_is_named(tmp_path: Path) -> None:
    tool = tool_of(tmp_path, "a.fctb", tool_bit("saw", "slittingsaw", Diameter="60 mm"), NUMBERED)
    assert (tool.shape_values, "'slittingsaw'" in tool.notes[0]) == ({}, True)
    tool = tool_of(tmp_path, "a.fctb", tool_bit("CCMT070204R", "Iso_shape_C"), NUMBERED)
    assert "insert" not in tool.shape_values  # ISO 1832 has no C insert with an edge of 7 mm
    assert "CCMT070204R" in tool.notes[-1]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "not-json"),
        ("[]", "not-an-object"),
        ("{}", "no-tool-list"),
        (tool_bit("a", "drill", Diameter="5 furlongs"), "not-a-number"),
        (tool_bit("a", "drill", Diameter="five mm"), "not-a-number"),
        (tool_bit("a", "drill", Diameter="5 °"), "not-a-number"),
        (tool_bit("a", "drill", Diameter="1.2.3 mm"), "not-a-number"),
        (tool_bit("a", "drill", Diameter=[5]), "not-a-number"),
        (tool_bit("a", "drill", Diameter="900 mm"), "out-of-range"),
    ],
)
def test_invalid_bits_are_rejected(tmp_path: Path, text: str, code: str) -> None:
    with raises_code(ToolTableError, code, "a.fctb"):
        table_of(tmp_path, "a.fctb", text, NUMBERED)


def test_bit_without_a_number_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "no-number", "--number"):
        table_of(tmp_path, "a.fctb", tool_bit("a", "drill"), TableReadingOptions())


@pytest.mark.parametrize(
    ("entry", "code"),
    [
        ({"nr": 1, "path": "missing.fctb"}, "missing-file"),
        ({"nr": 1, "path": "../secret.fctb"}, "invalid-path"),
        ({"nr": 1, "path": "/etc/secret.fctb"}, "invalid-path"),
        ({"nr": 1, "path": "..\\secret.fctb"}, "invalid-path"),
        ({"nr": 1, "path": "a.txt"}, "invalid-path"),
        ({"nr": 1}, "invalid-path"),
        ({"nr": 1, "path": "binary.fctb"}, "not-utf8"),
        ({"nr": 40, "path": "a.fctb"}, "unknown-number"),
        ({"path": "a.fctb"}, "unknown-number"),
        ({"nr": "one", "path": "a.fctb"}, "not-a-number"),
        (1, "not-an-object"),
    ],
)
def test_invalid_entries_of_a_library_are_rejected(tmp_path: Path, entry: object, code: str) -> None:
    (tmp_path / "binary.fctb").write_bytes(b"\xff\xff")
    with raises_code(ToolTableError, code, "x.fctl: tool 1"):
        table_of(tmp_path, "x.fctl", json.dumps({"tools": [entry]}))


def test_overlong_library_is_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "too-long", "1000"):
        table_of(tmp_path, "x.fctl", json.dumps({"tools": [{}] * 1001}))
