"""What a run without a screen leaves in the store: tool life, parts and cycles, where it keeps the pace."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from core.store.production import part_cycles, tool_lives
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from tests.cli.conftest import Turndesk
from tests.texts import shows

pytestmark = pytest.mark.usefixtures("paced_by_steps")

# .05 in at 6 in/min is .5 s at feed with T1.
TEXT = "G90G94F300\nG73\nT1\nG00X1Z.1\nG01G94F6Z.05\nM30\n"


@pytest.fixture
def part(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    return path


def life(home: Path, number: int = 1) -> ToolLifeRow:
    with Store.open(home, read_only=True) as store, store.read() as connection:
        return tool_lives.read_tool_lives(connection).get(number, ToolLifeRow(number))


def limited(home: Path, parts: int, *, stops: bool) -> None:
    with Store.open(home) as store:
        row = ToolLifeRow(1, limit_parts=parts, stops=stops)
        store.write(lambda connection: tool_lives.save_tool_life_limits(connection, row)).result(60)


def test_real_time_run_counts_part_and_feed_time(
    turndesk: Turndesk, home: Path, part: Path, offsets: Path
) -> None:
    for made in (1, 2):
        told = turndesk("run", part, "--headless", "--realtime", "--offsets", offsets)
        assert told.status == 0, told.err
        assert life(home).parts == made
        assert life(home).seconds == pytest.approx(0.5 * made, abs=0.2 * made)
    with Store.open(home, read_only=True) as store:
        assert store.runs.read_part_count("part.nc") == 2
        with store.read() as connection:
            rows = part_cycles.read_cycles(connection, "part.nc", -1)
    assert [row.outcome for row in rows] == ["COMPLETE", "COMPLETE"]


def test_run_after_tool_life_is_used_up_is_refused(
    turndesk: Turndesk, home: Path, part: Path, offsets: Path
) -> None:
    limited(home, 1, stops=True)
    first = turndesk("run", part, "--headless", "--realtime", "--offsets", offsets)
    assert first.status == 0
    assert shows(first.err, "measure.life-is-gone", number=1)
    second = turndesk("run", part, "--headless", "--realtime", "--offsets", offsets)
    assert second.status == 1
    assert "refused: " in second.err
    assert shows(second.err, "measure.life-used-up", number=1, words="1 of 1 parts")
    assert life(home).parts == 1


def test_used_up_tool_life_without_stop_only_warns(
    turndesk: Turndesk, home: Path, part: Path, offsets: Path
) -> None:
    limited(home, 1, stops=False)
    for _ in range(2):
        assert turndesk("run", part, "--headless", "--realtime", "--offsets", offsets).status == 0
    assert life(home).parts == 2


def test_faster_than_real_time_run_counts_no_part(
    turndesk: Turndesk, home: Path, part: Path, offsets: Path
) -> None:
    limited(home, 1, stops=True)
    for _ in range(3):
        assert turndesk("run", part, "--headless", "--offsets", offsets).status == 0
    assert life(home).parts == 0


def test_store_open_in_another_process_counts_no_part_and_is_reported(
    turndesk: Turndesk, home: Path, part: Path, offsets: Path
) -> None:
    with Store.open(home):
        told = turndesk("run", part, "--headless", "--realtime", "--offsets", offsets)
    assert told.status == 0
    assert shows(told.err, "cli.run-not-saved")
    assert life(home).parts == 0


def test_used_up_tool_that_the_program_does_not_use_does_not_bar_run(
    turndesk: Turndesk, home: Path, tmp_path: Path, offsets: Path
) -> None:
    limited(home, 1, stops=True)
    with Store.open(home) as store:
        store.write(lambda connection: tool_lives.save_insert_use(connection, 1, 5, 10.0)).result(60)
    path: Callable[[str], Path] = tmp_path.joinpath
    other = path("other.nc")
    other.write_text(TEXT.replace("T1", "T2"))
    assert turndesk("run", other, "--headless", "--realtime", "--offsets", offsets).status == 0
    assert life(home, 2).parts == 1
