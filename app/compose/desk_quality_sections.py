"""The sections of the page of measured parts, put together; loaded once the desk has started."""

from __future__ import annotations

from collections.abc import Sequence

from app.compose.gauge_wire import GaugeWire
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.quality.charts_section import ChartsSection
from app.quality.features_section import FeaturesSection
from app.quality.parts_watch import PartsWatch
from app.quality.readings_section import ReadingsSection
from app.quality.tool_life_section import ToolLifeSection
from app.quality.trends_section import TrendsSection
from app.special.special_functions import SpecialFunction
from core.machine.desk_tables import GaugeModel
from core.machine.machine_model import Machine


def sections(desk: Desk, machine: Machine, watch: PartsWatch) -> Sequence[SpecialFunction]:
    """Features, readings, charts, tool life (of a lathe) and trends, in the order of the page."""
    model = machine.hardware.table(GaugeModel)
    gauge = GaugeWire(model) if model is not None else None
    lives = () if machine.kind == "mill" else (ToolLifeSection(desk, watch),)  # columns of its tool table
    return (
        FeaturesSection(desk, watch),
        ReadingsSection(desk, watch, data_folder() / "parts", gauge),
        ChartsSection(desk, watch),
        *lives,
        TrendsSection(desk, watch),
    )
