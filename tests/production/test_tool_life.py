"""Lives by parts and minutes, by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from core.production.tool_life import ToolLife, ToolLifeError, ToolLifeState, check_tool_life
from tests.coded import raises_code


def test_remaining_parts_follow_part_limit() -> None:
    life = ToolLife(3, limit_parts=50)
    states = [replace(life, parts=parts).state for parts in (0, 44, 45, 49, 50, 51)]
    assert states == [
        ToolLifeState.OK,
        ToolLifeState.OK,
        ToolLifeState.WARNING,
        ToolLifeState.WARNING,
        *[ToolLifeState.USED_UP] * 2,
    ]
    assert replace(life, parts=49).remaining_part_count == 1
    assert replace(life, parts=60).remaining_part_count == 0


def test_remaining_parts_follow_minutes_limit_and_time_per_part() -> None:
    """30 min, 4 parts took 10: 2.5 min a part, 20 min make 8."""
    life = ToolLife(3, limit_seconds=1800, parts=4, seconds=600)
    assert life.share == pytest.approx(1 / 3)
    assert life.remaining_part_count == 8
    assert life.words == "10.0 of 30 min"


def test_nearer_limit_sets_remaining_parts() -> None:
    life = ToolLife(3, limit_parts=100, limit_seconds=600, parts=50, seconds=570)
    assert life.share == pytest.approx(0.95)
    assert (life.state, life.words) == (ToolLifeState.WARNING, "9.5 of 10 min")
    assert life.remaining_part_count == 3  # 30 s at 11.4 s a part
    assert replace(life, parts=99).words == "99 of 100 parts"


def test_life_without_limit_only_counts() -> None:
    life = ToolLife(3, parts=999, seconds=90)
    assert (life.state, life.share, life.remaining_part_count) == (ToolLifeState.NO_LIMIT, 0.0, None)
    assert life.words == "999 parts, 1.5 min"


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"limit_parts": -1}, "limit-in-parts"),
        ({"limit_parts": 10**7}, "limit-in-parts"),
        ({"limit_seconds": -1.0}, "limit-in-minutes"),
        ({"limit_seconds": math.inf}, "limit-in-minutes"),
        ({"limit_seconds": math.nan}, "limit-in-minutes"),
        ({"warn": 0.0}, "warning-share"),
        ({"warn": 1.1}, "warning-share"),
    ],
)
def test_invalid_tool_life_is_rejected(changes: dict[str, float], code: str) -> None:
    check_tool_life(ToolLife(3))
    with raises_code(ToolLifeError, code, "T3"):
        check_tool_life(replace(ToolLife(3), **changes))  # type: ignore[arg-type]
