"""Setup of the sections of the MEASURED PARTS page.

This module is imported after TurnDesk has started.
"""

from __future__ import annotations

from collections.abc import Sequence

from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.extras.quality.charts_and_trends import ChartsSection, TrendsSection
from app.extras.quality.features_section import FeaturesSection
from app.extras.quality.gauge_table import GaugeModel
from app.extras.quality.readings_section import ReadingsSection
from app.extras.quality.sample_plan import SamplePlan
from app.extras.quality.serial_gauge import SerialGauge
from app.production.parts_watch import ProductionMonitor
from app.special.counter_functions import ToolLifeFunction
from app.special.special_functions import SpecialFunction
from core.machine.machine_model import Machine


def make_sections(
    desk: Desk, machine: Machine, watch: ProductionMonitor, sample_plan: SamplePlan
) -> Sequence[SpecialFunction]:
    """Return the sections of the MEASURED PARTS page in display order.

    The section for tool life exists only on a lathe.
    """
    model = machine.hardware.find_driver_table(GaugeModel)
    gauge = SerialGauge(model) if model is not None else None
    # a mill has tool life in its tool table
    lives = () if machine.kind == "mill" else (ToolLifeFunction(desk, watch),)
    return (
        FeaturesSection(desk, watch, sample_plan),
        ReadingsSection(desk, watch, find_data_folder() / "parts", gauge),
        ChartsSection(desk, watch),
        *lives,
        TrendsSection(desk, watch),
    )
