"""``-`` for stdin and stdout, streams that are closed, have other letters, or have no end."""

from __future__ import annotations

import os
import subprocess
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk
from tests.texts import text as wording

PART = "G90G94F300\nT1\nX.5Z.1\nM30\n"
OFFSETS = "[tool.1]\nx = 0.0\nz = 0.0\n"


@pytest.fixture
def part(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(PART)
    return path


def _stdin(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(text.encode())))


@pytest.mark.parametrize("option", ["--offsets", "--tools"])
def test_offsets_or_tool_table_is_read_from_stdin(
    option: str, part: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    _stdin(monkeypatch, OFFSETS)
    told = turndesk("prove", part, option, "-", "--json")
    (found,) = told.lines
    codes = {each["code"] for each in found["diagnostics"]}
    assert ("tool-offset-missing" in codes) == (option == "--tools")


def test_stdin_cannot_be_used_for_two_files(turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch) -> None:
    _stdin(monkeypatch, OFFSETS)
    told = turndesk("prove", "-", "--offsets", "-")
    assert told.status == 2
    assert told.err.count("\n") == 1
    assert told.code == "stdin-taken"


def test_out_option_with_a_dash_writes_to_stdout(
    part: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(part.parent)
    told = turndesk("trace", part, "--dt", ".1", "--out", "-")
    assert told.out.startswith("t,x,z,c,spindle_deg,line\n")
    assert not (part.parent / "-").exists()
    assert turndesk("trace", part, "--dt", ".1", "--out", "-", "--json").status == 2


def test_stock_of_a_program_from_stdin_cannot_be_saved(
    turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    _stdin(monkeypatch, PART)
    told = turndesk("prove", "-", "--stock", "bar:1", "--keep-stock")
    assert (told.status, told.code) == (2, "stdin-has-no-name")


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["prove", "/dev/zero"], "file-unreadable"),
        (["expand", "/dev/zero"], "file-unreadable"),
        (["prove", "PART", "--offsets", "/dev/zero"], "unreadable"),
        (["prove", "PART", "--machine", "/dev/zero"], "unreadable"),
    ],
)
def test_endless_input_file_is_rejected(words: list[str], code: str, part: Path, turndesk: Turndesk) -> None:
    told = turndesk(*(str(part) if word == "PART" else word for word in words))
    assert (told.status, told.code, told.err.count("\n")) == (2, code, 1)


def test_empty_file_name_is_rejected(part: Path, turndesk: Turndesk) -> None:
    told = turndesk("prove", "", "--jobs", "1")
    assert (told.status, told.code) == (2, "empty-name")
    told = turndesk("prove", "")
    assert (told.status, told.code) == (2, "empty-name")


@pytest.mark.parametrize("word", ["--maschine", "--maschine=a.toml"])
def test_unknown_option_before_a_command_is_rejected(word: str, part: Path, turndesk: Turndesk) -> None:
    told = turndesk(word, "a.toml", "prove", part)
    assert told.status == 2
    assert f"unrecognized arguments: {word}; did you mean --machine?" in told.err


def _turndesk(folder: Path, *words: str, **more: object) -> subprocess.CompletedProcess[bytes]:
    env = {**os.environ, "TURNDESK_HOME": str(folder / "home"), "PYTHONIOENCODING": str(more.pop("code", ""))}
    start = "import sys; from app.cli.main import run_console; sys.exit(run_console())"
    ask = [sys.executable, "-c", start, *words]
    return subprocess.run(ask, capture_output=True, check=False, env=env, **more)  # type: ignore[call-overload,no-any-return]


@pytest.mark.parametrize("code", ["ascii", "cp1252", "utf-8"])
def test_character_missing_in_the_output_encoding_is_a_question_mark(code: str, tmp_path: Path) -> None:
    assert _turndesk(tmp_path, "offsets", "set", "T1", "x=1", "remark=Ω", code=code).returncode == 0
    told = _turndesk(tmp_path, "offsets", "history", code=code)
    assert (told.returncode, told.stderr) == (0, b"")
    assert ("→" if code == "utf-8" else "?").encode() in told.stdout


@pytest.mark.parametrize("closed", [0, 1, 2])
def test_closed_standard_stream_is_not_an_error(closed: int, part: Path) -> None:
    def close() -> None:
        os.close(closed)

    told = _turndesk(part.parent, "prove", str(part), preexec_fn=close)
    assert (told.returncode, told.stderr) == (0, b"")


def test_closed_stdin_is_reported(tmp_path: Path) -> None:
    told = _turndesk(tmp_path, "prove", "-", preexec_fn=lambda: os.close(0))
    assert told.returncode == 2
    assert told.stderr.decode() == f"turndesk: {wording('desk.stdin-closed', what='program')}\n"
