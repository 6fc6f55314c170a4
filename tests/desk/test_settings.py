"""Settings that are kept, and those that somebody has spoilt."""

from __future__ import annotations

import pytest

from app.desk.persistence import Persistence
from app.desk.screen_settings import SETTINGS_KEY, DisplayUnits, ScreenSettings, SettingsStore


def test_chosen_setting_is_saved() -> None:
    keep = Persistence()
    SettingsStore(keep).choose("theme", "light")
    assert SettingsStore(keep).current_settings == ScreenSettings(theme="light")


@pytest.mark.parametrize("kept", [{"theme": "pink"}, {"dock": 1}, {"nothing": 2}, ["dark"], "dark", None, 7])
def test_invalid_saved_setting_is_ignored(kept: object) -> None:
    assert SettingsStore(Persistence({SETTINGS_KEY: kept})).current_settings == ScreenSettings()


@pytest.mark.parametrize(("name", "value"), [("theme", "pink"), ("colour", "dark"), ("dock", 1)])
def test_invalid_setting_is_rejected(name: str, value: object) -> None:
    book = SettingsStore()
    with pytest.raises(ValueError, match=name):
        book.choose(name, value)
    assert book.current_settings == ScreenSettings()


@pytest.mark.parametrize(
    ("units", "control", "metric"),
    [
        (DisplayUnits.PROGRAM, True, True),
        (DisplayUnits.PROGRAM, False, False),
        (DisplayUnits.INCH, True, False),
        (DisplayUnits.METRIC, False, True),
    ],
)
def test_display_units_follow_the_setting_or_the_control(
    units: DisplayUnits, control: bool, metric: bool
) -> None:
    assert units.metric(control) is metric
