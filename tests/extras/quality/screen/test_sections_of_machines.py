"""The sections of measured parts on a lathe, a SINUMERIK lathe and a mill."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.program_proving import get_samples_folder
from app.compose.stored_offsets import read_offsets_file
from app.extras.quality.charts_and_trends import TrendsSection
from app.extras.quality.features_section import FeaturesSection
from app.extras.quality.quality_setup import QualitySectionList
from app.screen.page_table import map_menu_keys
from drivers.wakeups import ManualClock
from tests.attached import attached


def test_correction_choices_depend_on_the_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """D offsets are OmniTurn's, wear a lathe's; a mill's tool life is in its tool table."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    found = {}
    for name in ("gt75", "sinumerik-live", "ac-table-mill"):
        desk, _executor = create_desk_and_executor(
            name, lambda: read_offsets_file(get_samples_folder() / "offsets.toml"), ManualClock()
        )
        pages = attached(desk, QualitySectionList)
        features, readings, *_, trends = pages.functions
        assert isinstance(features, FeaturesSection)
        assert isinstance(trends, TrendsSection)
        names = [each.name for each in pages.functions]
        found[name] = (
            "CORRECTED BY" in features.field_names,
            "TOOL OR OFFSET NUMBER" in features.field_names,
            "F8" in dict(readings.make_function_keys()),
            "TOOL LIFE" in names,
            "WEAR" in trends.trend_names,
        )
        desk.close()
    assert found == {
        "gt75": (True, True, True, True, True),
        "sinumerik-live": (False, True, True, True, True),
        "ac-table-mill": (False, False, False, False, False),
    }
    assert "W" in map_menu_keys("klartext")
