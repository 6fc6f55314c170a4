"""Measured parts and trends of a desk: put together, given to it; their entry in the special functions."""

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

PAGE = "MEASURED PARTS"  # its name in app.screen.page_table


class MeasuredPartsFunction(PageFunction):
    """Features and readings of the program, and what is to be done some time soon."""

    name = "MEASURED PARTS"
    use = "features, readings, charts, trends"
    page = PAGE
    way = "Press Enter to open the page, or press W in the main menu."

    def facts(self) -> tuple[Row, ...]:
        """How many there are, and what is due."""
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
        """How the page is opened."""
        return "ENTER: OPEN MEASURED PARTS   ESC: BACK TO LIST"


def attach_quality(desk: Desk, machine: Machine) -> None:
    """Give the desk what it measures and remembers of parts."""
    watch = desk.pages.find(PartsWatch)
    if watch is None:
        return
    watch.book.readers[FEATURE] = parts_data
    plan = SamplePlan(desk, watch)
    watch.plans.append(plan)
    desk.pages.attach(QualityFunctions(lambda: _sections(desk, machine, watch, plan), watch.book.worker))


def _sections(desk: Desk, machine: Machine, watch: PartsWatch, plan: SamplePlan) -> Sequence[SpecialFunction]:
    """Those of the page: the start of the desk is not delayed by loading them."""
    from app.extras.quality.sections_desk import sections

    return sections(desk, machine, watch, plan)


Make = Callable[[], Sequence[SpecialFunction]]


class QualityFunctions(SpecialFunctions):
    """As the special functions are; what a gauge sends counts while the section of readings is shown."""

    __slots__ = ("_made", "_make")

    def __init__(self, make: Make, worker: Latest) -> None:
        self._make = make
        self._made: Sequence[SpecialFunction] = ()
        super().__init__((), worker)

    @property
    def functions(self) -> Sequence[SpecialFunction]:
        """The sections; the start of the desk does not wait for them."""
        if not self._made:
            self._made = tuple(self._make())
        return self._made

    @functions.setter
    def functions(self, _none: Sequence[SpecialFunction]) -> None:
        """They are made here and nowhere else."""

    def look(self) -> None:
        """Once a frame: of which feature and part a reading is must be seen when it comes."""
        for section in self.functions:
            section.listen(seen=section is self.current)

    def opened(self) -> None:
        """The page comes up: what a gauge has sent meanwhile is of nobody knows which part."""
        super().opened()
        for section in self.functions:
            section.listen(seen=False)

    def close(self) -> None:
        """End what a section has under way; the worker is the book's."""
        for function in self._made:
            function.close()
