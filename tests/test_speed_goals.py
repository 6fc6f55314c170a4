"""What docs/speed.md says below its tables: each goal that is not met, with its reason, and no other."""

from __future__ import annotations

import pytest

from tests.benchmarks.speed_goals import GOALS, goal_of, not_met

LONG = "prove 1,000,000 blocks"


@pytest.mark.parametrize(
    ("figure", "told"),
    [((1.2, 200.0), False), ((1.21, 150.0), True), ((1.0, 201.0), True), ((1.0,), False)],
)
def test_time_or_memory_over_the_goal_is_told(figure: tuple[float, ...], told: bool) -> None:
    assert list(not_met({LONG: figure})) == ([f"{LONG}: {GOALS[LONG].why}."] if told else [])


def test_a_row_without_a_goal_is_never_told_and_shows_none() -> None:
    assert list(not_met({"bare interpreter": (99.0, 999.0)})) == []
    assert (goal_of("bare interpreter", "{:.2f}"), goal_of("window usable", "{:.2f}")) == ("–", "0.50")


@pytest.mark.parametrize("name", GOALS)
def test_every_goal_has_its_reason(name: str) -> None:
    assert GOALS[name].most > 0.0
    assert len(GOALS[name].why) > 20
