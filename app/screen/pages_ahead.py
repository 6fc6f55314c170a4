"""Pages ahead of their first opening: modules loaded by a worker, plots of charts made one a frame.

To import a page takes 10 to 110 ms of processor time, pyqtgraph 250: too much for a frame while a program
runs. So it is done once the desk has started and has nothing to load, before anybody opens the page.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from functools import partial

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.page_description import PageEntry
from app.desk.programs.program_loading import Phase
from app.screen.page_base import Page
from app.screen.page_table import class_of, load, pages_of

APART = 0.05  # s at least from one slice to the next: a frame between them has nothing of it
_LOADING = frozenset({Phase.READING, Phase.PROVING, Phase.DRAWING, Phase.PART})


class PagesAhead:
    """``step`` once a frame; attached to the desk, it ends with it."""

    def __init__(self, desk: Desk, page_of: Callable[[str], Page]) -> None:
        self._desk, self._page_of = desk, page_of
        self._worker = Latest("editing-pages")
        self._slices = self._all()
        self._next = desk.clock() + APART
        self.done = False

    def step(self) -> None:
        """One slice more, where there is one and the desk has time for it."""
        now = self._desk.clock()
        if self.done or now < self._next or self._desk.session.now.phase in _LOADING:
            return
        self._next = now + APART
        self._worker.poll()
        if not self._worker.busy and next(self._slices, True):
            self.done = True
            gc.freeze()  # modules: collections, which stop every thread, need not look at them again

    def close(self) -> None:
        """With the desk."""
        self.done = True
        self._worker.close()

    def _all(self) -> Iterator[bool]:
        """False for every slice: a page loaded, a part of its charts made."""
        for entry in pages_of(self._desk.language):
            found: list[None] = []
            self._worker.queue(partial(load, entry), found.append, lambda _why: None)
            yield False
            if found and entry.later and self._has_model(entry):
                page = self._page_of(entry.name)
                yield False
                while page.ahead():
                    yield False

    def _has_model(self, entry: PageEntry) -> bool:
        return not entry.model or self._desk.attached(class_of(entry.model)) is not None
