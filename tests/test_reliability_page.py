"""The page of what was measured is what its figures say, and is written without any of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.benchmarks.footprint import RESULTS
from tests.benchmarks.reliability_page import page


def test_reliability_page_matches_the_results() -> None:
    written = Path(__file__).parents[1] / "docs" / "reliability.md"
    assert written.read_text() == page(), "python -m tests.benchmarks.reliability_page > docs/reliability.md"


def test_missing_measurement_is_stated(tmp_path: Path) -> None:
    assert page(tmp_path).count("Not measured yet.") == 5


def test_disagreeing_record_is_reported(tmp_path: Path) -> None:
    figures = json.loads((RESULTS / "night_shift.json").read_text())
    (tmp_path / "night_shift.json").write_text(json.dumps({**figures, "disagree": ["store: 7 of 9"]}))
    assert "records disagree: store: 7 of 9." in page(tmp_path)


def test_spread_of_positions_at_bar_stop_is_reported(tmp_path: Path) -> None:
    figures = json.loads((RESULTS / "night_shift.json").read_text())
    places = {"(12.7, -73.5, 0.0)": 90, "(12.7, -73.25, 0.0)": 8, "(12.7, -73.75, 0.0)": 2}
    (tmp_path / "night_shift.json").write_text(json.dumps({**figures, "at the bar stop": places}))
    assert "differed by at most 2.5e-01 mm; 10 of 100 ticks were not at the most frequent position" in page(
        tmp_path
    )


def test_partly_written_result_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "branches.json").write_text("{")
    with pytest.raises(json.JSONDecodeError):
        page(tmp_path)


def test_unexamined_fault_is_reported_as_not_examined(tmp_path: Path) -> None:
    figures = json.loads((RESULTS / "fuzz.json").read_text())
    fault = {"kind": "raised", "where": "KeyError core/a.py:1", "text": "KeyError('x')", "data": ""}
    targets = {name: {**each, "faults": []} for name, each in figures["targets"].items()}
    targets["klartext"]["faults"] = [fault]
    (tmp_path / "fuzz.json").write_text(json.dumps({**figures, "targets": targets}))
    (tmp_path / "limits.toml").write_text("")
    assert "- KeyError core/a.py:1, KeyError('x'): not examined yet" in page(tmp_path)
