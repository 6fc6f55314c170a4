"""``turndesk parts``: what the store knows of parts, as text, CSV and JSON; and what is refused."""

from __future__ import annotations

import csv
import io
import json
from functools import partial
from pathlib import Path

import pytest

from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from tests.cli.conftest import Turndesk


@pytest.fixture
def made(home: Path) -> Path:
    """Ten parts of peg.nc, Ø 12.69 and 12.71 by turns in a tolerance of ± .05, and one of ring.nc."""
    row = FeatureRow(0, "peg.nc", "SPIGOT", "diameter", 12.7, -0.05, 0.05, "tool", 1, 1, 0, 1)
    with Store.open(home) as store:
        of = store.write(lambda c: measured_parts.save_feature(c, row)).result(60)
        for part in range(1, 11):
            began, ended = "2026-01-01T00:00:00Z", "2026-01-01T00:01:00Z"
            made = CycleRow(f"c{part}", "peg.nc", part, began, ended, 60.0 + part, "COMPLETE")
            store.write(partial(part_cycles.save_cycle, row=made)).result(60)
            store.runs.add_parts("peg.nc")
            reading = ReadingRow(0, of, part, 12.69 if part % 2 else 12.71, "in", "2026", "gauge", "mic")
            store.write(partial(measured_parts.add_reading, row=reading)).result(60)
        stop = ProductionStopRow("s", "c1", "peg.nc", "2026-01-01T00:00:30Z", 4.0, "FEED HOLD", 7)
        store.write(lambda c: part_cycles.save_stop(c, stop)).result(60)
        store.write(lambda c: tool_lives.save_tool_life_limits(c, ToolLifeRow(1, 50))).result(60)
        store.offsets.tool_offsets.change_row(1, "wear", {"x": 0.0, "z": 0.0, "wear_x": -0.01}).result(60)
        store.runs.add_parts("ring.nc").result(60)
    return home


def test_json_contains_capability_stops_and_tool_lives(turndesk: Turndesk, made: Path) -> None:
    """Cpk by hand: every moving range is .02, so .05 · 1.128 / .06."""
    told = turndesk("parts", "--json")
    assert (told.status, told.err) == (0, "")
    found = json.loads(told.out)
    peg, ring = found["programs"]
    assert (peg["program"], peg["parts"], ring["program"], ring["parts"]) == ("peg.nc", 10, "ring.nc", 1)
    assert [each["seconds"] for each in peg["cycles"]] == [61.0 + part for part in range(10)]
    (spigot,) = peg["features"]
    assert [each["value"] for each in spigot["readings"]] == [12.69, 12.71] * 5
    assert spigot["capability"]["cpk"] == pytest.approx(0.94)
    (wear,) = peg["corrections"]
    assert (wear["number"], wear["x"], wear["part"], wear["why"]) == (1, -0.01, 10, "wear")
    assert [each["reason"] for each in found["stops"]] == ["FEED HOLD"]
    assert found["tool_lives"][0]["limit_parts"] == 50


def test_single_program_can_be_selected(turndesk: Turndesk, made: Path) -> None:
    found = json.loads(turndesk("parts", "ring.nc", "--json").out)
    assert [each["program"] for each in found["programs"]] == ["ring.nc"]
    assert found["stops"] == []


def test_csv_has_a_line_per_reading_in_its_original_unit(turndesk: Turndesk, made: Path) -> None:
    rows = list(csv.DictReader(io.StringIO(turndesk("parts", "--csv").out)))
    assert len(rows) == 10
    first = rows[0]
    assert (first["program"], first["feature"], first["part"], first["unit"]) == (
        "peg.nc",
        "SPIGOT",
        "1",
        "in",
    )
    assert float(first["value"]) == pytest.approx(12.69 / 25.4)
    assert (first["nominal"], first["good"], first["source"], first["gauge"]) == (
        "0.5",
        "yes",
        "gauge",
        "mic",
    )


def test_text_output_lists_readings_and_parts(turndesk: Turndesk, made: Path) -> None:
    with Store.open(made) as store:  # its time is not that of the program
        began, ended = "2026-01-01T00:02:00Z", "2026-01-01T00:02:05Z"
        rest = CycleRow("r", "peg.nc", 10, began, ended, 5.0, "RESTARTED")
        store.write(partial(part_cycles.save_cycle, row=rest)).result(60)
    out = turndesk("parts").out.splitlines()
    assert out[0] == "peg.nc: parts 10, mean cycle time 65.5 s (cycles: 10)"
    assert out[1] == "  SPIGOT 12.7000 mm: readings 10, last reading 12.7100 mm (part 10), Cpk 0.94"
    assert out[2] == "ring.nc: parts 1"


def test_missing_store_gives_an_empty_result(turndesk: Turndesk) -> None:
    assert turndesk("parts").out == "no parts are known yet\n"
    assert json.loads(turndesk("parts", "--json").out)["programs"] == []


def test_unknown_program_is_rejected(turndesk: Turndesk, made: Path) -> None:
    told = turndesk("parts", "pin.nc")
    assert (told.status, told.out) == (2, "")
    assert (told.code, told.err.count("\n")) == ("unknown-program", 1)
    assert "pin.nc" in told.err


def test_csv_and_json_together_are_rejected(turndesk: Turndesk) -> None:
    told = turndesk("parts", "--csv", "--json")
    assert told.status == 2
    assert "not allowed with" in told.err
