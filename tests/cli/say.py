"""Commands with what is typed into them."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import pytest

from app.cli.main import main
from core.message import CodedError

Captured = pytest.CaptureFixture[str]
Say = Callable[..., tuple[int, str]]


def codes(refusals: list[CodedError]) -> list[str]:
    """Return the codes of the errors of the newest command."""
    return [each.code for each in refusals]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    monkeypatch.setenv("TURNDESK_HOME", str(folder))
    monkeypatch.delenv("SSH_CONNECTION", raising=False)
    monkeypatch.setattr("getpass.getuser", lambda: "shop")
    return folder


@pytest.fixture
def say(home: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured, refusals: list[CodedError]) -> Say:
    """A command with what is typed into it; its status, and what it said."""

    def run(*words: object, typed: str = "", terminal: bool = False) -> tuple[int, str]:
        keyboard = (Terminal if terminal else io.StringIO)("".join(f"{line}\n" for line in typed.split()))
        monkeypatch.setattr("sys.stdin", keyboard)
        refusals.clear()
        status = main([str(word) for word in words])
        told = capsys.readouterr()
        assert "Traceback" not in told.err
        return status, told.out + told.err

    return run


@pytest.fixture
def any_pin(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if every PIN was the right one."""
    monkeypatch.setattr("app.cli.change_author._require_pin", lambda _store, _row: None)
