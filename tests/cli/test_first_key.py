"""The help and the version of the command import no command, and say what the whole parser says."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from app import VERSION
from app.cli.command_parser import has_only_screen_options
from app.cli.main import CORE_COMMANDS, build_parser, list_commands

ROOT = Path(__file__).parents[2]
LISTED = """
import sys
sys.argv[1:] = {words!r}
from app.cli.main import main
try:
    main()
except SystemExit:
    pass
print(*sys.modules, file=sys.stderr)
"""
HEAVY = {"numpy", "sqlite3", "dataclasses", "json", "importlib.metadata"}


def modules_of(*words: str) -> set[str]:
    """The modules that a command has imported."""
    command = [sys.executable, "-c", LISTED.format(words=list(words))]
    return set(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stderr.split())


@pytest.mark.parametrize("words", [["--help"], ["-h"], ["--version"]])
def test_help_and_version_import_no_command(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TURNDESK_HOME", raising=False)
    bare = set(
        subprocess.run(
            [sys.executable, "-c", "import sys; print(*sys.modules)"],
            check=True,
            capture_output=True,
            text=True,
        ).stdout.split()
    )
    loaded = modules_of(*words)
    assert "app.cli.main" in loaded
    assert not [name for name in loaded if name.endswith("_command")]
    assert not (loaded - bare) & HEAVY
    assert len(loaded - bare) < 90


def test_command_imports_only_its_own_module() -> None:
    loaded = modules_of("alarms", "--help")
    assert [name for name in loaded if name.endswith("_command")] == ["app.cli.alarms_command"]


def test_bare_parser_has_the_same_help_as_full_parser() -> None:
    assert build_parser(without_options=True).format_help() == build_parser().format_help()
    assert set(CORE_COMMANDS) <= set(list_commands())


def test_each_command_is_listed_once_in_help() -> None:
    text = " ".join(build_parser().format_help().split())
    assert all(text.count(CORE_COMMANDS[name]) == 1 for name in CORE_COMMANDS)


@pytest.mark.parametrize(
    "words", [[], ["--help"], ["--demo", "--kiosk"], ["--program", "prove"], ["--machine=a.toml", "--demo"]]
)
def test_screen_options_alone_do_not_need_the_full_parser(words: list[str]) -> None:
    assert has_only_screen_options(words)


@pytest.mark.parametrize(
    "words",
    [
        ["prove", "--help"],
        ["--program"],
        ["--program", "--demo"],
        ["--jsn"],
        ["part.nc"],
        ["--machine", "a.toml", "prove", "b.nc"],
        ["--demo", "nonsense"],
    ],
)
def test_command_or_unknown_option_needs_the_full_parser(words: list[str]) -> None:
    assert not has_only_screen_options(words)


def test_package_version_comes_from_app_version() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert declared["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "app.VERSION"}
    assert re.fullmatch(r"\d+\.\d+\.\d+", VERSION)
