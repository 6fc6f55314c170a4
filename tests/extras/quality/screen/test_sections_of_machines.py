"""The sections of measured parts on a lathe, a SINUMERIK lathe and a mill."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.desk_assembly import desk_and_executor
from app.compose.stored_offsets import read_offsets
from app.compose.workshop import samples
from app.extras.quality.charts_and_trends import TrendsSection
from app.extras.quality.features_section import FeaturesSection
from app.extras.quality.quality_desk import QualityFunctions
from app.screen.page_table import menu_keys
from drivers.waiting import StepClock
from tests.attached import attached


def test_a_feature_is_corrected_by_what_this_machine_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """D offsets are OmniTurn's, wear a lathe's; a mill's tool life is in its tool table."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    found = {}
    for name in ("gt75", "sinumerik-live", "ac-table-mill"):
        desk, _executor = desk_and_executor(
            name, lambda: read_offsets(samples() / "offsets.toml"), StepClock()
        )
        pages = attached(desk, QualityFunctions)
        features, readings, *_, trends = pages.functions
        assert isinstance(features, FeaturesSection)
        assert isinstance(trends, TrendsSection)
        names = [each.name for each in pages.functions]
        found[name] = (
            "CORRECTED BY" in features.fields,
            "TOOL OR OFFSET NUMBER" in features.fields,
            "F8" in dict(readings.keys()),
            "TOOL LIFE" in names,
            "WEAR" in trends.kinds,
        )
        desk.close()
    assert found == {
        "gt75": (True, True, True, True, True),
        "sinumerik-live": (False, True, True, True, True),
        "ac-table-mill": (False, False, False, False, False),
    }
    assert "W" in menu_keys("klartext")
