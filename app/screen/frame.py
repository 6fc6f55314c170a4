"""The frame of the main window: what is always visible, and one page at a time in the room that is left."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.desk import formats, pages
from app.desk.desk import Desk
from app.desk.lamps import Lamp
from app.desk.session import Loaded
from app.desk.view import View
from app.screen.bars import FunctionKeys, PromptLine, TitleLine
from app.screen.dock import StationDock
from app.screen.gauges import FeedGauge, SpindleGauge, TimesGauge, ToolGauge
from app.screen.head import HeadLine
from app.screen.layout import Places, Rect, low_places, places, unit, work_of
from app.screen.look import Look
from app.screen.maker import MAKERS
from app.screen.overlay import AlarmList, Notice
from app.screen.page import AutomaticPage
from app.screen.pages import Host, Page
from app.screen.position import PositionPanel
from app.screen.runline import RunLine
from app.screen.strip import Strip
from core.executor.snapshot import Snapshot, State


class Frame(QWidget):
    """Polls nothing itself: ``refresh`` is called once a frame.

    The Automatic page has large readouts above it, every other page the same figures in one low row.
    """

    def __init__(self, look: Look, desk: Desk, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self.look, self.desk = look, desk
        self.title = TitleLine(look, self)
        self.head = HeadLine(look, self)
        self.run = RunLine(look, self)
        self.position = PositionPanel(look, self)
        self.feed = FeedGauge(look, "FEED", self)
        self.spindle = SpindleGauge(look, "SPINDLE", self)
        self.tool = ToolGauge(look, "TOOL  ·  OFFSET", self)
        self.times = TimesGauge(look, "PARTS  ·  TIME", self)
        self.strip = Strip(look, press, self)
        self.dock = StationDock(look, desk, self) if desk.station else None
        self.prompt = PromptLine(look, self)
        self.keys = FunctionKeys(look, lambda number: press(f"F{number}"), self)
        host = Host(look, desk, press, self.go, self._close_log)
        self._host = host
        self.automatic = AutomaticPage(host, self)
        self._pages: dict[str, Page] = {pages.AUTOMATIC: self.automatic}
        self.page: Page = self.automatic
        self.notice = Notice(look, self)
        self.log = AlarmList(look, self)
        self._docked = True
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
        width, height = self.width(), self.height()
        self.look.resize(unit(width, height))
        large = self.page is self.automatic
        with_dock = self.dock is not None and self.desk.settings.now.dock
        at, low = places(width, height, with_dock), low_places(width, height, with_dock)
        self._docked = with_dock
        over = at.path if large else low.work
        self._stand_readouts(at, large)
        for part, rect in ((self.head, low.head), (self.run, low.run)):
            _stand(part, rect)
            part.setVisible(not large)
        if self.dock is not None:
            self.dock.let_go()
            self.dock.setVisible(with_dock)
            _stand(self.dock, at.dock)
        _stand(self.title, at.title)
        _stand(self.strip, at.strip if large else low.strip)
        _stand(self.prompt, at.prompt)
        _stand(self.keys, at.keys)
        _stand(self.notice, over)
        _stand(self.log, over)
        _stand(self.page, work_of(at) if large else low.work)

    def _stand_readouts(self, at: Places, large: bool) -> None:
        parts: tuple[tuple[QWidget, Rect], ...] = (
            (self.position, at.position),
            (self.feed, at.feed),
            (self.spindle, at.spindle),
            (self.tool, at.tool),
            (self.times, at.times),
        )
        for part, rect in parts:
            _stand(part, rect)
            part.setVisible(large)

    # --- what is shown -------------------------------------------------------------------------------

    def refresh(self) -> None:
        """Take one snapshot and show it everywhere."""
        snapshot, view, loaded = self.desk.look()
        if self.dock is not None and self._docked is not self.desk.settings.now.dock:
            self._lay_out()
        self._show_bars(snapshot, view, loaded)
        lamps = self._lamps(snapshot, view)
        self.strip.show_lamps(lamps, frozenset(lamp.key for lamp in lamps if self._is_text(lamp.key)))
        if self.page is self.automatic:
            self._show_large(snapshot, view, loaded)
            self.notice.show_notice(view.message, self.desk.start_words + " TO GO ON", view.alarm)
        else:
            self.head.show_view(view)
            self.run.show_run(view, self._times(snapshot, view, loaded))
            self.notice.show_notice("", "", None)  # the prompt line tells it: nothing covers an entry
        self.log.show_entries(self.desk.log.entries)
        if self.dock is not None:
            self.dock.show_station(snapshot)
        self.page.refresh(snapshot, view, loaded)
        self.keys.show_labels(self.page.labels())

    def _is_text(self, key: str) -> bool:
        """Whether a key goes to an entry now: to that of the page, or to a field that has the keyboard."""
        if self.page.takes(key):
            return True
        at = QApplication.focusWidget()
        if at is None or at is self.window() or at.focusPolicy() is Qt.FocusPolicy.NoFocus:
            return False
        return self.isAncestorOf(at)

    def _show_large(self, snapshot: Snapshot, view: View, loaded: Loaded) -> None:
        self.position.show_position(view.position)
        self.feed.show_value(view.feed)
        self.spindle.show_value(view.spindle)
        self.tool.show_value((view.tool, view.secondary))
        self.times.show_value(self._times(snapshot, view, loaded))

    def _show_bars(self, snapshot: Snapshot, view: View, loaded: Loaded) -> None:
        desk = self.desk
        name = view.program or loaded.name
        self.title.show_page(self.page.NAME)
        self.title.show_state(name, view.state, view.tone, desk.machine, desk.time_of_day())
        text = desk.prompt(snapshot, loaded, self.page.prompt())
        self.prompt.show_text(text, answer=bool(desk.notice))

    def _times(self, snapshot: Snapshot, view: View, loaded: Loaded) -> tuple[tuple[str, str], ...]:
        left = formats.duration(self.desk.time_left(snapshot, loaded))
        return (
            ("PARTS", self.desk.counter.words),
            ("CYCLE", view.cycle),
            ("LEFT", left),
            ("LAST", view.last_cycle),
        )

    def _lamps(self, snapshot: Snapshot, view: View) -> tuple[Lamp, ...]:
        on = snapshot.state not in {State.ESTOP, State.DISABLED}
        return (*view.modes, *view.lamps, Lamp("DRIVES ON", on, "D"), Lamp("RESET", False, "R"))


def _stand(part: QWidget, rect: Rect) -> None:
    part.setGeometry(*rect)
    part.update()
