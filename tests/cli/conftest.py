"""Commands run in this process, with a store of their own."""

from __future__ import annotations

import json
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from app.cli.main import main
from app.compose.runs import headless_run
from core.access.access_table import AccessLevel
from core.message import CodedError
from core.store import user_records
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.store import Store
from core.store.store_rows import format_utc
from drivers.wakeups import ManualClock
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
    monkeypatch.setattr(headless_run, "RealClock", ManualClock)


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


@pytest.fixture
def filled(home: Path) -> Path:
    """A store with something in each of its tables."""
    feature = FeatureRow(0, "peg.nc", "SPIGOT", "diameter", 12.7, -0.05, 0.05, "tool", 1, 1, 0, 1)
    began = datetime.now(UTC) - timedelta(hours=2)
    at = format_utc(began)
    with Store.open(home) as store:
        of = store.write(lambda c: measured_parts.save_feature(c, feature)).result(60)
        for part in range(1, 13):
            times = (
                format_utc(began + timedelta(minutes=part)),
                format_utc(began + timedelta(minutes=part, seconds=50)),
            )
            outcome = "COMPLETE" if part > 1 else "ALARM"
            cycle = CycleRow(f"c{part}", "peg.nc", part if part > 1 else 0, *times, 50.0, outcome)
            store.write(partial(part_cycles.save_cycle, row=cycle)).result(60)
            store.runs.add_parts("peg.nc").result(60)
            reading = ReadingRow(0, of, part, 12.69 if part % 2 else 12.79, "in", at, "gauge", "mic")
            store.write(partial(measured_parts.add_reading, row=reading)).result(60)
        stop = ProductionStopRow("s", "c1", "peg.nc", at, 4.0, "FEED HOLD", 7)
        store.write(lambda c: part_cycles.save_stop(c, stop)).result(60)
        store.write(lambda c: tool_lives.save_tool_life_limits(c, tool_lives.ToolLifeRow(1, 50))).result(60)
        store.write(lambda c: tool_lives.record_insert_change(c, 1, "worn")).result(60)
        store.offsets.tool_offsets.change_row(1, "first", {"x": 0.0, "z": 0.0}).result(60)
        store.offsets.tool_offsets.change_row(1, "wear", {"wear_x": -0.01}).result(60)
        store.offsets.tool_offsets.undo_last_step("undone").result(60)
        store.write(
            lambda c: user_records.save_user(
                c, user_records.UserRow("ANN", AccessLevel.SERVICE, b"salt", b"hash")
            )
        ).result(60)
    return home
