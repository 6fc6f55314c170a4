"""``turndesk where``, ``turndesk help`` and a program file without a command."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.command_parser import insert_program_option
from app.cli.main import list_commands
from tests.cli.conftest import Turndesk


def test_where_lists_the_paths_of_the_data_folder(turndesk: Turndesk, home: Path) -> None:
    places = json.loads(turndesk("where", "--json").out)
    assert places["data_folder"] == str(home)
    assert places["store"] == str(home / "turndesk.db")
    assert Path(places["machine_file"]).name == "gt75.toml"
    assert Path(places["machine_file"]).is_file()


def test_missing_path_is_marked(turndesk: Turndesk, home: Path) -> None:
    home.mkdir()
    rows = {line.split()[0]: line for line in turndesk("where").out.splitlines()}
    assert "does not exist yet" not in rows["data_folder"]
    assert "does not exist yet" in rows["store"]


def test_the_machine_file_of_an_option_is_absolute(
    turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shipped = json.loads(turndesk("where", "--json").out)["machine_file"]
    (tmp_path / "mine.toml").write_text(Path(shipped).read_text())
    monkeypatch.chdir(tmp_path)
    assert json.loads(turndesk("where", "--json", "--machine", "mine.toml").out)["machine_file"] == str(
        tmp_path / "mine.toml"
    )


def test_a_missing_machine_file_is_rejected(turndesk: Turndesk) -> None:
    told = turndesk("where", "--machine", "nowhere.toml")
    assert (told.status, told.out, "nowhere.toml" in told.err) == (2, "", True)


def test_help_command_matches_the_help_option(turndesk: Turndesk) -> None:
    assert turndesk("help", "offsets", "set").out == turndesk("offsets", "set", "--help").out
    assert turndesk("help").out == turndesk("--help").out


@pytest.mark.parametrize("words", [["ofsets"], ["offsets", "sett"]])
def test_help_of_an_unknown_command_is_rejected(words: list[str], turndesk: Turndesk) -> None:
    told = turndesk("help", *words)
    assert (told.status, told.out, words[-1] in told.err) == (2, "", True)


@pytest.fixture
def part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    for name in ("part.nc", "prove"):
        Path(name).write_text("M30\n")
    return "part.nc"


@pytest.mark.parametrize("before", [[], ["--kiosk"], ["--machine", "gt75"], ["--machine=gt75", "--demo"]])
def test_program_file_argument_is_passed_to_the_screen(part: str, before: list[str]) -> None:
    assert insert_program_option([*before, part], list_commands()) == [*before, "--program", part]


@pytest.mark.parametrize(
    "argv",
    [
        ["prove", "part.nc"],  # a command, although a file of this name exists
        ["--machine", "part.nc"],  # the value of an option
        ["nowhere.nc"],
        ["."],
    ],
)
def test_other_arguments_are_not_a_program(part: str, argv: list[str]) -> None:
    assert insert_program_option(argv, list_commands()) == argv


@pytest.mark.parametrize(
    ("argv", "named"), [(("nowhere.nc",), "nowhere.nc"), (("part.nc", "prove"), "part.nc")]
)
def test_a_missing_file_and_a_second_word_are_rejected(
    part: str, argv: tuple[str, ...], named: str, turndesk: Turndesk
) -> None:
    told = turndesk(*argv)
    assert (told.status, told.out) == (2, "")


def test_a_second_file_is_rejected_by_name(part: str, turndesk: Turndesk) -> None:
    Path("other.nc").write_text("M30\n")
    told = turndesk(part, "other.nc")
    assert (told.status, "other.nc" in told.err) == (2, True)
