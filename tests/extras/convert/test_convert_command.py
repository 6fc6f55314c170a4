"""The command ``turndesk convert``: options, output and errors."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from app.cli.main import main
from app.cli.proofs import progress_bar
from app.extras.convert import convert_command
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone

PART = "%\nO1\nG20G99\nT0101\nG97S500M03\nG00X1.Z.1\nG01Z-1.F.01\nM41\nM30\n%\n"


@pytest.fixture
def part(tmp_path: Path) -> Path:
    path = tmp_path / "part.txt"
    path.write_text(PART)
    return path


def test_the_program_is_written_once_and_can_be_proved(
    turndesk: Turndesk, part: Path, tmp_path: Path
) -> None:
    made = tmp_path / "part.nc"
    assert turndesk("convert", part, "--out", made).status == 0
    assert made.read_text().splitlines()[0] == "G90G94F300G70G72(L4 O1)"
    assert turndesk("prove", made).status == 0
    again = turndesk("convert", part, "--out", made)
    assert (again.status, again.code) == (2, "file-exists")


def test_nothing_is_written_if_a_line_cannot_be_converted(
    turndesk: Turndesk, part: Path, tmp_path: Path
) -> None:
    part.write_text(PART.replace("M41", "M77"))
    made = tmp_path / "part.nc"
    told = turndesk("convert", part, "--out", made)
    assert told.status == 1
    assert f"{part}:8:1: error" in told.err
    assert not made.exists()
    assert turndesk("convert", part, "--skip-m", "77,78", "--out", made).status == 0


def test_equal_findings_are_printed_once_with_their_lines(turndesk: Turndesk, part: Path) -> None:
    part.write_text(PART.replace("M41\n", "M41\nM41\nG40\nM41\n"))
    told = turndesk("convert", part)
    assert told.err.count("M41") == 1
    assert "[left-out]" in told.err
    assert "(also in 9, 11)" in told.err


def test_the_keys_of_json_are_declared(turndesk: Turndesk, part: Path) -> None:
    (told,) = turndesk("convert", part, "--json").lines
    assert [each["code"] for each in told["findings"]] == ["left-out"]
    assert told["from"] == "fanuc-a"
    declared_alone([told], convert_command.CONVERT_OUTPUT.keys)


def test_source_options_are_applied(turndesk: Turndesk, part: Path) -> None:
    part.write_text("G99\nT0101\nG97S500M03\nG00X1000Z100\nG01X2.Z-1.F.01\nG02X3.Z-1.5I0K-.5\nM30\n")
    words = ("--from", "fanuc-b", "--to", "omniturn", "--no-point", "1", "--unit", "mm", "--x", "radius")
    told = turndesk(
        "convert", part, *words, "--tool-post", "front", "--no-comments", "--machine", "gt75-bench"
    )
    assert told.status in {0, 1}
    told = turndesk("convert", part, *words, "--no-comments")
    assert told.status in {0, 1}


OMNITURN = "G90G94F300G70G72\nT1\nM03S500\nX1.Z.1\nG95F.01Z-1.\nM25\nM30\n"


@pytest.mark.parametrize(("target", "first"), [("linuxcnc", "(part.nc)"), ("fanuc", "%")])
def test_omniturn_program_is_written_for_another_control(
    turndesk: Turndesk, tmp_path: Path, target: str, first: str
) -> None:
    source, made = tmp_path / "part.nc", tmp_path / "other.nc"
    source.write_text(OMNITURN)
    assert turndesk("convert", source, "--to", target, "--out", made).status == 1  # M25
    assert not made.exists()
    done = turndesk("convert", source, "--to", target, "--skip-m", "25", "--out", made)
    assert done.status == 0
    assert f"converted from omniturn to {target}" in done.err
    assert made.read_text().splitlines()[0] == first
    again = turndesk("convert", source, "--to", target, "--skip-m", "25", "--out", made)
    assert (again.status, again.code) == (2, "file-exists")


@pytest.mark.parametrize(
    ("name", "words"), [("part.txt", ()), ("part.nc", ()), ("part.nc", ("--from", "omniturn"))]
)
def test_program_is_written_for_sinumerik(
    turndesk: Turndesk, part: Path, tmp_path: Path, name: str, words: tuple[str, ...]
) -> None:
    (tmp_path / "part.nc").write_text(OMNITURN.replace("M25\n", ""))
    made = tmp_path / "part.mpf"
    assert turndesk("convert", part.parent / name, "--to", "sinumerik", *words, "--out", made).status == 0
    assert made.read_text().splitlines()[0] == f"; {name}"
    assert turndesk("prove", made, "--machine", "sinumerik-modulo").status == 0


@pytest.mark.parametrize(
    ("name", "words", "code"),
    [
        ("part.nc", ("--to", "sinumerik", "--unit", "mm"), "option-without-effect"),
        ("part.nc", ("--to", "sinumerik", "--from", "omniturn", "--unit", "mm"), "option-without-effect"),
        ("part.nc", (), "same-control"),
        ("part.mpf", ("--to", "sinumerik"), "unsupported-source"),
        ("part.nc", ("--to", "omniturn", "--from", "omniturn"), "same-control"),
        ("part.nc", ("--to", "fanuc", "--from", "haas"), "not-omniturn"),
        ("part.mpf", ("--to", "fanuc"), "not-omniturn"),
        ("part.nc", ("--to", "linuxcnc", "--unit", "mm"), "option-without-effect"),
        ("part.nc", ("--to", "linuxcnc", "--x", "radius"), "option-without-effect"),
        ("part.nc", ("--to", "linuxcnc", "--no-point", "1"), "option-without-effect"),
        ("part.nc", ("--to", "linuxcnc", "--tool-post", "front"), "option-without-effect"),
        ("part.nc", ("--to", "fanuc", "--tool-post", "front"), "option-without-effect"),
    ],
)
def test_option_that_contradicts_the_target_is_rejected(
    turndesk: Turndesk, tmp_path: Path, name: str, words: tuple[str, ...], code: str
) -> None:
    source = tmp_path / name
    source.write_text(OMNITURN)
    told = turndesk("convert", source, *words)
    assert (told.status, told.code) == (2, code)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("--skip-m", "M4x"), ""),
        (("--from", "okuma"), ""),
        (("--to", "klartext"), ""),
        (("--no-point", "2"), ""),
        (("--machine", "missing.toml"), "unreadable"),
        (("--out", "missing/part.nc"), "no-folder"),
    ],
)
def test_a_wrong_option_is_rejected(
    turndesk: Turndesk, part: Path, words: tuple[str, ...], code: str
) -> None:
    told = turndesk("convert", part, *words)
    assert told.status == 2
    assert not code or told.code


@pytest.mark.parametrize("target", ["omniturn", "sinumerik", "linuxcnc", "fanuc"])
def test_unrecognized_program_needs_its_control_specified(
    turndesk: Turndesk, part: Path, target: str
) -> None:
    """OmniTurn and LinuxCNC both have these words."""
    part.write_text("G90G94F10\nG00X1Z1\nG01Z0\nM30\n")
    told = turndesk("convert", part, "--to", target)
    assert (told.status, told.code) == (2, "control-unknown")


@pytest.mark.parametrize("target", ["linuxcnc", "fanuc"])
def test_program_of_another_control_is_not_read_as_omniturn(
    turndesk: Turndesk, part: Path, target: str
) -> None:
    told = turndesk("convert", part, "--to", target)
    assert (told.status, told.code) == (2, "not-omniturn")


def test_missing_file_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    assert turndesk("convert", tmp_path / "missing.nc").status == 2


OMNITURN_PART = "G90G94F300G70G72\nT1\nX1.Z.1\nG01X.9Z-1.F60\nX1.\nM30\n"


@pytest.mark.parametrize("is_terminal", [True, False])
@pytest.mark.parametrize(
    ("text", "target", "line_count"),
    [(PART, "omniturn", 10), (PART, "sinumerik", 10), (OMNITURN_PART, "linuxcnc", 6)],
)
def test_progress_has_the_number_of_lines_as_total_only_on_a_terminal(
    text: str,
    target: str,
    line_count: int,
    is_terminal: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(progress_bar, "SHOW_DELAY_S", -1.0)
    monkeypatch.setattr(progress_bar, "REDRAW_INTERVAL_S", 0.0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal)
    program = tmp_path / ("part.nc" if text is OMNITURN_PART else "part.txt")
    program.write_text(text)
    main(["convert", str(program), "--to", target])
    shown = capsys.readouterr().err
    assert ("converting" in shown) is is_terminal
    assert (f"of {line_count}" in shown) is is_terminal


def test_rejected_program_has_no_progress(
    part: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(progress_bar, "SHOW_DELAY_S", -1.0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    part.write_text(PART.replace("M41", "M77"))
    assert main(["convert", str(part)]) == 1
    assert "converting" not in capsys.readouterr().err
