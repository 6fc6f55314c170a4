"""Measured parts in the list of special functions, F10: what is due, and the way to the page."""

from __future__ import annotations

from app.desk.pages.sheet import Row
from app.desk.status.formats import NOTHING
from app.desk.translation import tr
from app.extras.quality.parts_data import parts_of
from app.production.parts_watch import PartsWatch
from app.special.special_functions import PageFunction

PAGE = "MEASURED PARTS"  # its name in app.screen.page_table


class MeasuredPartsFunction(PageFunction):
    """Features and readings of the program, and what is to be done some time soon."""

    name = "MEASURED PARTS"
    use = "features, readings, charts, trends"
    page = PAGE
    way = "Press Enter to open the page, or press W in the main menu."

    def facts(self) -> tuple[Row, ...]:
        """How many there are, and what is due."""
        watch = self.desk.attached(PartsWatch)
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
