"""Tools and presets of a mill by the command line: set, refused, exported, imported; tool life in a run."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.store.production import tool_lives
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from core.store.store_rows import MillToolRow, OffsetKind, PresetRow
from tests.cli.conftest import Turndesk
from tests.texts import shows

TOOL = ("offsets", "set", "TOOL7", "L=60", "R=12/2", "DL=-.02", "name=Mill 12", "time2=90", "stop=1")
PRESET = ("offsets", "set", "preset3", "x=230", "y=210", "z=-350", "rot=2.5", "c=-30")
ROWS = (
    MillToolRow("Mill 12", 60.0, 6.0, dl=-0.02, life=90.0, stops=True),
    PresetRow(230.0, 210.0, -350.0, 2.5, c=-30.0),
)


def rows(home: Path) -> tuple[MillToolRow, PresetRow]:
    with Store.open(home, read_only=True) as store:
        return store.offsets.mill_tools.read_rows()[7], store.offsets.presets.read_rows()[3]


def test_tools_and_presets_are_set_by_column_names(turndesk: Turndesk, home: Path) -> None:
    told = turndesk(*TOOL)
    assert (told.status, told.out.startswith("TOOL7 NAME Mill 12  L +60.000  R 6.000")) == (0, True), told
    assert turndesk(*PRESET).status == 0
    assert rows(home) == ROWS
    assert turndesk("offsets", "undo", "preset").status == 0
    with Store.open(home, read_only=True) as store:
        assert store.offsets.presets.read_rows() == {}


@pytest.mark.parametrize(
    ("words", "code", "value"),
    [
        (("TOOL0", "L=1"), "unknown-number", "1 to 999"),
        (("PRESET100", "x=1"), "unknown-number", "1 to 99"),
        (("TOOL7", "L=1001"), "out-of-range", "-1000…1000 mm"),
        (("TOOL7", "radius=-1"), "out-of-range", "0…1000 mm"),
        (("TOOL7", "x=1"), "unknown-key", "x"),
        (("PRESET3", "L"), "no-value", "x=100"),
        (("TOOL7", "stop=2"), "not-a-flag", "2"),
    ],
)
def test_invalid_tool_or_preset_is_rejected(
    turndesk: Turndesk, home: Path, words: tuple[str, ...], code: str, value: str
) -> None:
    answer = turndesk("offsets", "set", *words)
    assert (answer.status, answer.code) == (2, code)
    assert value in answer.err
    with Store.open(home) as store:
        assert (store.offsets.mill_tools.read_rows(), store.offsets.presets.read_rows()) == ({}, {})


def test_export_and_import_transfer_mill_tools_and_presets(
    turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    turndesk(*TOOL)
    turndesk(*PRESET)
    out, second = tmp_path / "out", tmp_path / "second"
    assert turndesk("store", "export", out).status == 0
    monkeypatch.setenv("TURNDESK_HOME", str(second))
    told = turndesk("store", "import", out)
    assert "mill tools: 1, presets: 1" in told.out
    assert rows(second) == ROWS


def test_import_with_a_damaged_table_changes_nothing(turndesk: Turndesk, home: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    turndesk(*PRESET)
    assert turndesk("store", "export", out).status == 0
    (out / "mill_tools.csv").write_text("number,name,length\n7,A,60\n8,B,sixty\n")
    told = turndesk("store", "import", out)
    assert (told.status, told.code) == (2, "unreadable-export")
    assert "mill_tools.csv line 3" in told.err
    (out / "mill_tools.csv").write_text("number,name,length\n1000,A,60\n")
    told = turndesk("store", "import", out)
    assert (told.code, "T1000" in told.err) == ("unknown-number", True)
    with Store.open(home) as store:
        assert store.offsets.mill_tools.read_rows() == {}


@pytest.mark.parametrize("row", ["3,1,2,3,0,0,0,0", "3,1,2", "3", "3,1,2,3,0,0,0,0,VICE,9"])
def test_import_of_an_incomplete_row_changes_nothing(
    turndesk: Turndesk, home: Path, tmp_path: Path, row: str
) -> None:
    out = tmp_path / "out"
    turndesk(*PRESET)
    assert turndesk("store", "export", out).status == 0
    (out / "presets.csv").write_text(f"number,x,y,z,rotation,a,b,c,remark\n{row}\n")
    with Store.open(home) as store:
        before = store.offsets.presets.read_rows()
    told = turndesk("store", "import", out)
    assert (told.status, told.code) == (2, "unreadable-export")
    assert "presets.csv line 2: the row does not have one cell for each column" in told.err
    with Store.open(home) as store:
        assert store.offsets.presets.read_rows() == before


def test_import_of_a_table_without_a_column_sets_the_other_fields(
    turndesk: Turndesk, home: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    turndesk(*PRESET)
    assert turndesk("store", "export", out).status == 0
    (out / "presets.csv").write_text("number,x,y,z\n5,1,2,3\n")
    assert turndesk("store", "import", out).status == 0
    with Store.open(home) as store:
        row = store.offsets.presets.read_rows()[5]
    assert (row.x, row.y, row.z, row.remark) == (1.0, 2.0, 3.0, "")


@pytest.mark.usefixtures("paced_by_steps")
def test_program_is_rejected_if_life_of_its_tool_is_used_up(
    turndesk: Turndesk, home: Path, tmp_path: Path
) -> None:
    """.1 mm at 60 mm/min is .1 s at feed; the life of T7 is .06 s."""
    part = tmp_path / "part.h"
    part.write_text("BEGIN PGM P MM\nTOOL CALL 7 Z S500\nL IZ-0.1 R0 F60\nEND PGM P MM\n")
    turndesk("offsets", "set", "TOOL7", "L=60", "time2=.001", "stop=1")
    run = ("run", part, "--headless", "--realtime", "--machine", "ac-table-mill")
    first = turndesk(*run)
    assert first.status == 0, first.err
    assert shows(first.err, "measure.life-is-gone", number=7)
    second = turndesk(*run)
    assert second.status == 1
    assert shows(second.err, "measure.life-used-up", number=7)
    assert "set its CUR.TIME to 0 in the tool table" in second.err
    with Store.open(home) as store:
        with store.read() as connection:
            life = tool_lives.read_tool_lives(connection, OffsetKind.MILL_TOOL)[7]
            assert tool_lives.read_tool_lives(connection) == {}  # nothing of it goes to a lathe's T7
        assert (life.parts, life.limit_seconds, life.stops) == (1, pytest.approx(0.06), True)
        assert life.seconds >= 0.09
        store.write(lambda c: tool_lives.record_insert_change(c, 7, "fresh", OffsetKind.MILL_TOOL)).result(60)
        with store.read() as connection:
            fresh = tool_lives.read_tool_lives(connection, OffsetKind.MILL_TOOL)[7]
            (kept,) = tool_lives.read_insert_changes(connection, 9)
    assert fresh._replace(limit_seconds=0.0) == ToolLifeRow(7, 0, 0.0, 0.9, True)
    assert fresh.limit_seconds == pytest.approx(0.06)
    assert (kept.number, kept.parts, kept.kind) == (7, 1, "mill tool")
