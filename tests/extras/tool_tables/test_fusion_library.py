"""Tool libraries of Fusion: values by hand from the sizes of ISO 1832, and rejected files."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import pytest

from core.extras.tool_tables import fusion_library
from core.extras.tool_tables.tool_entry import TableReadingOptions, ToolEntry, ToolTable, ToolTableError
from tests.coded import raises_code
from tests.extras.tool_tables.hand import table_of

PLAIN = TableReadingOptions()
CNMG = {
    **{"SC": "C", "RA": 0, "TC": "M", "SCTY": "G", "INSD": 12.7, "SIZE_SPECIFICATION_MODE": "IC"},
    **{"S": 4.76, "RE": 0.8},
}
SHANK = {"MTP": "M", "THSC": "iso l", "HAND": "R", "H": 25, "W": 25}


def fusion_tool(
    kind: str, number: object = 1, unit: str = "millimeters", **parts: object
) -> dict[str, object]:
    return {"type": kind, "unit": unit, "description": "", "post-process": {"number": number}, **parts}


def library(*tools: object) -> str:
    return json.dumps({"data": list(tools), "version": 1})


def read(folder: Path, *tools: object, options: TableReadingOptions = PLAIN) -> ToolTable:
    return table_of(folder, "a.json", library(*tools), options)


def read_one(folder: Path, tool: object) -> ToolEntry:
    (entry,) = read(folder, tool).tools.values()
    return entry


def test_sizes_of_an_insert_and_a_holder_are_their_codes(tmp_path: Path) -> None:
    """C, 0° = N, M, G; 12.7 mm has an edge of 12.9 mm = 12, 4.76 mm = 04, 0.8 mm = 08."""
    tool = read_one(
        tmp_path, fusion_tool("turning general", 3, geometry=CNMG, holder=SHANK, description="rough")
    )
    assert (tool.tool_number, tool.shape_values) == (
        3,
        {"kind": "turning", "insert": "CNMG120408", "holder": "MCLNR2525", "hand": "right"},
    )
    assert tool.offset_values == {"nose_radius": 0.8, "remark": "rough"}
    assert tool.notes == ()


@pytest.mark.parametrize(
    ("shape", "angle", "letters", "edge", "thickness", "radius", "code"),
    [
        ("C", 7, "MT", 9.67, 3.97, 0.4, "CCMT09T304"),  # 9.525 / sin 80°
        ("D", 7, "MT", 11.63, 3.97, 0.8, "DCMT11T308"),  # 9.525 / sin 55°
        ("V", 5, "MT", 16.61, 4.76, 0.4, "VBMT160404"),  # 9.525 / sin 35°
        ("T", 0, "MG", 16.5, 4.76, 0.8, "TNMG160408"),  # 9.525 · √3
        ("W", 0, "MG", 8.69, 4.76, 0.8, "WNMG080408"),  # 12.7 / 2 · (cot 40° + cot 80°)
    ],
)
def test_size_can_be_the_edge_length(
    tmp_path: Path,
    shape: str,
    angle: int,
    letters: str,
    edge: float,
    thickness: float,
    radius: float,
    code: str,
) -> None:
    sizes = {"SC": shape, "RA": angle, "TC": letters[0], "SCTY": letters[1], "INSD": edge, "S": thickness}
    geometry = {**sizes, "RE": radius, "SIZE_SPECIFICATION_MODE": "CE"}
    tool = read_one(tmp_path, fusion_tool("turning general", geometry=geometry))
    assert tool.shape_values["insert"] == code


def test_boring_bar_in_inches(tmp_path: Path) -> None:
    """A bar of 0.625 in is 10/16 in, and an inscribed circle of 0.25 in is 2/8 in: A code S10-SCLCR2."""
    geometry = {"SC": "C", "RA": 7, "TC": "M", "SCTY": "T", "INSD": 0.25, "S": 0.0937, "RE": 0.0156}
    holder = {"MTP": "S", "THSC": "boring bar l", "HAND": "R", "W": 0.625, "H": 0.625}
    tool = read_one(tmp_path, fusion_tool("turning boring", unit="inches", geometry=geometry, holder=holder))
    assert tool.shape_values == {
        **{"kind": "boring", "hand": "right", "insert": "CCMT060204", "holder": "S10-SCLCR2"},
        "diameter": pytest.approx(15.875),
    }
    assert tool.offset_values["nose_radius"] == pytest.approx(0.39624)


def test_drill_and_tap(tmp_path: Path) -> None:
    drill = fusion_tool(
        "drill", 7, geometry={"DC": 8.5, "SIG": 118, "NOF": 2, "LCF": 40, "LB": 60, "OAL": 90}
    )
    tap = fusion_tool("tap right hand", 8, "inches", geometry={"DC": 0.25, "TP": 0.05, "NOF": 3, "LCF": 1})
    tools = read(tmp_path, drill, tap).tools
    assert tools[7].shape_values == {
        **{"kind": "drill", "diameter": 8.5, "point": 118, "flutes": 2, "length": 40, "stick_out": 60}
    }
    assert "OAL" in tools[7].notes[0]  # the overall length is named
    assert tools[8].shape_values == pytest.approx(
        {"kind": "tap", "diameter": 6.35, "pitch": 1.27, "flutes": 3, "length": 25.4}
    )


def test_groove_width_thread_angle_and_left_hand(tmp_path: Path) -> None:
    groove = {"SC": "groove square", "RE": 0.2, "tool_grooveWidth": 3, "tool_insertWidth": 2.7, "LH": 12}
    thread = {"SC": "thread iso double", "thread-tip-radius": 0.144, "TPX": 1.5, "thread-profile-angle": 60}
    parting = fusion_tool("turning grooving", 3, geometry=groove, description="part-off 3 mm")
    tools = read(
        tmp_path,
        fusion_tool("turning grooving", 1, geometry=groove, holder={"HAND": "L"}),
        fusion_tool("turning threading", 2, geometry=thread),
        parting,
    ).tools
    assert tools[1].shape_values == {"kind": "grooving", "hand": "left", "width": 3, "length": 12}
    assert tools[2].shape_values == {"kind": "threading", "pitch": 1.5, "point": 60}
    assert tools[2].offset_values["nose_radius"] == 0.144
    assert tools[3].shape_values["kind"] == "parting"


def test_archive_is_read(tmp_path: Path) -> None:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("tools.json", library(fusion_tool("drill", geometry={"DC": 5})))
    assert table_of(tmp_path, "a.tools", content.getvalue(), PLAIN).tools[1].shape_values["diameter"] == 5


def test_what_is_not_imported_is_named(tmp_path: Path) -> None:
    unsized = {**CNMG, "S": 4.2}  # no thickness of ISO 1832
    table = read(
        tmp_path,
        {"type": "holder", "description": "ER32"},
        fusion_tool("face mill", 1, description="face"),
        fusion_tool("turning general", 2, geometry=unsized),
        fusion_tool("turning general", 3, geometry=CNMG, description="CNMG 120404"),
        fusion_tool("tap left hand", 4, geometry={"DC": 6}),
    )
    assert "ER32" in table.notes[0]
    assert "'face mill'" in table.tools[1].notes[0]
    assert table.tools[1].shape_values == {}
    assert "insert" not in table.tools[2].shape_values
    assert any("ISO code" in note for note in table.tools[2].notes)
    assert table.tools[3].shape_values["insert"] == "CNMG120408"
    assert "CNMG120404" in table.tools[3].notes[0]
    assert "left-hand" in table.tools[4].notes[0]


def test_holder_without_a_code_is_its_shank(tmp_path: Path) -> None:
    odd = {**SHANK, "H": 20.5, "W": 20.5}
    tool = read_one(tmp_path, fusion_tool("turning general", geometry=CNMG, holder=odd))
    assert tool.shape_values["holder"] == "20.5x20.5 mm"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("{", "not-json"),
        ("[" * 100_000, "not-json"),
        ("[]", "not-an-object"),
        ("{}", "no-tool-list"),
        ('{"data": {}}', "no-tool-list"),
        ('{"data": [1]}', "not-an-object"),
        ('{"data": []}', "no-tools"),
        (library({"type": "drill"}), "no-number"),
        (library(fusion_tool("drill", 0)), "unknown-number"),
        (library(fusion_tool("drill", 33)), "unknown-number"),
        (library(fusion_tool("drill", "x")), "not-a-number"),
        (library(fusion_tool("drill", 1.5)), "unknown-number"),
        (library(fusion_tool("drill"), fusion_tool("tap right hand")), "tool-twice"),
        (library(fusion_tool("drill", unit="furlongs")), "unknown-unit"),
        (library(fusion_tool("drill", unit="")), "unit-missing"),
        (library(fusion_tool("drill", geometry=[])), "not-an-object"),
        (library(fusion_tool("drill", geometry={"DC": True})), "not-a-number"),
        (library(fusion_tool("drill", geometry={"DC": float("nan")})), "not-a-number"),
        (library(fusion_tool("drill", geometry={"DC": 10**400})), "not-a-number"),
        (library(fusion_tool("drill", geometry={"DC": 900})), "out-of-range"),
    ],
)
def test_invalid_libraries_are_rejected(tmp_path: Path, text: str, code: str) -> None:
    with raises_code(ToolTableError, code, "a.json"):
        table_of(tmp_path, "a.json", text, PLAIN)


@pytest.mark.parametrize("member", ["other.json", "../tools.json"])
def test_archive_without_a_library_is_rejected(tmp_path: Path, member: str) -> None:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr(member, library())
    with raises_code(ToolTableError, "damaged-archive", "tools.json"):
        table_of(tmp_path, "a.tools", content.getvalue(), PLAIN)


def test_damaged_and_large_archives_are_rejected(tmp_path: Path) -> None:
    with raises_code(ToolTableError, "damaged-archive", "a.tools"):
        table_of(tmp_path, "a.tools", b"PK\x03\x04" + bytes(50), PLAIN)
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("tools.json", " " * 2000)
    with raises_code(ToolTableError, "too-large", "a.tools"):
        fusion_library.unpack("a.tools", content.getvalue(), 1999)
