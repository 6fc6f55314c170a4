"""The frame of the main window: the parts that are always visible, and one page at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QApplication, QLineEdit, QPlainTextEdit, QWidget

from app.automatic.automatic_view import AutomaticPage
from app.desk.desk import Desk
from app.desk.pages.first_job import CLOSE
from app.desk.programs.program_loading import Loaded
from app.desk.status import formats, prompt_line
from app.desk.status.interrupted_notice import NoticeRow, may_go_on, notice_of, unheard_notice
from app.desk.status.machine_status import MachineStatus
from app.desk.status.readouts import Lamp, drives_lamp
from app.desk.status.standing_prompt import prompt, time_left
from app.desk.translation import tr
from app.screen import page_table
from app.screen.look import Look
from app.screen.page_base import Host, KeyActions, Page
from app.screen.page_table import make_page, page_on
from app.screen.panel import Panel
from app.screen.window.alarm_panels import AlarmList, Notice
from app.screen.window.keys import OF_AUTOMATIC
from app.screen.window.readout_panels import (
    FeedGauge,
    HeadLine,
    PositionPanel,
    RunLine,
    SpindleGauge,
    TimesGauge,
    ToolGauge,
)
from app.screen.window.station_dock import StationDock
from app.screen.window.window_bars import FunctionKeys, LampStrip, NoticeRows, PromptLine, TitleLine
from app.screen.window_layout import Places, Rect, low_places, places, unit, work_of
from core.executor.snapshot import Snapshot, State
from core.message import Message

_SEARCHTO, _FROM_LINE_1 = ("F6", "SEARCHTO"), ("Y", "FROM LINE 1")
GAP = 4  # Pixels below the notice rows.
_RESTING = frozenset({State.ESTOP, State.DISABLED, State.IDLE, State.FAULT})
STALE = 0.45  # Seconds after which everything is refreshed even without a visible change.
_SETTLED = 3.0  # Seconds after a manual move before the layout of a page may change.


Face = tuple[str, bool, bool, str]


class Frame(QWidget):
    """The fixed parts of the window and the current page. ``refresh`` is called once a frame.

    The Automatic page has large readouts above it. All other pages have the same values in one row.
    """

    def __init__(self, look: Look, desk: Desk, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self.look, self.desk = look, desk
        self.at_rest = False  # Nothing moves on the machine.
        self._shown: tuple[Snapshot, Loaded] | None = None  # Snapshot and program that were shown last.
        self._shown_at, self._paints = 0.0, 0
        self.title = TitleLine(look, self)
        self.head = HeadLine(look, self)
        self.run = RunLine(look, self)
        self.position = PositionPanel(look, self)
        self.feed = FeedGauge(look, "FEED", self)
        self.spindle = SpindleGauge(look, "SPINDLE", self)
        is_mill = desk.machine.language == "klartext"
        self.tool = ToolGauge(look, "TOOL" if is_mill else "TOOL  ·  OFFSET", self)
        self.times = TimesGauge(look, "PARTS  ·  TIME", self)
        self.strip = LampStrip(look, press, self)
        self.notices = NoticeRows(look, press, self)
        self.dock = StationDock(look, desk, self) if desk.control.panel else None
        self.prompt = PromptLine(look, press, self)
        self.keys = FunctionKeys(look, lambda number: press(f"F{number}"), self)
        self.notice = Notice(look, self)
        self.log = AlarmList(look, self.open_record, self)
        self._docked = True
        host = Host(look, desk, press, self.go, self.log.hide)
        self._host = host
        self._before_scope = page_table.AUTOMATIC
        self._moved_at: float | None = None  # Time of the last manual move.
        self.automatic = AutomaticPage(host, self)
        self._pages: dict[str, Page] = {page_table.AUTOMATIC: self.automatic}
        self.page: Page = self.automatic
        self.notice.raise_()
        self.log.raise_()
        self._front()

    # --- pages ---------------------------------------------------------------------------------------

    def go(self, name: str) -> bool:
        """Open a page. Return False if the page cannot open or the current page cannot close."""
        name = page_on(self.desk.machine.language, name)
        if name == self.page.NAME:
            return True
        page = self.page_named(name)
        if not page.opens() or not self.page.leave():
            return False
        self.desk.hands.let_go()
        self.page.hide()
        self.page = page
        self._front()
        return True

    def page_named(self, name: str) -> Page:
        """Return the page with this name. It is created at the first call and hidden until it is opened."""
        page = self._pages.get(name) or make_page(name, self._host, self)
        self._pages[name] = page
        return page

    def open_record(self, name: str) -> None:
        """Open the recording of an alarm in the scope."""
        before = self.page.NAME
        if before == page_table.SCOPE or self.go(page_table.SCOPE):
            self._before_scope = self._before_scope if before == page_table.SCOPE else before
            self.log.hide()
            self.desk.pages.open_record(name)

    def toggle_scope(self) -> None:
        """Open the scope from any page, or return to that page."""
        if self.page.NAME == page_table.SCOPE:
            self.go(self._before_scope)
        else:
            before = self.page.NAME
            if self.go(page_table.SCOPE):
                self._before_scope = before

    def _front(self) -> None:
        page = self.page
        self.desk.window.show_page(starts=page.STARTS, has_field=self.has_field)
        self.keys.labels, self.keys.barred = page.labels(), page.barred()
        self._lay_out()
        self.log.hide()
        self.notice.stackUnder(self.log)
        page.stackUnder(self.notice)
        page.show()
        self.window().setFocus()
        page.opened()

    def key_actions(self) -> KeyActions:
        """Return the actions of all keys. Those of the page precede those of the frame."""
        return {
            "F1": partial(self.go, page_table.MENU),
            "F7": self.toggle_log,
            "Scope": self.toggle_scope,
            **{page.shortcut: partial(self.go, page.name) for page in page_table.PAGES if page.shortcut},
            CLOSE: partial(self.desk.choose_setting, "first_job", False),
            **self.page.key_actions(),
            **(self._log_keys() if self.log.isVisible() else {}),
        }

    def _log_keys(self) -> KeyActions:
        """Return the keys that scroll the alarm log while it covers the page."""
        log = self.log
        return {
            "Page up": lambda: log.scroll_by(-log.rows),
            "Page down": lambda: log.scroll_by(log.rows),
            "Pan up": lambda: log.mark(log.marked - 1),
            "Pan down": lambda: log.mark(log.marked + 1),
            "Scope": self._open_marked,
        }

    def _open_marked(self) -> None:
        """Open the recording of the selected log entry, or show that the entry has none."""
        name = self.log.record
        if name:
            self.open_record(name)
        else:
            self.desk.say(tr("NO SCOPE RECORD: ONLY ALARMS AND E-STOPS ARE RECORDED"))

    def toggle_log(self) -> None:
        """Show or hide the alarm log over the page."""
        self.log.setVisible(not self.log.isVisible())
        self.log.raise_()

    def escape(self) -> bool:
        """Close the alarm log or something on the page. Return False if nothing was open."""
        if self.log.isVisible():
            self.log.hide()
            return True
        return self.page.escape()

    def esc_holds(self) -> bool:
        """Return whether Esc starts feed hold while the machine moves and has no other function."""
        return not self.desk.asked and not self.log.isVisible() and self.page.esc_holds()

    @property
    def face(self) -> Face:
        """The screen state on which the meaning of a touch depends: the page, and what covers it."""
        return self.page.NAME, self.log.isVisible(), self.automatic.files.isVisible(), self.desk.asked

    def dress(self) -> None:
        """Redraw all parts in the present colors."""
        for page in self._pages.values():
            page.dress()
        for part in self.findChildren(QWidget):
            part.update()

    # --- layout --------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out all parts in the new unit."""
        self._lay_out()

    def _lay_out(self) -> None:
        stand(self.page, self._lay_parts(large=self.page is self.automatic))

    def _lay_parts(self, *, large: bool) -> Rect:
        """Lay out all parts for the present size, and return the rectangle of the page."""
        width, height = self.width(), self.height()
        self.look.resize(unit(width, height))
        with_dock = self.dock is not None and self.desk.settings.now.dock
        at = places(width, height, with_dock)
        low = low_places(width, height, with_dock, moves=self.page.STARTS)
        self._docked = with_dock
        work = work_of(at) if large else low.work
        rows = Rect(work.x, work.y, work.w, min(self.notices.take_room(), work.h // 3))
        work, over = _below(work, rows), _below(at.path if large else low.work, rows)
        stand(self.notices, rows)
        self.notices.setVisible(bool(rows.h))
        self._stand_readouts(at, large)
        for part, rect in ((self.head, low.head), (self.run, low.run)):
            stand(part, rect)
            part.setVisible(not large)
        if self.dock is not None:
            self.dock.let_go()
            self.dock.setVisible(with_dock)
            stand(self.dock, at.dock)
        stand(self.title, at.title)
        stand(self.strip, at.strip if large else low.strip)
        stand(self.prompt, at.prompt)
        stand(self.keys, at.keys)
        stand(self.notice, over)
        stand(self.log, over)
        return work

    @property
    def _dock_moved(self) -> bool:
        """Whether the operator has switched the station dock on or off since the last layout."""
        return self.dock is not None and self._docked is not self.desk.settings.now.dock

    def _stand_readouts(self, at: Places, large: bool) -> None:
        parts: tuple[tuple[QWidget, Rect], ...] = (
            (self.position, at.position),
            (self.feed, at.feed),
            (self.spindle, at.spindle),
            (self.tool, at.tool),
            (self.times, at.times),
        )
        for part, rect in parts:
            stand(part, rect)
            part.setVisible(large)

    def _by_hand(self, snapshot: Snapshot) -> bool:
        """Return whether the axes were jogged or homed in the last seconds, so that no target may move."""
        now = self.desk.hands.clock()
        if snapshot.state in {State.JOG, State.HOME}:
            self._moved_at = now
        return self._moved_at is not None and now - self._moved_at < _SETTLED

    # --- display -------------------------------------------------------------------------------------

    def changed(self) -> bool:
        """Return whether the machine, the program or a panel has changed since the last refresh."""
        shown, desk = self._shown, self.desk
        if shown is None or self._paints != Panel.paints:
            return True
        return shown[1] is not desk.session.now or not shown[0].tells_as(desk.snapshot())

    def aged(self) -> bool:
        """Return whether the last refresh was more than 0.45 s ago."""
        return self.desk.clock.seconds() - self._shown_at > STALE

    def refresh(self) -> None:
        """Poll one snapshot and show it in all parts."""
        snapshot, view, loaded = self.desk.look()
        self._shown, self._paints = (snapshot, loaded), Panel.paints
        self._shown_at = self.desk.clock.seconds()
        self.at_rest = snapshot.state in _RESTING and not snapshot.wheel
        self.notices.rows = self._notices_of(snapshot, loaded, here=self.page is self.automatic)
        by_hand = self._by_hand(snapshot)
        if self._dock_moved or (self.notices.other_room and not by_hand):
            self._lay_out()
        self._show_bars(snapshot, view, loaded)
        lamps = self._lamps_of(snapshot, view)
        self.strip.lamps = lamps
        self.strip.mute = frozenset(lamp.key for lamp in lamps if self._is_dead(lamp.key))
        if self.page is self.automatic:
            self._show_readouts(snapshot, view, loaded)
            go_on = tr(Message("{start} TO CONTINUE", start=tr(self.desk.start_words)))
            self.notice.show_notice(view.message, go_on, view.alarms)
        else:
            self.head.show_view(view)
            self.run.show_run(view, self._times_of(snapshot, view, loaded))
            # The prompt line shows the alarm, so that no notice covers an input field.
            self.notice.show_notice("", "")
        self.log.show_entries(self.desk.log.entries)
        if self.dock is not None:
            self.dock.show_station(snapshot)
            self.dock.mute = frozenset(key for key in "AHU," if self._is_dead(key))
        self.page.refresh(snapshot, view, loaded)
        self._show_caret()
        self.keys.labels, self.keys.barred = self.page.labels(), self.page.barred()

    def _show_caret(self) -> None:
        """Show the caret of the page's input field only while the field gets the characters."""
        has_field = self.page.has_field()
        if has_field is not self.look.caret:
            self.look.caret = has_field
            for panel in self.page.findChildren(Panel):
                panel.update()

    def _is_dead(self, key: str) -> bool:
        """Return whether the key of a lamp has no function on this page.

        A touch on the lamp works on every page.
        """
        elsewhere = key in OF_AUTOMATIC and self.page is not self.automatic
        return elsewhere or self.has_field() or self.is_text(key)

    def is_text(self, key: str) -> bool:
        """Return whether this character goes to an input field of the page or to a standard field."""
        return self.page.takes(key) or self._stock_field()

    def has_field(self) -> bool:
        """Return whether an input field has the keyboard, so that characters are text."""
        return self.page.has_field() or self._stock_field()

    def _stock_field(self) -> bool:
        at = QApplication.focusWidget()
        return isinstance(at, QLineEdit | QPlainTextEdit) and self.isAncestorOf(at)

    def _show_bars(self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded) -> None:
        desk = self.desk
        name = view.program or loaded.name
        self.title.page = self.page.NAME
        self.title.access = desk.access.words
        self.title.show_state(name, view.state, view.tone, desk.machine.name, desk.clock.time_of_day())
        state = prompt(desk, snapshot, loaded, self.page.prompt())
        self.prompt.show_state(state, prompt_line.reason(view) or prompt_line.remedy(loaded, state))
        self.prompt.show_question(desk.answers.question or self.page.asks(), desk.asked)
        self.prompt.show_answer(desk.answers.answer, sort=desk.answers.sort)

    def _show_readouts(self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded) -> None:
        """Show the values of this instant in the large displays."""
        self.position.view, self.feed.value, self.spindle.value = view.position, view.feed, view.spindle
        self.tool.value = (view.tool, view.secondary)
        self.times.value = self._times_of(snapshot, view, loaded)

    def _times_of(
        self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded
    ) -> tuple[tuple[str, str], ...]:
        """Return the part count and the times, as the run line shows them too."""
        left = formats.duration(time_left(snapshot, loaded))
        return (
            ("PARTS", self.desk.runs.counter.words),
            ("CYCLE", view.cycle),
            ("LEFT", left),
            ("LAST", view.last_cycle),
        )

    def _lamps_of(self, snapshot: Snapshot, view: MachineStatus) -> tuple[Lamp, ...]:
        """Return the lamps from left to right."""
        kept = (Lamp("NOT SAVED", lit=True, warn=True),) if self.desk.storage.problem() else ()
        return (*view.modes, *view.lamps, *kept, drives_lamp(snapshot, "D"), Lamp("RESET", False, "R"))

    def _notices_of(self, snapshot: Snapshot, loaded: Loaded, *, here: bool) -> tuple[NoticeRow, ...]:
        """Return the notices that remain until the operator acts.

        ``here``: the Automatic page is open, so the keys of the notices work.
        """
        desk, rows = self.desk, []
        unheard = unheard_notice(snapshot)
        if unheard is not None:
            rows.append(unheard)
        found = notice_of(snapshot, loaded, desk.settings.units)
        if found is not None:
            rows.append(replace(found, keys=self._keys_of(snapshot, loaded) if here else ()))
        if here and desk.settings.now.first_job:
            rows.append(desk.runs.first_job.row)
        differs = desk.storage.difference()
        if differs:
            rows.append(NoticeRow(differs))
        offered_job = desk.pages.offered_notice(snapshot) if here else None
        if offered_job is not None:
            rows.append(offered_job)
        if desk.storage.problem():
            held = desk.storage.waiting()
            waits = tr(Message("NOT SAVED YET: {what}. DO NOT EXIT TURNDESK NOW", what=held)) if held else ""
            rows.append(NoticeRow(tr(Message("NOT SAVED: {why}", why=desk.storage.problem())), waits))
        return tuple(rows)

    def _keys_of(self, snapshot: Snapshot, loaded: Loaded) -> tuple[tuple[str, str], ...]:
        """Return the keys for an interrupted job. A start that would be refused is not included."""
        if snapshot.state is not State.IDLE or not snapshot.interrupted_line:
            return ()
        searchto = (_SEARCHTO,) if may_go_on(loaded) else ()
        return searchto if self.desk.first_move_refusal(snapshot) else (*searchto, _FROM_LINE_1)


def _below(room: Rect, rows: Rect) -> Rect:
    """Return the part of a rectangle below the notice rows."""
    taken = rows.h + GAP if rows.h else 0
    return Rect(room.x, room.y + taken, room.w, room.h - taken)


def stand(part: QWidget, rect: Rect) -> None:
    """Set the geometry of a widget and redraw it."""
    part.setGeometry(*rect)
    part.update()
