"""The frame of the main window: what is always visible, and one page at a time in the room that is left."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QApplication, QLineEdit, QPlainTextEdit, QWidget

from app.desk import pages, prompts
from app.desk.desk import Desk
from app.desk.session import Loaded
from app.desk.view import View
from app.screen.frame_parts import FrameParts, stand
from app.screen.look import Look
from app.screen.maker import MAKERS
from app.screen.page import AutomaticPage
from app.screen.pages import Host, Page
from core.executor.snapshot import Snapshot, State

_SETTLED = 3.0  # s after a move by hand before the room of a page may change


class Frame(FrameParts):
    """Polls nothing itself: ``refresh`` is called once a frame.

    The Automatic page has large readouts above it, every other page the same figures in one low row.
    """

    def __init__(self, look: Look, desk: Desk, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(look, desk, press, parent)
        host = Host(look, desk, press, self.go, self._close_log)
        self._host = host
        self._moved_at: float | None = None  # when slides were last moved by hand
        self.automatic = AutomaticPage(host, self)
        self._pages: dict[str, Page] = {pages.AUTOMATIC: self.automatic}
        self.page: Page = self.automatic
        self.notice.raise_()
        self.log.raise_()
        self._front()

    # --- pages ---------------------------------------------------------------------------------------

    def go(self, name: str) -> bool:
        """Open a page; one that does not open now, or that does not let go, says so."""
        if name == self.page.NAME:
            return True
        page = self._pages.get(name) or MAKERS[name](self._host, self)
        self._pages[name] = page
        if not page.opens() or not self.page.leave():
            return False
        self.desk.hands.let_go()
        self.page.hide()
        self.page = page
        self._front()
        return True

    def _front(self) -> None:
        page = self.page
        self.desk.starts_here = page.STARTS
        self.keys.show_labels(page.labels())
        self._lay_out()
        self.log.hide()
        self.notice.stackUnder(self.log)
        page.stackUnder(self.notice)
        page.show()
        self.window().setFocus()
        page.opened()

    def doings(self) -> dict[str, Callable[[], None]]:
        """What keys do here: those of the page, before those of the frame."""
        return {
            "F1": partial(self._go, pages.MENU),
            "F7": self.toggle_log,
            **self.page.doings(),
            **(self._log_doings() if self.log.isVisible() else {}),
        }

    def _log_doings(self) -> dict[str, Callable[[], None]]:
        """Keys that look through the log while it lies over the page."""
        log = self.log
        return {
            "Page up": lambda: log.look_at(-log.rows),
            "Page down": lambda: log.look_at(log.rows),
        }

    def _go(self, name: str) -> None:
        self.go(name)

    def toggle_log(self) -> None:
        """The log of alarms over the page, or away again."""
        self.log.setVisible(not self.log.isVisible())
        self.log.raise_()

    def _close_log(self) -> None:
        self.log.hide()

    def escape(self) -> bool:
        """Close what lies over the page, or what is open in it; False when nothing was."""
        if self.log.isVisible():
            self.log.hide()
            return True
        return self.page.escape()

    def dress(self) -> None:
        """Everything in the colours that are in force now."""
        for page in self._pages.values():
            page.dress()
        for part in self.findChildren(QWidget):
            part.update()

    # --- places --------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Everything again, in the new unit."""
        self._lay_out()

    def _lay_out(self) -> None:
        stand(self.page, self.lay_parts(large=self.page is self.automatic))

    def _by_hand(self, snapshot: Snapshot) -> bool:
        """Whether slides were moved by hand a moment ago: no target may slip away under a finger then."""
        now = self.desk.hands.clock()
        if snapshot.state in {State.JOG, State.HOME}:
            self._moved_at = now
        return self._moved_at is not None and now - self._moved_at < _SETTLED

    # --- what is shown -------------------------------------------------------------------------------

    def refresh(self) -> None:
        """Take one snapshot and show it everywhere."""
        snapshot, view, loaded = self.desk.look()
        self.standing.show_rows(self.rows_of(snapshot, loaded, here=self.page is self.automatic))
        by_hand = self._by_hand(snapshot)
        if self.moved_dock or (self.standing.other_room and not by_hand):
            self._lay_out()
        self._show_bars(snapshot, view, loaded)
        lamps = self.lamps_of(snapshot, view)
        self.strip.show_lamps(
            lamps, frozenset(lamp.key for lamp in lamps if self.has_field() or self.is_text(lamp.key))
        )
        if self.page is self.automatic:
            self.show_readouts(snapshot, view, loaded)
            self.notice.show_notice(view.message, self.desk.start_words + " TO GO ON", view.alarms)
        else:
            self.head.show_view(view)
            self.run.show_run(view, self.times_of(snapshot, view, loaded))
            self.notice.show_notice("", "")  # the prompt line tells it: nothing covers an entry
        self.log.show_entries(self.desk.log.entries)
        if self.dock is not None:
            self.dock.show_station(snapshot)
        self.page.refresh(snapshot, view, loaded)
        self.keys.show_labels(self.page.labels())

    def is_text(self, key: str) -> bool:
        """Whether a character goes to an entry now: the page's, or a field that has the keyboard."""
        return self.page.takes(key) or self._stock_field()

    def has_field(self) -> bool:
        """Whether an entry has the keyboard: no character is a key then, but for those that stop."""
        return self.page.has_field() or self._stock_field()

    def _stock_field(self) -> bool:
        at = QApplication.focusWidget()
        return isinstance(at, QLineEdit | QPlainTextEdit) and self.isAncestorOf(at)

    def _show_bars(self, snapshot: Snapshot, view: View, loaded: Loaded) -> None:
        desk = self.desk
        name = view.program or loaded.name
        self.title.show_page(self.page.NAME)
        self.title.show_state(name, view.state, view.tone, desk.machine, desk.time_of_day())
        text = self.page.asks() or desk.prompt(snapshot, loaded, self.page.prompt())
        reason = prompts.reason(view) or prompts.remedy(loaded, text)
        self.prompt.show_text(text, answer=bool(desk.notice), asked=desk.asked, reason=reason)
