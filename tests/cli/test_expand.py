"""``turndesk expand``: the public keys of elementary blocks, in order, with their times."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk

KEYS = {
    "n", "line", "source", "text", "kind", "x", "z", "c", "mx", "mz", "cx", "cz", "dir",
    "feed", "feed_mode", "rpm", "css", "t0", "t1",
}  # fmt: skip


def test_radius_and_diameter_programs_give_the_same_moves(
    turndesk: Turndesk, example: Callable[[str], Path]
) -> None:
    def moves(name: str) -> list[object]:
        lines = turndesk("expand", example(name), "--json").lines
        return [(b["kind"], b["x"], b["z"], b["feed"], b["feed_mode"]) for b in lines]

    assert moves("linear-diameter") == moves("linear-radius")
    assert ("feed", 0.25, -0.5, 0.003, "ipr") in moves("linear-radius")
    assert ("rapid", 0.5, 1.0, 300.0, "ipm") in moves("linear-radius")


def test_expand_json_has_source_in_order_and_block_times(
    turndesk: Turndesk, example: Callable[[str], Path]
) -> None:
    told = turndesk("expand", example("arc-r-diameter-barrel"), "--json")
    assert told.status == 0
    blocks = told.lines
    assert [b["n"] for b in blocks] == list(range(1, len(blocks) + 1))
    assert all(set(b) >= KEYS for b in blocks)
    assert all(before["t1"] <= after["t0"] + 1e-6 for before, after in pairwise(blocks))
    arc = next(b for b in blocks if b["kind"] == "arc")
    assert (arc["cx"], arc["cz"], arc["dir"]) == (pytest.approx(-0.41703, abs=5e-6), -0.35, "cw")
    assert arc["source"] == "G02X.4Z-.5R.635"
    # The arc is .302856 in long, at .003 in/rev and 2500 rpm that is 7.5 in/min.
    assert arc["t1"] - arc["t0"] == pytest.approx(0.302856 / 7.5 * 60, rel=1e-3)


def test_a_work_shift_is_in_the_machine_position_only(
    turndesk: Turndesk, example: Callable[[str], Path]
) -> None:
    blocks = turndesk("expand", example("workshift-dry-run"), "--json").lines
    moving = [b for b in blocks if b["kind"] in {"rapid", "feed"}]
    assert moving
    assert all(b["mz"] == pytest.approx(b["z"] + 3) for b in moving)


def test_expand_of_metric_program_gives_inches(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = tmp_path / "metric.nc"
    path.write_text("G90G71G94F2540\nT1\nX25.4Z12.7\nM30\n")
    (_, move, _) = turndesk("expand", path, "--offsets", offsets, "--json").lines
    assert (move["x"], move["z"], move["feed"]) == (1.0, 0.5, 100.0)


def test_expand_stops_at_first_error_and_reports_it_on_stderr(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "bad.nc"
    path.write_text("G90G94F300\nX1Z1\nX2,5\nX3\nM30\n")
    told = turndesk("expand", path, "--json")
    assert told.status == 1
    assert [b["line"] for b in told.lines] == [2]
    assert ":3:3: error:" in told.err


def test_expand_table_has_its_columns_and_rows(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("G90G94F300\nT1\nX1Z.5\nM30\n")
    rows = turndesk("expand", path, "--offsets", offsets).out.splitlines()
    assert rows[0].split() == ["n", "line", "kind", "X", "radius", "Z", "feed", "rpm", "t", "block"]
    assert rows[2].split()[:6] == ["2", "3", "rapid", "1.00000", "0.50000", "300.00/m"]
