"""Measured parts, tool life and trends of a desk: put together and given to it."""

from __future__ import annotations

from app.compose.gauge_wire import GaugeWire
from app.compose.journal import Journal
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.quality.charts_section import ChartsSection
from app.quality.features_section import FeaturesSection
from app.quality.parts_book import NONE_KEPT, PartsBook
from app.quality.parts_watch import PartsWatch
from app.quality.quality_functions import QualityFunctions
from app.quality.readings_section import ReadingsSection
from app.quality.tool_life_section import ToolLifeSection
from app.quality.tool_life_watch import ToolLifeWatch
from app.quality.trends_section import TrendsSection
from core.machine.gauge_table import GaugeModel
from core.machine.machine_model import Machine


def give_quality(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Give the desk what it measures, counts and remembers of parts and inserts."""
    book = journal.parts_book() if journal is not None else PartsBook(locked=NONE_KEPT)
    watch = PartsWatch(desk, book, ToolLifeWatch(book))
    desk.attach(watch)
    desk.watches.append(watch)
    model = machine.hardware.table(GaugeModel)
    gauge = GaugeWire(model) if model is not None else None
    sections = (
        FeaturesSection(desk, watch),
        ReadingsSection(desk, watch, data_folder() / "parts", gauge),
        ChartsSection(desk, watch),
        ToolLifeSection(desk, watch),
        TrendsSection(desk, watch),
    )
    desk.attach(QualityFunctions(sections, book.worker))
