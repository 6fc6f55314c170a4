"""Shapes of tools by file and by command: inches at the door, millimetres inside, every mistake named."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from pathlib import Path

import pytest

from app.cli.main import main
from app.desk.command_errors import CommandError
from app.offsets.offsets_file import read_offset_rows, read_shape_rows, read_tool_shapes
from core.message import CodedError
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.store.store import Store
from core.store.store_rows import TOOL_HANDS, TOOL_KINDS, ToolOffsetRow, ToolShapeRow
from tests.coded import recorded_refusals

Captured = pytest.CaptureFixture[str]
SHEET = """
[tool.3]
kind = "turning"
hand = "right"
insert = "CNMG432"
nose_radius = .0313
tip = 3
holder = "MCLNR-124B"
[tool.5]
kind = "drill"
diameter = .25
point = 118
[tool.7]
kind = "form"
profile = "0,0 2.5,0 1.25,1.5"
rear = true
"""
CNMG = ToolShape(ToolKind.TURNING, ToolHand.RIGHT, 3, 0.0313 * 25.4, insert="CNMG432", holder="MCLNR-124B")


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    monkeypatch.setenv("TURNDESK_HOME", str(folder))
    return folder


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    path = tmp_path / "tools.toml"
    path.write_text(SHEET, encoding="utf-8")
    return path


def wrong(path: Path, text: str) -> CommandError:
    """Return the error with which every reader refuses a file with mistakes."""
    path.write_text(text, encoding="utf-8")
    told = {}
    for read in (read_tool_shapes, read_shape_rows, read_offset_rows):
        with pytest.raises(CommandError) as caught:
            read(path)
        told[str(caught.value), caught.value.code] = caught.value
    (error,) = told.values()
    return error


def offsets(*argv: str) -> int:
    return main(["offsets", *argv])


def refused(capsys: Captured, *argv: str) -> CodedError:
    """Return the error that a refused command prints on one line."""
    capsys.readouterr()
    with pytest.MonkeyPatch.context() as patch:
        refusals = recorded_refusals(patch)
        assert offsets(*argv) == 2
    told = capsys.readouterr()
    assert (told.out, told.err) == ("", f"turndesk: {refusals[-1]}\n")
    assert told.err.count("\n") == 1
    return refusals[-1]


def test_stored_tool_kinds_and_defaults_match_the_part_model() -> None:
    assert tuple(ToolKind) == TOOL_KINDS
    assert tuple(ToolHand) == TOOL_HANDS
    stated = {each.name: each.default for each in fields(ToolShape)}
    assert stated == ToolShapeRow()._asdict() | {
        "kind": ToolKind.TURNING,  # a row without a kind is no shape yet
        "tip": 0,
        "nose_radius": 0.0,
        "profile": (),
    }


def test_file_of_tools_is_read_in_inches(sheet: Path) -> None:
    shapes = read_tool_shapes(sheet)
    assert sorted(shapes) == [3, 5, 7]
    assert shapes[3] == replace(CNMG, nose_radius=shapes[3].nose_radius)
    assert shapes[3].nose_radius == pytest.approx(0.79502)
    assert shapes[5] == ToolShape(ToolKind.DRILL, diameter=6.35, point=118.0)
    assert shapes[7].profile == ((0.0, 0.0), (2.5, 0.0), (1.25, 1.5)), "outlines are in mm"
    assert shapes[7].rear


def test_tool_shapes_are_read_from_the_offsets_file(tmp_path: Path) -> None:
    path = tmp_path / "offsets.toml"
    path.write_text(
        '[tool.1]\nx = 0.0\nz = 0.0\nkind = "drill"\n[tool.2]\nx = 1.0\n'
        "[secondary.1]\nx = 0.001\n[zero.54]\nz = 5\n",
        encoding="utf-8",
    )
    tools, secondary, zero = read_offset_rows(path)
    assert tools == {1: ToolOffsetRow(), 2: ToolOffsetRow(25.4)}
    assert (sorted(secondary), sorted(zero)) == ([1], [54])
    assert sorted(read_tool_shapes(path)) == [1]


def test_tool_with_only_a_shape_has_no_offset(sheet: Path) -> None:
    """A nose radius is not a place: the machine still refuses to start with this tool."""
    assert read_offset_rows(sheet)[0] == {}


@pytest.mark.parametrize(
    ("text", "code", "value"),
    [
        ('[tool.3]\nkind = "turnin"', "unknown-word", "tool.3.kind = turnin "),
        ('[tool.3]\nkind = ""', "unknown-word", 'tool.3.kind = "" '),
        ("[tool.3]\nkind = 3", "wrong-type", "tool.3.kind "),
        ('[tool.3]\nkind = "turning"\nhand = "lefd"', "unknown-word", "tool.3.hand = lefd "),
        ('[tool.3]\nkind = "turning"\ninsrt = "CNMG432"', "unknown-key", "[tool.3] insrt "),
        ('[tool.3]\nkind = "turning"\ninsert = 432', "wrong-type", "tool.3.insert "),
        (
            '[tool.3]\nkind = "turning"\ninsert = "CNXG432"',
            "invalid-shape",
            "tool.3.insert: CNXG432: ",
        ),
        ('[tool.3]\nkind = "turning"\ntip = 10', "out-of-range", "tool.3.tip = 10 "),
        ('[tool.3]\nkind = "turning"\ntip = 3\nquadrant = 4', "key-twice", "tool.3.quadrant "),
        ('[tool.3]\nkind = "turning"\nrear = 1', "wrong-type", "tool.3.rear "),
        (
            '[tool.3]\nkind = "turning"\nholder = "0,0 4,4 4,0 0,5"',
            "invalid-shape",
            "tool.3.holder: ",
        ),
        ("[tool.5]\ndiameter = .25", "no-kind", "[tool.5] "),
        ('[tool.5]\nkind = "drill"\ndiameter = "1/4"', "wrong-type", "tool.5.diameter "),
        (
            '[tool.5]\nkind = "drill"\ndiameter = -.25',
            "out-of-range",
            "tool.5.diameter = -0.25 ",
        ),
        ('[tool.5]\nkind = "drill"\nflutes = 2.5', "out-of-range", "tool.5.flutes = 2.5 "),
        (
            '[tool.5]\nkind = "drill"\npoint = nan',
            "out-of-range",
            "tool.5.point = nan ",
        ),
        ('[tool.5]\nkind = "drill"\ntip = 3', "invalid-shape", "tool.5.tip: "),
        ('[tool.7]\nkind = "form"\nprofile = "0,0 1,1"', "invalid-shape", "tool.7.profile: "),
        ('[tool.33]\nkind = "drill"', "unknown-number", "[tool.33] "),
        ('[tools.3]\nkind = "drill"', "unknown-key", "tools "),
        ("[tool.3]\nkind = drill", "not-toml", "tools.toml"),
    ],
)
def test_mistake_is_named_by_file_and_key(tmp_path: Path, text: str, code: str, value: str) -> None:
    path = tmp_path / "tools.toml"
    error = wrong(path, text)
    assert error.code == code
    assert str(error).startswith(f"{path}")
    assert value in str(error)


def test_all_mistakes_in_tool_file_are_reported_at_once(tmp_path: Path) -> None:
    text = (
        '[tool.3]\nkind = "turnin"\ninsrt = ""\n[tool.4]\nkind = "turning"\ninsert = "CNXG432"\nwidth = -1\n'
    )
    told = str(wrong(tmp_path / "tools.toml", text))
    for place in ("tool.3.kind", "insrt", "tool.4.insert", "tool.4.width"):
        assert place in told


def test_number_with_a_leading_decimal_point_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "tools.toml"
    path.write_text('[tool.1]\nx = -.5\nz = +.25\nremark = "a = .5"\n', encoding="utf-8")
    (row,) = read_offset_rows(path)[0].values()
    assert (row.x, row.z, row.remark) == (-12.7, 6.35, "a = .5")


def test_tool_shape_is_set_shown_and_logged(capsys: Captured, home: Path) -> None:
    assert offsets("set", "T3", "kind=turning", "insert=CNMG432", "x=1", "z=2", "tip=3") == 0
    assert capsys.readouterr().out.splitlines()[1] == "T3  turning right  insert=CNMG432"
    assert offsets("set", "T3", "holder=MCLNR-124B") == 0
    assert offsets("set", "T5", "kind=DRILL", "diameter=1/4", "point=118") == 0
    capsys.readouterr()
    assert offsets("show", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["tool"]["3"]["quadrant"] == 3
    assert sorted(told["tool"]) == ["3"], "a drill that was never touched off has no offset"
    assert told["shape"]["5"]["diameter"] == 0.25
    assert told["shape"]["3"]["holder"] == "MCLNR-124B"
    with Store.open(home, read_only=True) as store:
        assert store.offsets.tool_shapes.read_rows()[5] == ToolShapeRow("drill", diameter=6.35, point=118.0)


def test_tool_shape_change_is_in_history_and_can_be_undone(capsys: Captured, home: Path) -> None:
    assert offsets("set", "T5", "kind=drill", "diameter=.25") == 0
    assert offsets("set", "T5", "diameter=.26", "--why", "reground") == 0
    capsys.readouterr()
    assert offsets("history", "shape") == 0
    newest, oldest = capsys.readouterr().out.splitlines()
    assert "T5  drill right  diameter=0.25 → drill right  diameter=0.26  reground (command line)" in newest
    assert "T5  not set → drill right  diameter=0.25" in oldest
    assert offsets("undo", "shape") == 0
    with Store.open(home, read_only=True) as store:
        assert store.offsets.tool_shapes.read_rows()[5].diameter == 6.35
        assert store.offsets.tool_offsets.read_history() == (), "offsets have a history of their own"
    assert offsets("set", "T5", "kind=none") == 0
    assert capsys.readouterr().out.endswith("T5 has no shape\n")
    assert offsets("undo", "shape") == 0
    with Store.open(home, read_only=True) as store:
        assert store.offsets.tool_shapes.read_rows()[5].kind == "drill"


def test_export_and_import_transfer_tool_shapes(capsys: Captured, home: Path, tmp_path: Path) -> None:
    assert offsets("set", "T3", "kind=turning", "insert=CNMG432", "x=0", "z=0", "tip=3") == 0
    assert offsets("set", "T5", "kind=drill", "diameter=.25", 'holder=a "collet"') == 0
    with Store.open(home, read_only=True) as store:
        before = store.offsets.tool_shapes.read_rows(), store.offsets.tool_offsets.read_rows()
    assert main(["store", "export", str(tmp_path / "out")]) == 0
    for _ in range(2):  # again it changes nothing
        assert main(["store", "import", str(tmp_path / "out")]) == 0
    (home / "turndesk.db").unlink()
    assert main(["store", "import", str(tmp_path / "out")]) == 0
    with Store.open(home, read_only=True) as store:
        assert (store.offsets.tool_shapes.read_rows(), store.offsets.tool_offsets.read_rows()) == before
        assert len(store.offsets.tool_shapes.read_history()) == 2


@pytest.mark.parametrize(
    ("argv", "code", "value"),
    [
        (("T5", "diameter=.25"), "no-shape", "T5"),
        (("T5", "kind=dril"), "unknown-word", "kind: dril "),
        (("T5", "kind=drill", "hand=lft"), "unknown-word", "hand: lft "),
        (("T5", "kind=drill", "diameter=21"), "out-of-range", "diameter = 21 "),
        (("T5", "kind=drill", "point=200"), "out-of-range", "T5 point angle 200 "),
        (("T5", "kind=drill", "rear=maybe"), "not-a-flag", "rear = maybe "),
        (("T5", "kind=turning", "insert=CNXG432"), "invalid-shape", "T5: insert: CNXG432: "),
        (("T5", "kind=turning", "tip=3"), "needs-both-axes", "T5"),
        (("T5", "tip=3", "quadrant=3"), "key-twice", "quadrant "),
        (("T5", "insrt=CNMG432"), "unknown-key", "insrt "),
        (("D5", "kind=drill"), "unknown-key", "x, z, r"),
    ],
)
def test_rejected_tool_shape_is_one_line_and_sets_nothing(
    capsys: Captured, argv: tuple[str, ...], code: str, value: str
) -> None:
    assert offsets("set", "T9", "kind=drill") == 0
    error = refused(capsys, "set", *argv)
    assert error.code == code
    assert value in str(error)
    capsys.readouterr()
    assert offsets("show") == 0
    assert capsys.readouterr().out == "T9  drill right\n"


def test_tool_shape_that_contradicts_the_offset_is_rejected(capsys: Captured) -> None:
    assert offsets("set", "T5", "x=1", "z=1", "quadrant=3") == 0
    error = refused(capsys, "set", "T5", "kind=drill")
    assert error.code == "invalid-shape"
    assert "T5: tip: " in str(error)
    assert offsets("set", "T5", "kind=drill", "quadrant=7") == 0


def test_shape_invalidated_by_a_later_change_is_reported_before_proving(
    capsys: Captured, tmp_path: Path
) -> None:
    """Its insert meant nothing while it grooved; the proof says which tool it is, and how to mend it."""
    program = tmp_path / "p.nc"
    program.write_text("G90G94F300G72\nT3\nX1Z.1\nM30\n", encoding="utf-8")
    assert offsets("set", "T3", "kind=grooving", "insert=MGMN300", "x=1", "z=2") == 0
    with Store.open(tmp_path / "home") as store:
        store.offsets.tool_shapes.change_row(3, "on the page", {"kind": "turning"}).result()
    capsys.readouterr()
    with pytest.MonkeyPatch.context() as patch:
        refusals = recorded_refusals(patch)
        assert main(["prove", str(program), "--stock", "bar:1"]) == 2
    assert [each.code for each in refusals] == ["invalid-shape"]
    for value in ("T3 insert: MGMN300: ", "(F8)", "turndesk offsets set"):
        assert value in str(refusals[0])
    assert offsets("set", "T3", "kind=none") == 0
    assert main(["prove", str(program), "--stock", "bar:1"]) != 2
