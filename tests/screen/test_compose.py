"""The desk put together: which offsets it starts with, which machines it takes, that it ends."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from app.cli.errors import CommandError
from app.compose.screen import build_desk, first_offsets
from core.store.store import Store

SHIPPED = Path(__file__).parents[2] / "resources" / "machines" / "gt75.toml"


def test_a_new_simulated_lathe_has_the_tools_of_the_samples(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "nothing yet"))
    tools, secondary = first_offsets()
    assert sorted(tools) == [1, 2, 3]
    assert tools[1].z == pytest.approx(-3.0 * 25.4)
    assert secondary == {}


def test_one_tool_entered_ends_that(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with Store.open(tmp_path) as store:
        store.set_tool(7, x=1.0, z=2.0, why="touched off").result(5)
    tools, _secondary = first_offsets()
    assert sorted(tools) == [7]


def test_a_machine_that_is_not_simulated_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "real.toml"
    file.write_text(SHIPPED.read_text().replace('backend = "sim"', 'backend = "canopen"'))
    with pytest.raises(CommandError, match=r"canopen"):
        build_desk(str(file))


def test_a_machine_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CommandError, match=r"nothing\.toml"):
        build_desk(str(tmp_path / "nothing.toml"))


def test_closing_the_desk_ends_its_threads() -> None:
    desk = build_desk()
    assert any(thread.name == "executor" for thread in threading.enumerate())
    desk.close()
    assert not any(thread.name.startswith(("executor", "loading")) for thread in threading.enumerate())
