"""Two palms and a pot, as a person and as a control take them."""

from __future__ import annotations

import pytest

from app.desk.station_controls import OverridePot, PalmButtons


@pytest.mark.parametrize(("gap", "together"), [(0.0, True), (0.5, True), (0.51, False), (3.0, False)])
def test_palm_presses_must_be_within_half_a_second(gap: float, together: bool) -> None:
    palms = PalmButtons()
    assert palms.record_press("left", 10.0) is False
    assert palms.record_press("right", 10.0 + gap) is together


def test_auto_repeat_of_a_palm_press_retains_its_first_time() -> None:
    palms = PalmButtons()
    palms.record_press("left", 0.0)
    palms.record_press("left", 2.0)
    assert palms.record_press("right", 2.1) is False


def test_single_palm_is_reported_and_a_valid_pair_is_not() -> None:
    palms = PalmButtons()
    palms.record_press("left", 0.0)
    assert palms.record_release("left") is True
    palms.record_press("left", 1.0)
    palms.record_press("right", 1.2)
    assert palms.record_release("left") is False
    assert palms.record_release("right") is False
    palms.record_press("right", 5.0)
    assert palms.record_release("right") is True


def test_releasing_a_palm_that_is_not_pressed_does_nothing() -> None:
    assert PalmButtons().record_release("left") is False


def test_override_pot_moves_gradually_to_its_target() -> None:
    pot = OverridePot(1.5)
    pot.set(0.2)
    assert pot.turn_toward_target(0.1) is True
    assert pot.current_fraction == pytest.approx(0.9)
    for _ in range(20):
        pot.turn_toward_target(0.1)
    assert pot.current_fraction == 0.2
    assert pot.turn_toward_target(0.1) is False


@pytest.mark.parametrize(("asked", "stands"), [(9.0, 1.5), (-1.0, 0.0)])
def test_override_pot_is_limited_at_both_ends(asked: float, stands: float) -> None:
    pot = OverridePot(1.5)
    pot.set(asked)
    assert pot.wanted == stands
