"""Settings that are kept, and those that somebody has spoilt."""

from __future__ import annotations

import pytest

from app.desk.persistence import Persistence
from app.desk.screen_settings import KEY, Settings, SettingsBook, Units


def test_a_choice_is_kept() -> None:
    keep = Persistence()
    SettingsBook(keep).choose("theme", "light")
    assert SettingsBook(keep).now == Settings(theme="light")


@pytest.mark.parametrize("kept", [{"theme": "pink"}, {"dock": 1}, {"nothing": 2}, ["dark"], "dark", None, 7])
def test_what_is_no_choice_is_forgotten(kept: object) -> None:
    assert SettingsBook(Persistence({KEY: kept})).now == Settings()


@pytest.mark.parametrize(("name", "value"), [("theme", "pink"), ("colour", "dark"), ("dock", 1)])
def test_what_is_no_choice_is_refused(name: str, value: object) -> None:
    book = SettingsBook()
    with pytest.raises(ValueError, match=name):
        book.choose(name, value)
    assert book.now == Settings()


@pytest.mark.parametrize(
    ("units", "control", "metric"),
    [
        (Units.PROGRAM, True, True),
        (Units.PROGRAM, False, False),
        (Units.INCH, True, False),
        (Units.METRIC, False, True),
    ],
)
def test_units_of_the_figures(units: Units, control: bool, metric: bool) -> None:
    assert units.metric(control) is metric
