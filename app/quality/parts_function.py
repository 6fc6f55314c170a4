"""Measured parts in the list of special functions, F10: what is due, and the way to the page."""

from __future__ import annotations

from app.desk.formats import NOTHING
from app.desk.sheet import Row, Sheet
from app.desk.translation import tr
from app.quality.parts_watch import PartsWatch
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot

PAGE = "MEASURED PARTS"  # its name in app.screen.page_table


class MeasuredPartsFunction(SpecialFunction):
    """Return, or a finger, opens the page."""

    name = "MEASURED PARTS"
    use = "readings, charts, tool life, trends"
    page = PAGE

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Features and readings of the program, and what is to be done some time soon."""
        watch = self.desk.attached(PartsWatch)
        if watch is None or watch.book.locked:
            why = watch.book.locked if watch is not None else NOTHING
            return Sheet(tr("MEASURED PARTS"), ("", ""), (0.4, 0.6), (Row((tr("KEPT"), why)),))
        data = watch.book.now
        rows = (
            Row((tr("FEATURES"), str(len(data.features)))),
            Row((tr("READINGS"), str(len(data.readings)))),
            Row((tr("DUE"), watch.due() or NOTHING)),
        )
        notes = ("Return opens the page; W of the main menu does so too.",)
        return Sheet(tr("MEASURED PARTS"), ("", ""), (0.4, 0.6), rows, notes=notes)

    def prompt(self) -> str:
        """How the page is opened."""
        return "PRESS RETURN FOR THE MEASURED PARTS; ESC GOES BACK TO THE LIST"
