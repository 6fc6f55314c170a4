"""``turndesk run``: what the part refuses before anything moves, and what it only announces."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.desk.stored_part import StoredPart
from core.store.store import Store
from tests.cli.conftest import Told, Turndesk
from tests.cli.test_prove import written
from tests.cli.test_stock_option import PART, chuck
from tests.texts import fragment, shows, text

SLIP = PART.replace("G95F.004Z-.5", "G00Z-.5")  # the diameter of .8 is turned at a rapid
TOOL = '[tool.1]\nkind = "turning"\ntip = 3\nnose_radius = 0.0156\ninsert = "DCMT11T304"\n'


@pytest.fixture
def tools(tmp_path: Path) -> Path:
    return written(tmp_path, TOOL, "tools.toml")


def state(told: Told) -> tuple[int, str]:
    return told.status, str(told.lines[-1]["state"])


def test_rapid_into_specified_stock_with_specified_tool_refuses_run(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, tools: Path
) -> None:
    given = ("--headless", "--json", "--offsets", offsets, "--stock", "bar:1:2+.02", "--tools", tools)
    told = turndesk("run", written(tmp_path, SLIP), *given)
    assert state(told) == (1, "refused")
    assert told.lines[-1]["events"] == ""  # nothing was connected
    assert f"9:1: error: {fragment('desk.rapid-into-stock')}" in told.err
    assert state(turndesk("run", written(tmp_path, PART), *given)) == (0, "complete")


def test_rapid_into_assumed_stock_is_a_warning_and_the_run_starts(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    told = turndesk("run", written(tmp_path, SLIP), "--headless", "--json", "--offsets", offsets)
    assert state(told) == (0, "complete")
    (line,) = [each for each in told.err.splitlines() if shows(each, "desk.rapid-into-stock")]
    assert ":9:1: warning:" in line
    assert "Assumed: stock." in line


def test_rapid_into_specified_stock_refuses_run_if_any_tool_would_hit(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    stock = ("--stock", "bar:1:2+.02")
    told = turndesk("run", written(tmp_path, SLIP), "--headless", "--json", "--offsets", offsets, *stock)
    assert state(told) == (1, "refused")


def test_stock_saved_with_the_program_is_used_by_run(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, tools: Path
) -> None:
    path = written(tmp_path, SLIP)
    given = ("run", path, "--headless", "--json", "--offsets", offsets, "--tools", tools)
    assert state(turndesk(*given)) == (0, "complete")
    assert state(turndesk(*given, "--stock", "bar:1:2+.02", "--keep-stock")) == (1, "refused")
    assert state(turndesk(*given)) == (1, "refused")


def test_check_disabled_for_the_program_does_not_refuse_run(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, tools: Path, home: Path
) -> None:
    path = written(tmp_path, SLIP)
    kept = StoredPart("bar:1:2+.02", silenced_checks={"rapid-into-stock": "soft wax"})
    with Store.open(home) as store:
        for key, value in kept.make_stored_settings(path.name).items():
            store.settings.save_setting(key, value).result()
    told = turndesk("run", path, "--headless", "--json", "--offsets", offsets, "--tools", tools)
    assert state(told) == (0, "complete")
    assert text("findings.check-off", why="soft wax") in told.err


def test_tool_that_hits_the_chuck_refuses_run_without_stock(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, tools: Path
) -> None:
    machine = chuck(tmp_path, "diameter = 4.0")
    given = [
        *("run", written(tmp_path, PART), "--headless", "--json"),
        *("--offsets", offsets, "--machine", machine, "--tools", tools),
    ]
    assert state(turndesk(*given, "--stick-out", ".7")) == (0, "complete")
    told = turndesk(*given, "--stick-out", ".4")
    assert state(told) == (1, "refused")
    assert "into-chuck" in told.err


def test_invalid_stock_is_rejected_before_motion(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    told = turndesk("run", written(tmp_path, PART), "--headless", "--offsets", offsets, "--stock", "rod:1")
    assert told.status == 2
    assert told.code == "unknown-form"
