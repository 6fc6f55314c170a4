"""Each rule at its point and one point short of it. Sigma is 1 and the centre 0 in all of them."""

from __future__ import annotations

import numpy as np
import pytest

from core.extras.quality.control_charts import CONTROL_RULES, ControlChart, find_rule_violations


def rules(points: list[float]) -> list[tuple[int, int]]:
    return [
        (each.point_index, each.rule_number)
        for each in find_rule_violations(ControlChart(np.asarray(points), 0.0, -3.0, 3.0))
    ]


@pytest.mark.parametrize(
    ("rule", "points"),
    [
        (1, [0.5, -3.1]),
        (2, [0.2, 0.3, 0.2, 0.3, 0.2, 0.3, 0.2, 0.3, 0.2]),
        (3, [-0.9, -0.5, -0.1, 0.1, 0.3, 0.6]),
        (3, [0.9, 0.5, 0.1, -0.1, -0.3, -0.6]),
        (4, [0.2, -0.2] * 7),
        (5, [2.1, 0.0, 2.5]),
        (5, [-2.1, -2.2]),
        (6, [1.2, 1.3, 0.0, 1.1, 1.4]),
        (7, [0.1, 0.1, -0.1, -0.1, 0.1] * 3),
        (8, [1.2, -1.2, -1.2, 1.2, 1.2, -1.2, -1.2, 1.2]),
    ],
)
def test_rule_violation_is_found_at_its_last_point(rule: int, points: list[float]) -> None:
    padded = [0.0, *points] if rule == 5 and len(points) == 2 else points
    assert (len(padded) - 1, rule) in rules(padded)
    assert rule not in {each for _, each in rules(padded[:-1])}, "one point short of it"


def test_normal_scatter_violates_no_rule() -> None:
    assert rules([0.4, -1.2, 0.9, -0.3, 1.6, -0.7, 0.1, -2.2, 0.8]) == []
    assert rules([3.0, -3.0]) == [], "on the limit is within it"
    assert rules([2.1, 0.0, -2.1]) == [], "two of three on different sides"
    assert rules([1.2, 1.3, 1.1, 1.4, 0.2]) == [], "the point itself has to lie out there"
    assert 2 not in {rule for _, rule in rules([0.2] * 4 + [0.0] + [0.2] * 4)}, "on the line is on no side"


def test_points_without_scatter_violate_no_rule() -> None:
    assert find_rule_violations(ControlChart(np.ones(30), 1.0, 1.0, 1.0)) == ()
    assert find_rule_violations(ControlChart(np.zeros(0), 0.0, -3.0, 3.0)) == ()


def test_each_rule_has_its_own_text() -> None:
    assert len({words for words, _ in CONTROL_RULES.values()}) == 8
    assert find_rule_violations(ControlChart(np.asarray([4.0]), 0, -3, 3))[0].rule_text == (
        "one point beyond a control limit"
    )
