"""Measured parts, tool life and trends of a desk: put together and given to it."""

from __future__ import annotations

from collections.abc import Sequence

from app.compose.journal import Journal
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.quality.parts_book import NONE_KEPT, PartsBook
from app.quality.parts_watch import PartsWatch
from app.quality.quality_functions import QualityFunctions
from app.quality.tool_life_watch import ToolLifeWatch
from app.special.special_functions import SpecialFunction
from core.machine.gauge_table import GaugeModel
from core.machine.machine_model import Machine


def give_quality(desk: Desk, machine: Machine, journal: Journal | None) -> None:
    """Give the desk what it measures, counts and remembers of parts and inserts."""
    book = journal.parts_book() if journal is not None else PartsBook(locked=NONE_KEPT)
    watch = PartsWatch(desk, book, ToolLifeWatch(book))
    desk.attach(watch)
    desk.watches.append(watch)
    desk.attach(QualityFunctions(lambda: _sections(desk, machine, watch), book.worker))


def _sections(desk: Desk, machine: Machine, watch: PartsWatch) -> Sequence[SpecialFunction]:
    """Those of the page, loaded when it is first opened: the start of the desk is not delayed by them."""
    from app.compose.gauge_wire import GaugeWire
    from app.quality.charts_section import ChartsSection
    from app.quality.features_section import FeaturesSection
    from app.quality.readings_section import ReadingsSection
    from app.quality.tool_life_section import ToolLifeSection
    from app.quality.trends_section import TrendsSection

    model = machine.hardware.table(GaugeModel)
    return (
        FeaturesSection(desk, watch),
        ReadingsSection(
            desk, watch, data_folder() / "parts", GaugeWire(model) if model is not None else None
        ),
        ChartsSection(desk, watch),
        ToolLifeSection(desk, watch),
        TrendsSection(desk, watch),
    )
