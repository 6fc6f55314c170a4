"""``turndesk tool_offsets import``: preview, questions, one step of the history, and what is left
unchanged.
"""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from app.extras.tool_tables.import_command import IMPORT_OUTPUT
from core.access.access_table import AccessLevel
from core.message import CodedError
from core.store.store import Store
from core.store.store_rows import OffsetKind, ToolOffsetRow, ToolShapeRow
from core.store.user_records import UserRow, save_user
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole
from tests.cli.say import Say, codes

TABLE = "T1 P1 X1.5 Z-2 D0.0315 Q2 ;CNMG431\nT3 P3 X1 Z-1 D.01 Q3\nT4 D.25 ;drill\n"


@pytest.fixture
def table(tmp_path: Path) -> Path:
    path = tmp_path / "tool.tbl"
    path.write_text(TABLE)
    return path


def rows(home: Path) -> tuple[dict[int, ToolOffsetRow], dict[int, ToolShapeRow]]:
    with Store.open(home, read_only=True) as store:
        return store.offsets.tool_offsets.read_rows(), store.offsets.tool_shapes.read_rows()


def set_tool(home: Path, number: int, **values: float | str) -> None:
    with Store.open(home) as store:
        store.offsets.tool_offsets.change_row(number, "touched off", values).result(60)


def test_new_tools_are_imported(turndesk: Turndesk, table: Path, home: Path) -> None:
    told = turndesk("tools", "import", table, "--unit", "in", "--yes")
    assert (told.status, told.err) == (0, "")
    tools, shapes = rows(home)
    assert tools[1][:5] == pytest.approx((38.1, -50.8, 0.40005, 0.0, 0.0))
    assert tools[1][5:] == (3, "CNMG431", False)
    assert tools[3].quadrant == 2
    assert (shapes[1].kind, shapes[1].insert) == ("turning", "CNMG431")
    assert shapes[4].diameter == pytest.approx(6.35)
    assert 4 not in tools  # it has no position yet


def test_import_is_one_history_step_with_its_reason(turndesk: Turndesk, table: Path, home: Path) -> None:
    turndesk("tools", "import", table, "--unit", "in", "--yes", "--why", "old control")
    with Store.open(home) as store:
        changes = store.offsets.read_history()
    assert {(each.step, each.why) for each in changes} == {(1, "old control")}
    assert {each.kind for each in changes} == {OffsetKind.TOOL, OffsetKind.SHAPE}
    assert turndesk("offsets", "undo").status == 0
    assert rows(home) == ({}, {})
    assert turndesk("offsets", "undo").code == "nothing-to-undo"


def test_default_reason_is_the_file_name(turndesk: Turndesk, table: Path, home: Path) -> None:
    turndesk("tools", "import", table, "--unit", "in", "--yes")
    with Store.open(home) as store:
        assert {each.why for each in store.offsets.read_history()} == {"import tool.tbl"}


def test_existing_offset_is_not_replaced_by_default(turndesk: Turndesk, table: Path, home: Path) -> None:
    set_tool(home, 1, x=38.0, z=-50.0, wear_x=0.1)
    told = turndesk("tools", "import", table, "--unit", "in", "--yes")
    assert told.status == 0
    assert "T1" in told.err
    tools, shapes = rows(home)
    assert (tools[1].x, tools[1].wear_x, 1 in shapes, 3 in tools) == (38.0, 0.1, False, True)


def test_replace_option_changes_the_offset_and_retains_wear(
    turndesk: Turndesk, table: Path, home: Path
) -> None:
    set_tool(home, 1, x=38.0, z=-50.0, wear_x=0.1, master=True)
    assert turndesk("tools", "import", table, "--unit", "in", "--yes", "--replace").status == 0
    tools, _shapes = rows(home)
    assert (tools[1].x, tools[1].wear_x, tools[1].master) == (pytest.approx(38.1), 0.1, True)


def test_positions_can_be_left_out(turndesk: Turndesk, table: Path, home: Path) -> None:
    set_tool(home, 1, x=10.0, z=-20.0)
    words = ("--unit", "in", "--yes", "--replace", "--no-positions")
    assert turndesk("tools", "import", table, *words).status == 0
    tools, _shapes = rows(home)
    assert (tools[1].x, tools[1].z, tools[1].quadrant) == (10.0, -20.0, 3)
    assert 3 not in tools


def test_only_the_selected_tools_are_imported(turndesk: Turndesk, table: Path, home: Path) -> None:
    assert turndesk("tools", "import", table, "--unit", "in", "--yes", "--only", "3-4").status == 0
    tools, shapes = rows(home)
    assert (list(tools), list(shapes)) == ([3], [4])


def test_a_second_import_changes_nothing(turndesk: Turndesk, table: Path, home: Path) -> None:
    for _ in range(2):
        turndesk("tools", "import", table, "--unit", "in", "--yes", "--replace")
    with Store.open(home) as store:
        assert {each.step for each in store.offsets.read_history()} == {1}


def test_json_without_yes_is_a_preview(turndesk: Turndesk, table: Path, home: Path) -> None:
    set_tool(home, 1, x=25.4, z=-50.8)
    csv = table.with_name("tool.csv")
    csv.write_text("T,X,Z,Kind,Colour\n1,1.5,-2,turning,red\n2,0,0,,\n")
    words = ("--from", "csv", "--map", "remark=Colour", "--x", "radius", "--unit", "in", "--json")
    told = whole(turndesk("tools", "import", csv, *words))
    (first, second) = told["tools"]
    assert first["status"] == "changed"
    assert {"table": "tool", "field": "x", "old": 1.0, "new": 1.5} in first["changes"]
    assert (first["saved"], second["status"], bool(second["notes"])) == (False, "left-out", True)
    assert rows(home)[0][1].x == 25.4
    declared_alone([told], IMPORT_OUTPUT.keys)


def test_json_with_yes_saves(turndesk: Turndesk, table: Path, home: Path) -> None:
    told = whole(turndesk("tools", "import", table, "--unit", "in", "--yes", "--json"))
    assert [each["saved"] for each in told["tools"]] == [True, True, True]
    assert list(rows(home)[0]) == [1, 3]


def test_terminal_import_asks_for_each_group(say: Say, table: Path, home: Path) -> None:
    set_tool(home, 1, x=38.0, z=-50.7)
    status, told = say("tools", "import", table, "--unit", "in", typed="n y", terminal=True)
    assert status == 0
    assert "T3" in told
    tools, _shapes = rows(home)
    assert (tools[1].quadrant, 3 in tools) == (3, False)


def test_import_without_a_terminal_is_rejected(
    say: Say, table: Path, home: Path, refusals: list[CodedError]
) -> None:
    assert say("tools", "import", table, "--unit", "in", typed="y y")[0] == 2
    assert codes(refusals) == ["not-confirmed"]
    assert rows(home) == ({}, {})


def test_a_large_change_is_confirmed_separately(say: Say, table: Path, home: Path) -> None:
    set_tool(home, 1, x=10.0, z=-50.0)
    status, _told = say("tools", "import", table, "--unit", "in", "--only", "1", typed="y n", terminal=True)
    assert (status, rows(home)[0][1].x) == (2, 10.0)


def test_a_position_beyond_the_travel_is_rejected(turndesk: Turndesk, table: Path, home: Path) -> None:
    table.write_text("T1 X49 Z-2\n")
    told = turndesk("tools", "import", table, "--unit", "in", "--machine", "gt75", "--yes")
    assert (told.status, told.code) == (2, "beyond-travel")
    assert rows(home) == ({}, {})


def test_an_impossible_shape_is_rejected(turndesk: Turndesk, tmp_path: Path, home: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("T,Kind,Diameter (mm),Pitch (mm)\n1,tap,3,2\n")
    told = turndesk("tools", "import", path, "--yes")
    assert (told.status, told.code) == (2, "pitch-too-coarse")
    assert "line 2" in told.err
    assert rows(home) == ({}, {})


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("--map", "x"), "no-value"),
        (("--map", "wear_x=X"), "unknown-key"),
        (("--map", "x=A,x=B"), "key-twice"),
        (("--only", "0"), "unknown-number"),
        (("--only", "5-3"), "unknown-number"),
        (("--only", "33"), "unknown-number"),
        (("--machine", "missing"), "unreadable"),
        ((), "unit-missing"),
    ],
)
def test_invalid_options_are_rejected(
    turndesk: Turndesk, table: Path, words: tuple[str, ...], code: str
) -> None:
    told = turndesk("tools", "import", table, "--yes", *words)
    assert (told.status, told.code, told.err.count("\n")) == (2, code, 1)


def test_file_of_unknown_format_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("tools", "import", tmp_path / "tool.xyz", "--yes")
    assert (told.status, told.code) == (2, "unknown-format")


def test_import_below_setup_level_is_rejected(
    say: Say, table: Path, home: Path, refusals: list[CodedError]
) -> None:
    with Store.open(home) as store:
        for name, level in (("ANNA", AccessLevel.SERVICE), ("OLE", AccessLevel.OPERATOR)):
            row = UserRow(name, level, b"salt", b"hash")
            store.write(partial(save_user, row=row)).result(60)
    assert say("tools", "import", table, "--unit", "in", "--yes", "--as", "OLE")[0] == 2
    assert codes(refusals) == ["level-too-low"]
    assert rows(home) == ({}, {})
    assert json.loads(say("tools", "import", table, "--unit", "in", "--json")[1])["tools"]


def test_tool_bit_of_freecad_gets_its_number_from_the_option(
    turndesk: Turndesk, tmp_path: Path, home: Path
) -> None:
    path = tmp_path / "drill.fctb"
    path.write_text('{"name": "drill", "shape": "drill.fcstd", "parameter": {"Diameter": "5 mm"}}')
    assert turndesk("tools", "import", path, "--yes").code == "no-number"
    assert turndesk("tools", "import", path, "--yes", "--number", "6").status == 0
    assert rows(home)[1][6].diameter == 5.0


def test_fusion_library_does_not_change_an_offset_in_use(
    turndesk: Turndesk, tmp_path: Path, home: Path
) -> None:
    set_tool(home, 1, x=38.0, z=-50.0, wear_x=0.1, nose_radius=0.4)
    tool = {"type": "turning general", "unit": "millimeters", "post-process": {"number": 1}}
    path = tmp_path / "lathe.json"
    path.write_text(json.dumps({"data": [{**tool, "geometry": {"SC": "C", "RE": 0.8}}]}))
    assert "T1" in turndesk("tools", "import", path, "--yes").err
    assert rows(home)[0][1].nose_radius == 0.4
    assert turndesk("tools", "import", path, "--yes", "--replace").status == 0
    offset = rows(home)[0][1]
    assert (offset.x, offset.z, offset.wear_x, offset.nose_radius) == (38.0, -50.0, 0.1, 0.8)


def test_number_that_does_not_exist_is_rejected(turndesk: Turndesk, table: Path, home: Path) -> None:
    assert turndesk("tools", "import", table, "--number", "33").status == 2
    assert rows(home) == ({}, {})
