"""Offsets and inputs files: strict, with every mistake in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.program_options import read_inputs_file
from app.compose.stored_offsets import NO_OFFSETS, read_offsets_file
from app.desk.command_errors import CommandError
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from tests.coded import raises_code


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "file.toml"
    path.write_text(text)
    return path


def test_offsets_file_in_inches_is_converted_to_millimeters(tmp_path: Path) -> None:
    text = "[tool.1]\nx = 1\nz = -0.5\nnose_radius = 0.015\n[secondary.32]\nx = -0.015\n"
    tools, secondary, *_ = read_offsets_file(written(tmp_path, text))
    assert tools == {1: ToolOffset(25.4, -12.7, 0.015 * 25.4)}
    assert secondary == {32: SecondaryOffset(-0.015 * 25.4, 0.0, 0.0)}


def test_empty_file_sets_nothing(tmp_path: Path) -> None:
    assert read_offsets_file(written(tmp_path, "")) == NO_OFFSETS


@pytest.mark.parametrize(
    ("text", "code", "value"),
    [
        ("[tool.33]\nx = 1", "unknown-number", "[tool.33]"),
        ("[tool.01]\nx = 1", "unknown-number", "[tool.01]"),
        ("[tools.1]\nx = 1", "unknown-key", "tools"),
        ("[tool.1]\nr = 1", "unknown-key", "[tool.1] r"),
        ("[tool.1]\nx = '1'", "wrong-type", "tool.1.x"),
        ("[tool.1]\nx = true", "wrong-type", "tool.1.x"),
        ("[tool.1]\nx = nan", "out-of-range", "tool.1.x = nan"),
        ("[tool.1]\nx = 50.1", "out-of-range", "-50…50 in"),
        ("[secondary.1]\nr = -0.1", "out-of-range", "0…2 in"),
        ("tool = 3", "not-tables", "[tool.1]"),
        ("[tool]\n1 = 2", "not-a-table", "[tool.1]"),
        ("[tool.1\n", "not-toml", "file.toml"),
        ("[tool.1]\nx = " + "[" * 50_000, "not-toml", "file.toml"),
        ("[tool.1]\nx = " + "9" * 5000, "not-toml", "file.toml"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_bad_offsets_are_refused(tmp_path: Path, text: str, code: str, value: str) -> None:
    with raises_code(CommandError, code, value):
        read_offsets_file(written(tmp_path, text))


def test_all_mistakes_in_offsets_file_are_reported_at_once(tmp_path: Path) -> None:
    codes = "out-of-range unknown-key unknown-number"
    with raises_code(CommandError, codes, "tool.1.x = 99", "[tool.1] y", "[secondary.40]"):
        read_offsets_file(written(tmp_path, "[tool.1]\nx = 99\ny = 1\n[secondary.40]\n"))


def test_inputs_file_accepts_number_or_terminal_name(tmp_path: Path) -> None:
    assert read_inputs_file(written(tmp_path, '[inputs]\n10 = true\n"TB2-5" = false\n')) == {
        "10": True,
        "TB2-5": False,
    }


@pytest.mark.parametrize(
    ("text", "on"),
    [
        ("7 = true", True),
        ("7 = false", False),
        ('7 = true\n"TB2-9" = false', False),
        ('"TB2-9" = true', True),
    ],
)
def test_input_7_maps_to_the_terminal_that_m95_reads(tmp_path: Path, text: str, on: bool) -> None:
    assert read_inputs_file(written(tmp_path, f"[inputs]\n{text}\n"))["TB2-9"] is on


@pytest.mark.parametrize(
    ("text", "code", "value"),
    [
        ("", "no-table", "[inputs]"),
        ("inputs = 3", "no-table", "[inputs]"),
        ("[input]\n10 = true", "unknown-key no-table", "inputs?"),
        ("[inputs]\n10 = 1", "wrong-type", "inputs.10"),
        ("[inputs]\n10 = 'on'", "wrong-type", "inputs.10"),
    ],
)
def test_bad_inputs_are_refused(tmp_path: Path, text: str, code: str, value: str) -> None:
    with raises_code(CommandError, code, value):
        read_inputs_file(written(tmp_path, text))


def test_inputs_that_the_machine_does_not_have_are_rejected(tmp_path: Path) -> None:
    path = written(tmp_path, '[inputs]\n"TB25" = true\n')
    assert read_inputs_file(path) == {"TB25": True}
    assert read_inputs_file(written(tmp_path, "[inputs]\n7 = true\n"), known_names=("7",)) == {"7": True}
    path = written(tmp_path, '[inputs]\n"TB25" = true\n')
    with raises_code(CommandError, "unknown-key", "TB2-5"):
        read_inputs_file(path, known_names=("TB2-5", "10"))


def test_missing_file_is_refused(tmp_path: Path) -> None:
    with raises_code(CommandError, "unreadable"):
        read_offsets_file(tmp_path / "none.toml")


def test_wear_in_offsets_file_is_added_to_tool_offset(tmp_path: Path) -> None:
    path = tmp_path / "offsets.toml"
    path.write_text(
        '[tool.2]\nx = 1.5\nz = -2\nwear_x = -0.001\nwear_z = 0.002\nquadrant = 3\nremark = "new"\n'
    )
    tools, *_ = read_offsets_file(path)
    assert tools[2].x == pytest.approx(1.499 * 25.4)
    assert tools[2].z == pytest.approx(-1.998 * 25.4)


def test_all_mistakes_of_offsets_and_zeros_are_reported_together(tmp_path: Path) -> None:
    path = written(tmp_path, '[tool.1]\nwear_x = 0.2\n[zero.54]\nx = "1"\n')
    with pytest.raises(CommandError) as raised:
        read_offsets_file(path)
    assert "tool.1.wear_x" in str(raised.value)
    assert "zero.54.x" in str(raised.value)


@pytest.mark.parametrize(
    ("text", "code", "value"),
    [
        ("[tool.1]\nwear_x = 0.2\n", "out-of-range", "tool.1.wear_x = 0.2"),
        ("[tool.1]\nquadrant = 2.5\n", "out-of-range", "0…9"),
        ("[tool.1]\nremark = 5\n", "wrong-type", "tool.1.remark"),
        ("[tool.1]\nmaster = 1\n", "wrong-type", "tool.1.master"),
        ('[tool.1]\nx = "1"\n', "wrong-type", "tool.1.x"),
        ("[tool.1]\nmaster = true\n[tool.2]\nmaster = true\n", "two-masters", "tool.1 and tool.2"),
        ("[secondary.1]\nwear_x = 0.01\n", "unknown-key", "[secondary.1] wear_x"),
    ],
)
def test_unknown_field_in_offsets_file_is_reported(tmp_path: Path, text: str, code: str, value: str) -> None:
    path = tmp_path / "offsets.toml"
    path.write_text(text)
    with raises_code(CommandError, code, value):
        read_offsets_file(path)
