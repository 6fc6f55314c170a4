"""Setup of measured parts and trends, and of the MEASURED PARTS row in the F10 list."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import TableRow
from app.desk.status.formats import NO_VALUE
from app.desk.translation import tr
from app.extras.quality.parts_data import BOOK_KEY, get_loaded_parts_data, read_parts_data
from app.extras.quality.sample_plan import SamplePlan
from app.production.parts_watch import ProductionMonitor
from app.special.special_functions import SeparatePageFunction, SpecialFunction, SpecialFunctionsModel
from core.machine.machine_model import Machine

MEASURED_PARTS_PAGE = "MEASURED PARTS"  # name of the page in app.screen.page_table


class MeasuredPartsFunction(SeparatePageFunction):
    """Special function that shows the numbers of features and readings, and the measurements due."""

    name = "MEASURED PARTS"
    use = "features, readings, charts, trends"
    page = MEASURED_PARTS_PAGE
    key_hint = "Press Enter to open the page, or press W in the main menu."

    def make_information_rows(self) -> tuple[TableRow, ...]:
        """Return rows with the numbers of features and readings, and with the measurements that are due."""
        watch = self.desk.page_registry.find_model(ProductionMonitor)
        if watch is None or watch.production_records.lock_reason:
            return (
                TableRow(
                    (tr("STORED"), watch.production_records.lock_reason if watch is not None else NO_VALUE)
                ),
            )
        data = get_loaded_parts_data(watch.production_records)
        return (
            TableRow((tr("FEATURES"), str(len(data.features)))),
            TableRow((tr("READINGS"), str(len(data.readings)))),
            TableRow((tr("MEASUREMENT DUE"), watch.find_reminder() or NO_VALUE)),
        )

    def prompt_text(self) -> str:
        """Return the prompt that explains the keys."""
        return "ENTER: OPEN MEASURED PARTS   ESC: BACK TO LIST"


def attach_quality(desk: Desk, machine: Machine) -> None:
    """Attach measured parts to TurnDesk if production data are available."""
    watch = desk.page_registry.find_model(ProductionMonitor)
    if watch is None:
        return
    watch.production_records.feature_readers[BOOK_KEY] = read_parts_data
    plan = SamplePlan(desk, watch)
    watch.production_plans.append(plan)
    desk.page_registry.attach_model(
        QualitySectionList(lambda: _sections(desk, machine, watch, plan), watch.production_records.worker)
    )


def _sections(
    desk: Desk, machine: Machine, watch: ProductionMonitor, plan: SamplePlan
) -> Sequence[SpecialFunction]:
    """Return the sections of the MEASURED PARTS page.

    The sections are imported at the first call, so that TurnDesk starts faster.
    """
    from app.extras.quality.sections_setup import make_sections

    return make_sections(desk, machine, watch, plan)


SectionFactory = Callable[[], Sequence[SpecialFunction]]


class QualitySectionList(SpecialFunctionsModel):
    """List of the sections of the MEASURED PARTS page.

    Readings of a gauge are used only while the readings section is displayed.
    """

    __slots__ = ("_made", "_make")

    def __init__(self, make_sections: SectionFactory, worker: LatestRequestWorker) -> None:
        self._make = make_sections
        self._made: Sequence[SpecialFunction] = ()
        super().__init__((), worker)

    @property
    def functions(self) -> Sequence[SpecialFunction]:
        """Return the sections of the MEASURED PARTS page.

        They are created when this property is first read, so that TurnDesk starts faster.
        """
        if not self._made:
            self._made = tuple(self._make())
        return self._made

    @functions.setter
    def functions(self, _none: Sequence[SpecialFunction]) -> None:
        """Ignore the value, because the sections are created by the getter."""

    def process_worker_results(self) -> None:
        """Process received gauge readings. This method is called once per frame.

        A reading belongs to the feature that is displayed when the reading arrives.
        """
        for section in self.functions:
            section.process_device_input(is_displayed=section is self.shown_function)

    def on_open(self) -> None:
        """Open the page and discard earlier gauge readings, because their parts are unknown."""
        super().on_open()
        for section in self.functions:
            section.process_device_input(is_displayed=False)

    def close(self) -> None:
        """Finish pending work of the sections.

        The worker continues to run, because it belongs to the parts book.
        """
        for function in self._made:
            function.close()
