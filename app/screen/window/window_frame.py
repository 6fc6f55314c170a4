"""The frame of the main window, with the parts that are always visible, and one page at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget

from app.automatic.automatic_view import AutomaticPage
from app.desk.desk import Desk
from app.desk.pages.first_job import CLOSE_KEY
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status import prompt_line
from app.desk.status.machine_status import MachineStatus
from app.desk.status.state_prompt import make_page_prompt
from app.desk.translation import tr
from app.screen import page_table
from app.screen.lists.search_bar import SearchBar
from app.screen.page_base import KeyActions, Page, PageHost
from app.screen.page_help import make_page_help
from app.screen.page_table import find_replacement_page, make_page
from app.screen.panel import Panel
from app.screen.screen_theme import ScreenTheme
from app.screen.text_area.text_area import TextArea
from app.screen.window.alarm_panels import AlarmList, AlarmNotice
from app.screen.window.help_panel import HelpPanel
from app.screen.window.key_table import AUTOMATIC_KEYS, HELP_KEY, SEARCH_KEY
from app.screen.window.notices import make_notices
from app.screen.window.part_placement import (
    LayoutNeeds,
    ManualMotion,
    find_area_below,
    find_layout_needs,
    make_lamp_row,
    make_times,
    needs_instruction,
    place_widget,
)
from app.screen.window.readout_panels import (
    FeedPanel,
    PositionPanel,
    ReadoutRow,
    SpindlePanel,
    TimesPanel,
    ToolPanel,
)
from app.screen.window.run_row import RunStatusRow
from app.screen.window.station_dock import StationDock
from app.screen.window.window_bars import FunctionKeyBar, LampStrip, NoticeRows, PromptLine, TitleLine
from app.screen.window_layout import (
    AutomaticLayout,
    Rect,
    find_position_row_count,
    find_work_area,
    make_automatic_layout,
    make_compact_layout,
)
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message

_REST_STATES = frozenset({MachineState.ESTOP, MachineState.DISABLED, MachineState.IDLE, MachineState.FAULT})
MAX_REFRESH_AGE_S = 0.45  # Seconds after which everything is refreshed even without a visible change.


ScreenContext = tuple[str, bool, bool, bool, bool, str]


class WindowFrame(QWidget):
    """The fixed parts of the window and the current page.

    ``refresh`` is called once a frame. Above the Automatic page, the readouts are large. Above all other
    pages, the same values are in one row.
    """

    def __init__(self, theme: ScreenTheme, desk: Desk, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self.theme, self.desk = theme, desk
        self.is_at_rest = False  # Nothing moves on the machine.
        self._shown: tuple[Snapshot, LoadedProgram] | None = None  # What was shown last.
        self._shown_at, self._paints = 0.0, 0
        self.title_line = TitleLine(theme, self)
        self.readout_line = ReadoutRow(theme, self)
        self.run_line = RunStatusRow(theme, self)
        self.position_panel = PositionPanel(theme, self)
        self.feed_panel = FeedPanel(theme, "FEED", self)
        self.spindle_panel = SpindlePanel(theme, "SPINDLE", self)
        is_mill = desk.machine.program_language == "klartext"
        self.tool_panel = ToolPanel(theme, "TOOL" if is_mill else "TOOL  ·  OFFSET", self)
        self.times_panel = TimesPanel(theme, "PARTS  ·  TIME", self)
        self.strip = LampStrip(theme, press, self)
        self.notice_rows = NoticeRows(theme, press, self)
        self.station_dock = StationDock(theme, desk, self) if desk.desk_control.station_panel else None
        self.prompt_line = PromptLine(theme, press, self)
        self.key_bar = FunctionKeyBar(theme, lambda number: press(f"F{number}"), self)
        self.alarm_notice = AlarmNotice(theme, self)
        self.alarm_list = AlarmList(theme, self.open_recording, self)
        self.help_panel = HelpPanel(theme, self)
        self.search_bar = SearchBar(theme, desk, press, self, self)
        self._page_area = Rect(0, 0, 0, 0)
        self._docked = True
        self._placed_needs: LayoutNeeds | None = None
        host = PageHost(theme, desk, press, self.open_page, self.alarm_list.close_list)
        self._host = host
        self._before_scope = page_table.AUTOMATIC
        self._manual_motion, self.has_recent_manual_motion = ManualMotion(), False
        self.automatic_page = AutomaticPage(host, self)
        self._pages: dict[str, Page] = {page_table.AUTOMATIC: self.automatic_page}
        self.current_page: Page = self.automatic_page
        self.alarm_notice.raise_()
        self.alarm_list.raise_()
        self._front()

    # --- pages ---------------------------------------------------------------------------------------

    def open_page(self, name: str) -> bool:
        """Open a page.

        Return False if the page cannot open or the current page cannot close.
        """
        name = find_replacement_page(self.desk.machine.program_language, name)
        if name == self.current_page.NAME:
            return True
        page = self.find_page(name)
        if not page.can_open() or not self.current_page.try_leave_page():
            return False
        self.desk.station_controls.release_all_buttons()
        self.search_bar.search.force_close()
        self.current_page.hide()
        self.current_page = page
        self._front()
        return True

    def find_page(self, name: str) -> Page:
        """Return the page with the given name.

        The page is created on the first call, and remains hidden until it is opened.
        """
        page = self._pages.get(name) or make_page(name, self._host, self)
        self._pages[name] = page
        return page

    def open_recording(self, recording_name: str) -> None:
        """Open the recording of an alarm in the scope, or show that the alarm has no recording."""
        if not recording_name:
            self.desk.say(tr("NO SCOPE RECORD: ONLY ALARMS AND E-STOPS ARE RECORDED"))
            return
        before = self.current_page.NAME
        if before == page_table.SCOPE or self.open_page(page_table.SCOPE):
            self._before_scope = self._before_scope if before == page_table.SCOPE else before
            self.alarm_list.close_list()
            self.desk.page_registry.open_recording(recording_name)

    def toggle_scope(self) -> None:
        """Open the scope from any page, or return from the scope to the previous page."""
        if self.current_page.NAME == page_table.SCOPE:
            self.open_page(self._before_scope)
        else:
            before = self.current_page.NAME
            if self.open_page(page_table.SCOPE):
                self._before_scope = before

    def _front(self) -> None:
        page = self.current_page
        self.help_panel.close_help()
        self.desk.window_state.set_page_properties(
            can_start=page.CAN_START_CYCLES, has_field=self._blocks_letters, page_name=page.NAME
        )
        self.key_bar.key_labels, self.key_bar.disabled_keys = (
            page.make_key_labels(),
            page.find_disabled_keys(),
        )
        self.arrange_parts()
        self.alarm_list.close_list()
        self.alarm_notice.stackUnder(self.alarm_list)
        page.stackUnder(self.alarm_notice)
        page.show()
        self.window().setFocus()
        page.on_open()

    def make_key_actions(self) -> KeyActions:
        """Return the actions of all keys.

        The actions of the page have priority over those of the frame.
        """
        return {
            "F1": partial(self.open_page, page_table.MENU),
            "F7": self.toggle_alarm_log,
            "Scope": self.toggle_scope,
            HELP_KEY: self.show_help,
            SEARCH_KEY: self.search_bar.open_search,
            **{
                page.shortcut_key: partial(self.open_page, page.name)
                for page in page_table.ALL_PAGES
                if page.shortcut_key
            },
            CLOSE_KEY: self.desk.close_card,
            **self.current_page.make_key_actions(),
            **(self.alarm_list.make_key_actions() if self.alarm_list.isVisible() else {}),
        }

    @property
    def is_page_covered(self) -> bool:
        """Return whether the alarm log or the search receives the keys instead of the page."""
        return self.alarm_list.isVisible() or self.search_bar.is_open

    @property
    def covers_text_field(self) -> bool:
        """Return whether the alarm log covers an open input field, so that characters have no function."""
        return self.is_page_covered and (
            self.current_page.has_text_field() or self.alarm_list.covers_focus_field
        )

    def uncover_page(self) -> None:
        """Close the help, the search, the alarm log and the file prompt."""
        self.search_bar.search.force_close()
        self.help_panel.close_help()
        self.alarm_list.close_list()
        self.automatic_page.file_prompt.close_prompt()

    def toggle_alarm_log(self) -> None:
        """Show or hide the alarm log over the page. The file prompt closes, because the log covers it."""
        if self.alarm_list.isVisible():
            self.alarm_list.close_list()
        else:
            self.automatic_page.file_prompt.close_prompt()
            self.alarm_list.open_list()

    def show_help(self) -> None:
        """Show the help about the page or the alarm log, or the next screenful if the help is open."""
        if not self.help_panel.isHidden():
            self.help_panel.show_next_screenful()
            return
        page = self.current_page
        blocks = make_page_help(
            page.NAME,
            page.find_marked_help(),
            is_log=self.alarm_list.isVisible(),
            alarm=self.alarm_list.find_explained_alarm(self.desk.read_snapshot().alarms),
        )
        if blocks:
            page.stop_held_key_actions()
            self.help_panel.open_help(blocks)
            self.help_panel.place_with_notice(self._page_area, self.alarm_notice)
        else:
            self.desk.say(tr("THE GUIDE IS NOT INSTALLED"))

    def handle_escape(self) -> bool:
        """Close the search, the alarm log or an open part of the page, and return whether one was open."""
        if self.search_bar.handle_escape():
            return True
        if self.alarm_list.isVisible():
            self.alarm_list.close_list()
            return True
        return self.current_page.handle_escape()

    def is_esc_stop_key(self) -> bool:
        """Return whether Esc starts feed hold while the machine moves.

        It does unless Esc has another function now.
        """
        return self.search_bar.is_discarding or (
            not self.desk.confirmation_key
            and not self.is_page_covered
            and self.current_page.is_esc_stop_key()
        )

    @property
    def screen_context(self) -> ScreenContext:
        """Return the state of the screen that determines the meaning of a touch.

        This state is the current page and the parts that cover the page.
        """
        return (
            self.current_page.NAME,
            self.alarm_list.isVisible(),
            self.help_panel.isVisible(),
            self.automatic_page.file_prompt.isVisible(),
            self.search_bar.is_open,
            self.desk.confirmation_key,
        )

    def apply_theme(self) -> None:
        """Redraw all parts in the current colors."""
        for page in self._pages.values():
            page.apply_theme()
        for part in self.findChildren(QWidget):
            part.update()

    # --- layout --------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Set the unit of size for the new size of the window, and arrange all parts."""
        self.arrange_parts()

    def arrange_parts(self) -> None:
        """Arrange all parts for the current size of the window and of the screen."""
        place_widget(self.current_page, self._place_parts())

    def _place_parts(self) -> Rect:
        """Arrange all parts for the current size, and return the rectangle of the page."""
        width, height, needs = self.width(), self.height(), self._layout_needs
        large = needs.has_automatic_layout
        self.theme.set_window_size(width, height)
        with_dock = self.station_dock is not None and self.desk.settings_store.current_settings.dock
        at = make_automatic_layout(width, height, with_dock, self.theme.screen)
        low = make_compact_layout(
            width,
            height,
            with_dock,
            self.theme.screen,
            has_axis_motion=needs.has_large_position,
            has_run_line=needs.has_run_line,
        )
        self._placed_needs = needs
        self.readout_line.has_axis_motion = needs.has_large_position
        self.readout_line.position_row_count = find_position_row_count(width, height)
        self._docked = with_dock
        work = find_work_area(at) if large else low.work_area
        most = work.h // (4 if needs.has_alarm_notice else 2)
        work = self.search_bar.place_below(work)
        self.current_page.is_searching = self.search_bar.is_open
        rows = Rect(work.x, work.y, work.w, min(self.notice_rows.apply_needed_height(), most))
        work = find_area_below(work, rows)
        place_widget(self.notice_rows, rows)
        self.notice_rows.setVisible(bool(rows.h))
        self._stand_readouts(at, large)
        for part, rect in ((self.readout_line, low.readout_line), (self.run_line, low.run_line)):
            place_widget(part, rect)
            part.setVisible(not large and rect.h > 0)
        if self.station_dock is not None:
            self.station_dock.release_all_controls()
            self.station_dock.setVisible(with_dock)
            place_widget(self.station_dock, at.dock)
        place_widget(self.title_line, at.title)
        place_widget(self.strip, at.strip if large else low.strip)
        place_widget(self.prompt_line, at.prompt)
        place_widget(self.key_bar, at.keys)
        place_widget(self.alarm_list, work)
        self._page_area = work
        self.help_panel.place_with_notice(self._page_area, self.alarm_notice)
        return work

    @property
    def _layout_needs(self) -> LayoutNeeds:
        """Return the parts that the layout of the current page needs now."""
        return find_layout_needs(
            self.current_page,
            self.height(),
            has_notices=bool(self.notice_rows.notice_rows),
            has_alarm=bool(self._shown and self._shown[0].alarms),
            search_height_px=self.search_bar.height_px,
        )

    @property
    def _has_dock_changed(self) -> bool:
        """Return whether the operator station was shown or hidden since the last layout."""
        dock = self.desk.settings_store.current_settings.dock
        return self.station_dock is not None and self._docked is not dock

    def _stand_readouts(self, at: AutomaticLayout, large: bool) -> None:
        parts: tuple[tuple[QWidget, Rect], ...] = (
            (self.position_panel, at.position),
            (self.feed_panel, at.feed),
            (self.spindle_panel, at.spindle),
            (self.tool_panel, at.tool),
            (self.times_panel, at.times),
        )
        for part, rect in parts:
            place_widget(part, rect)
            part.setVisible(large)

    # --- display -------------------------------------------------------------------------------------

    def has_changed_since_refresh(self) -> bool:
        """Return whether the machine, the program or a panel has changed since the last refresh."""
        shown, desk = self._shown, self.desk
        if shown is None or self._paints != Panel.paint_count:
            return True
        return shown[1] is not desk.program_loader.loaded_program or not shown[0].equals_except_time(
            desk.read_snapshot()
        )

    def is_refresh_due(self) -> bool:
        """Return whether the last refresh was more than 0.45 s ago."""
        return self.desk.clock.read_seconds() - self._shown_at > MAX_REFRESH_AGE_S

    def refresh(self) -> None:
        """Poll one snapshot, and show it in all parts."""
        snapshot, view, loaded = self.desk.update()
        self._shown, self._paints = (snapshot, loaded), Panel.paint_count
        self._shown_at = self.desk.clock.read_seconds()
        self.is_at_rest = snapshot.state in _REST_STATES and not snapshot.wheel
        self.prompt_line.must_show_state = not self.is_at_rest or needs_instruction(snapshot)
        self.notice_rows.notice_rows = make_notices(
            self.desk, snapshot, loaded, here=self.current_page is self.automatic_page
        )
        self.has_recent_manual_motion = by_hand = self._manual_motion.is_recent(
            snapshot, self.desk.station_controls.clock()
        )
        is_new_height = self.notice_rows.needs_new_height or self._placed_needs != self._layout_needs
        if self._has_dock_changed or (is_new_height and not by_hand):
            self.arrange_parts()
        self._show_bars(snapshot, view, loaded)
        lamps = make_lamp_row(self.desk, snapshot, view)
        self.strip.lamps = lamps
        self.strip.hidden_keys = self._find_dead_keys(lamp.switch_key for lamp in lamps)
        if self.current_page is self.automatic_page:
            go_on = tr(Message("{start} TO CONTINUE", start=tr(self.desk.start_instruction)))
            self.alarm_notice.show_notice(view.message, go_on, view.alarms)
        else:
            self.alarm_notice.show_notice("", "")  # the prompt line shows it: no field is covered
        if not self.position_panel.isHidden():
            self._show_readouts(snapshot, view, loaded)
        else:
            self.readout_line.show_status(view)
            self.run_line.show_status(view, make_times(self.desk, snapshot, view, loaded))
        self.help_panel.place_with_notice(self._page_area, self.alarm_notice)
        self.alarm_list.show_entries(self.desk.alarm_log.entries)
        if self.station_dock is not None:
            self.station_dock.show_state(snapshot)
            self.station_dock.hidden_keys = self._find_dead_keys("AHU,")
        self.current_page.refresh(snapshot, view, loaded)
        self.search_bar.refresh(snapshot)
        self._update_caret()
        self.key_bar.key_labels, self.key_bar.disabled_keys = (
            self.current_page.make_key_labels(),
            self.current_page.find_disabled_keys(),
        )

    def _update_caret(self) -> None:
        """Show the caret of the page's input field only while typed characters go to this field."""
        has_field = self.current_page.has_text_field() and not self.search_bar.is_open
        if has_field is not self.theme.is_caret_shown:
            self.theme.is_caret_shown = has_field
            for panel in self.current_page.findChildren(Panel):
                panel.update()

    def _find_dead_keys(self, keys: Iterable[str]) -> frozenset[str]:
        """Return the keys of these lamps that have no function on the current page.

        Touching the lamp itself has the same function on every page.
        """
        dead = () if self.current_page is self.automatic_page else AUTOMATIC_KEYS
        blocked = self._blocks_letters()
        return frozenset(
            key for key in keys if self.accepts_text(key) or (key != HELP_KEY and (blocked or key in dead))
        )

    def accepts_text(self, key: str) -> bool:
        """Return whether a character goes to an input field of the page or to a standard text field."""
        if self.search_bar.is_open:
            return len(key) == 1 and self.help_panel.isHidden()
        return self._is_field_reachable() and (self.current_page.accepts_key(key) or self._stock_field())

    def has_text_field(self) -> bool:
        """Return whether an input field has the keyboard focus, so that characters are text."""
        if self.search_bar.is_open:
            return self.help_panel.isHidden()
        if self.search_bar.is_discarding:
            return False  # Letters are stop keys, and all other characters are discarded.
        return self._is_field_reachable() and (self.current_page.has_text_field() or self._stock_field())

    def _blocks_letters(self) -> bool:
        """Return whether letters are no commands now, because an input field is open."""
        return self.has_text_field() or self.covers_text_field

    def _is_field_reachable(self) -> bool:
        return self.help_panel.isHidden() and not self.is_page_covered

    def _stock_field(self) -> bool:
        at = QApplication.focusWidget()
        return isinstance(at, QLineEdit | TextArea) and self.isAncestorOf(at)

    def _show_bars(self, snapshot: Snapshot, view: MachineStatus, loaded: LoadedProgram) -> None:
        desk = self.desk
        name = view.program_name or loaded.name
        self.title_line.page_title = self.current_page.NAME
        self.title_line.access_text = desk.user_access.header_text
        self.title_line.show_texts(
            name, view.state_text, view.state_tone, desk.machine.name, desk.clock.format_local_time()
        )
        search = self.search_bar.search
        page_prompt = search.prompt_text(snapshot) if search.is_open else self.current_page.prompt_text()
        state = make_page_prompt(desk, snapshot, loaded, page_prompt)
        self.prompt_line.show_state(state, prompt_line.reason(view) or prompt_line.find_remedy(loaded, state))
        self.prompt_line.show_question(
            desk.prompt_line.question_text or self.current_page.find_pending_question(), desk.confirmation_key
        )
        self.prompt_line.show_message(desk.prompt_line.message, kind=desk.prompt_line.notice_kind)

    def _show_readouts(self, snapshot: Snapshot, view: MachineStatus, loaded: LoadedProgram) -> None:
        """Show the current values in the large displays."""
        self.position_panel.position_readout, self.feed_panel.value = view.position, view.feed
        self.spindle_panel.value = view.spindle
        self.tool_panel.value = (view.tool_text, view.secondary_offset_text)
        self.times_panel.value = make_times(self.desk, snapshot, view, loaded)
