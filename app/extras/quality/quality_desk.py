"""Setup of measured parts and trends, and their entry in the special functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Row
from app.desk.status.formats import NOTHING
from app.desk.translation import tr
from app.extras.quality.parts_data import FEATURE, parts_data, parts_of
from app.extras.quality.sample_plan import SamplePlan
from app.production.parts_watch import PartsWatch
from app.special.special_functions import PageFunction, SpecialFunction, SpecialFunctions
from core.machine.machine_model import Machine

PAGE = "MEASURED PARTS"  # name of the page in app.screen.page_table


class MeasuredPartsFunction(PageFunction):
    """Special function with the number of features and readings, and the measurements that are due."""

    name = "MEASURED PARTS"
    use = "features, readings, charts, trends"
    page = PAGE
    way = "Press Enter to open the page, or press W in the main menu."

    def facts(self) -> tuple[Row, ...]:
        """Return the rows with the numbers of features and readings, and the due measurements."""
        watch = self.desk.pages.find(PartsWatch)
        if watch is None or watch.book.locked:
            return (Row((tr("STORED"), watch.book.locked if watch is not None else NOTHING)),)
        data = parts_of(watch.book)
        return (
            Row((tr("FEATURES"), str(len(data.features)))),
            Row((tr("READINGS"), str(len(data.readings)))),
            Row((tr("MEASUREMENT DUE"), watch.due() or NOTHING)),
        )

    def prompt(self) -> str:
        """Return the prompt that names the keys."""
        return "ENTER: OPEN MEASURED PARTS   ESC: BACK TO LIST"


def attach_quality(desk: Desk, machine: Machine) -> None:
    """Attach measured parts to TurnDesk if production data is available."""
    watch = desk.pages.find(PartsWatch)
    if watch is None:
        return
    watch.book.readers[FEATURE] = parts_data
    plan = SamplePlan(desk, watch)
    watch.plans.append(plan)
    desk.pages.attach(QualityFunctions(lambda: _sections(desk, machine, watch, plan), watch.book.worker))


def _sections(desk: Desk, machine: Machine, watch: PartsWatch, plan: SamplePlan) -> Sequence[SpecialFunction]:
    """Return the sections of the page. Their import is deferred to keep the start fast."""
    from app.extras.quality.sections_desk import sections

    return sections(desk, machine, watch, plan)


Make = Callable[[], Sequence[SpecialFunction]]


class QualityFunctions(SpecialFunctions):
    """Sections of the page.

    Readings of a gauge count only while the section of readings is displayed.
    """

    __slots__ = ("_made", "_make")

    def __init__(self, make: Make, worker: Latest) -> None:
        self._make = make
        self._made: Sequence[SpecialFunction] = ()
        super().__init__((), worker)

    @property
    def functions(self) -> Sequence[SpecialFunction]:
        """Sections, created at the first access to keep the start fast."""
        if not self._made:
            self._made = tuple(self._make())
        return self._made

    @functions.setter
    def functions(self, _none: Sequence[SpecialFunction]) -> None:
        """Ignore the value, because the sections are created by the getter."""

    def look(self) -> None:
        """Poll the gauge once per frame.

        The feature that is displayed at that time determines the meaning of a reading.
        """
        for section in self.functions:
            section.listen(seen=section is self.current)

    def opened(self) -> None:
        """Open the page and discard readings received before, because their part is unknown."""
        super().opened()
        for section in self.functions:
            section.listen(seen=False)

    def close(self) -> None:
        """Finish pending work of the sections. The worker belongs to the parts book."""
        for function in self._made:
            function.close()
