"""What docs/speed.md says: each goal that is not met with its reason and no other, and what was kept."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.benchmarks.speed_goals import GOALS, goal_of, not_met
from tests.benchmarks.speed_page import kept, with_kept

LONG = "prove 1,000,000 blocks"


@pytest.mark.parametrize(
    ("figure", "told"),
    [
        ((1.2, 170.0, 0.35), False),
        ((1.21, 150.0), True),
        ((1.0, 171.0), True),
        ((1.0,), False),
        ((1.0, 150.0, 0.36), True),
    ],
)
def test_time_or_memory_over_the_goal_is_reported(figure: tuple[float, ...], told: bool) -> None:
    assert list(not_met({LONG: figure})) == ([f"{LONG}: {GOALS[LONG].why}."] if told else [])


def test_row_without_goal_is_never_reported_and_shows_none() -> None:
    assert list(not_met({"bare interpreter": (99.0, 999.0)})) == []
    assert (goal_of("bare interpreter", "{:.2f}"), goal_of("window usable", "{:.2f}")) == ("–", "0.50")
    assert (goal_of(LONG, "{:.0f}", "memory"), goal_of("window usable", "{:.0f}", "memory")) == ("170", "–")
    assert (goal_of(LONG, "{:.2f}", "peer"), goal_of("window usable", "{:.2f}", "peer")) == ("0.35", "–")


@pytest.mark.parametrize("name", GOALS)
def test_every_goal_has_its_reason(name: str) -> None:
    assert GOALS[name].most > 0.0
    assert len(GOALS[name].why) > 20


def test_page_shows_the_stored_measurements() -> None:
    written = (Path(__file__).parents[1] / "docs" / "speed.md").read_text(encoding="utf-8")
    assert written == with_kept(written), "python -m tests.benchmarks.speed_page --kept docs/speed.md"


def test_missing_measurement_is_stated(tmp_path: Path) -> None:
    assert kept(tmp_path).count("Not measured yet.") == 5
