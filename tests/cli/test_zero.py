"""G54 to G59 by the command line: from the offsets file, and what is wrong with one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.desk.command_errors import CommandError
from app.offsets.offsets_file import read_offset_rows
from core.store.store_rows import ZeroOffsetRow
from tests.cli.conftest import Turndesk
from tests.coded import raises_code

PROGRAM = "G54\nTRANS C30\nATRANS C10\nG0 X20 Z1 C=DC(0)\nM30\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "offsets.toml"
    path.write_text(text)
    return path


def test_zero_offset_of_a_file_shifts_machine_positions(turndesk: Turndesk, tmp_path: Path) -> None:
    offsets = written(tmp_path, "[zero.54]\nx = 2\nz = -30.5\nc = -15\n[tool.1]\nx = 0\n")
    (tmp_path / "part.mpf").write_text(PROGRAM)
    told = turndesk(
        "expand",
        str(tmp_path / "part.mpf"),
        "--json",
        "--ideal",
        "--machine",
        "sinumerik-modulo",
        "--offsets",
        str(offsets),
    )
    assert told.status == 0, told.err
    move, end = (json.loads(line) for line in told.out.splitlines())
    assert (move["x"], move["mx"], move["mz"]) == (20.0, 12.0, -29.5)
    assert (move["c"], move["mc"], move["dc"]) == (0.0, 25.0, 25.0)
    assert (move["units"], end["kind"]) == ("mm", "action")


def test_zero_offsets_are_read_from_an_offsets_file(tmp_path: Path) -> None:
    path = written(tmp_path, "[zero.54]\nc = 5\n[zero.59]\nz = 1\n[secondary.1]\nx = 0.1\n")
    assert read_offset_rows(path)[2] == {54: ZeroOffsetRow(c=5.0), 59: ZeroOffsetRow(z=1.0)}
    assert sorted(read_offset_rows(path)[1]) == [1]


def test_all_mistakes_in_zero_offsets_are_reported_at_once(tmp_path: Path) -> None:
    path = written(tmp_path, "[zero.53]\nx = 1\n[zero.54]\ny = 1\nx = true\nc = 400\nz = nan\n")
    codes = "unknown-number unknown-key wrong-type out-of-range out-of-range"
    values = ("[zero.53]", "[zero.54] y", "zero.54.x", "mm", "zero.54.c = 400", "zero.54.z = nan")
    with raises_code(CommandError, codes, *values):
        read_offset_rows(path)
    with raises_code(CommandError, "not-tables", "[zero.54]"):
        read_offset_rows(written(tmp_path, "zero = 3\n"))


def test_zero_offset_set_by_command_is_used_by_programs(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("offsets", "set", "G54", "x=2", "z=-30.5", "c=-15")
    assert (told.status, told.out) == (0, "G54 X +2.000  Z -30.500 mm  C -15.000°\n")
    shown = json.loads(turndesk("offsets", "show", "--json").out)
    assert shown["zero"] == {"54": {"x": 2.0, "z": -30.5, "c": -15.0}}
    assert "G54 X +2.000" in turndesk("offsets", "show").out
    (tmp_path / "part.mpf").write_text(PROGRAM)
    told = turndesk("expand", str(tmp_path / "part.mpf"), "--json", "--machine", "sinumerik-modulo")
    assert json.loads(told.out.splitlines()[0])["mz"] == -29.5


@pytest.mark.parametrize(
    ("argv", "code", "value"),
    [
        (("G53", "x=1"), "unknown-zero", "G54…G59"),
        (("G54", "y=1"), "unknown-key", "y "),
        (("G54", "x"), "no-value", "x "),
        (("G54", "x=1", "x=2"), "key-twice", "x "),
        (("G54", "x=one"), "not-a-number", "x:"),
        (("G54", "c=400"), "out-of-range", "G54 C 400"),
        (("H4", "x=1"), "unknown-offset", "H4"),
    ],
)
def test_invalid_zero_offset_is_rejected_in_one_line(
    turndesk: Turndesk, argv: tuple[str, ...], code: str, value: str
) -> None:
    told = turndesk("offsets", "set", *argv)
    assert (told.status, told.code) == (2, code)
    assert value in told.err
    assert told.err.count("\n") == 1


def test_export_and_import_transfer_zero_offsets(turndesk: Turndesk, tmp_path: Path) -> None:
    turndesk("offsets", "set", "G55", "z=-120", "c=7.5")
    assert turndesk("store", "export", str(tmp_path / "out")).status == 0
    turndesk("offsets", "set", "G55", "z=0", "c=0")
    assert turndesk("store", "import", str(tmp_path / "out")).status == 0
    assert json.loads(turndesk("offsets", "show", "--json").out)["zero"]["55"] == {
        "x": 0.0,
        "z": -120.0,
        "c": 7.5,
    }


def test_shipped_machines_are_checked_by_name(turndesk: Turndesk) -> None:
    for name in ("sinumerik-modulo", "sinumerik-linear"):
        told = turndesk("machine", "check", name)
        assert told.status == 0
        assert f"{name}.toml is valid" in told.out
