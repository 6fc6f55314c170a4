"""Commands run in this process, with a store of their own."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from app.cli.main import main
from app.compose import headless_run
from core.message import CodedError
from drivers.waiting import StepClock
from tests.coded import recorded_refusals
from tests.worked import worked


class Told(NamedTuple):
    """How a command ended and what it wrote."""

    status: int
    out: str
    err: str
    code: str = ""  # of the error that ended it

    @property
    def lines(self) -> list[dict[str, Any]]:
        """The JSON objects on stdout, one a line."""
        return [json.loads(line) for line in self.out.splitlines()]


Turndesk = Callable[..., Told]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    monkeypatch.setenv("TURNDESK_HOME", str(folder))
    return folder


@pytest.fixture
def refusals(monkeypatch: pytest.MonkeyPatch) -> list[CodedError]:
    """Every error that has ended a command, the newest one last."""
    return recorded_refusals(monkeypatch)


@pytest.fixture
def turndesk(home: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Turndesk:
    """Run the command line; usage errors end as they do for a user."""
    refusals = recorded_refusals(monkeypatch)

    def run(*argv: object) -> Told:
        refusals.clear()
        try:
            status = main([str(word) for word in argv])
        except SystemExit as end:
            status = int(end.code or 0)
        told = capsys.readouterr()
        return Told(status, told.out, told.err, refusals[-1].code if refusals else "")

    return run


@pytest.fixture
def paced_by_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let ``--realtime`` run on a clock of steps, so that a busy computer changes nothing that is counted."""
    monkeypatch.setattr(headless_run, "RealClock", StepClock)


@pytest.fixture
def offsets(tmp_path: Path) -> Path:
    """T1 to T4 on part zero at home."""
    path = tmp_path / "offsets.toml"
    path.write_text("".join(f"[tool.{n}]\nx = 0.0\nz = 0.0\n" for n in range(1, 5)))
    return path


@pytest.fixture
def example() -> Callable[[str], Path]:
    """A worked example by name; skips where they are absent."""

    return worked
