"""The main window, which handles keys, polls the snapshot once a frame, and releases keys held down."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib.resources import files

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QIcon, QInputEvent, QKeyEvent, QResizeEvent, QScreen, QShowEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.desk import Desk
from app.desk.late_presses import BlockedLateAction
from app.desk.status.prompt_line import ACTIVE_STATES, MOVING_STATES
from app.desk.stop_keys.key_watcher_notice import report_watcher_end
from app.desk.stop_keys.stop_records import SOURCE_SCREEN, StopArea
from app.desk.translation import get_language, tr
from app.screen.color_palettes import PALETTES
from app.screen.page_table import AUTOMATIC, PagePreloader
from app.screen.panel import TouchPanel
from app.screen.screen_theme import ScreenTheme, find_palette, set_language, style_application
from app.screen.text_sizes import make_screen_resolution
from app.screen.window.documentation_browser import DocumentationBrowser
from app.screen.window.input_times import InputTimes
from app.screen.window.key_table import (
    HELP_KEY,
    PAGE_FUNCTION_KEYS,
    PALM_BUTTON_KEYS,
    REPEATING_KEYS,
    ROW_ACTION_KEYS,
    SEARCH_CLOSING_KEYS,
    find_key_code,
    find_key_name,
)
from app.screen.window.keyboard import KeyboardFilter
from app.screen.window.stop_controls import find_stop_areas, is_page_stop_key, is_stop_control_at
from app.screen.window.typed_keys import TypedKeyHandler, make_key_actions
from app.screen.window.window_frame import ScreenContext, WindowFrame
from app.screen.window.window_placement import show_full_screen, show_in_suitable_size
from app.screen.window_layout import MIN_WINDOW_PX
from core.message import Message

FRAME_MS = 16  # Maximum 60 frames per second.
IDLE_FRAME_MS = 48  # Interval at rest without recent input, if something new was shown.
AT_REST_FRAME_MS = 96  # Interval if nothing new was shown. A change at rest wakes the window.
IDLE_DELAY_S = 2.0  # Seconds.


class MainWindow(QWidget):
    """Main window, which shows one page at a time.

    Before the model exists, it shows that TurnDesk is starting.
    """

    machine_changed = Signal()  # The machine has changed. Any thread may emit this signal.

    def __init__(self, theme: ScreenTheme, on_closed: Callable[[], None] = lambda: None) -> None:
        super().__init__()
        self._closed = on_closed
        self._meant = False  # The operator confirmed closing although data will be lost.
        self.theme = theme
        self.frame: WindowFrame | None = None
        self.page_preloader: PagePreloader | None = None
        self._keys: dict[str, Callable[[], None]] = {}
        self.input_times = InputTimes()
        self.input_times.on_wake = self._resume_polling
        self.machine_changed.connect(self._resume_polling, Qt.ConnectionType.QueuedConnection)
        self.keyboard_filter = KeyboardFilter(self, self.input_times)
        self.typed_keys = TypedKeyHandler(self.keyboard_filter, self.press_key, self.refresh)
        self._page = ""  # The page that has the keyboard.
        # Screen states that were shown, with their start times.
        self._faces: deque[tuple[float, ScreenContext]] = deque(maxlen=32)
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._handle_tick)
        self.setWindowTitle("TurnDesk")
        self.setMinimumSize(*MIN_WINDOW_PX)
        self.setWindowIcon(QIcon(str(files("resources") / "desktop" / "turndesk.svg")))
        self.is_kiosk = False  # Only TurnDesk is visible, and the operator cannot close it.
        self._full: bool | None = None  # Whether the window is full screen now; None: as it was opened.
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def show_model(self, desk: Desk) -> None:
        """Show the model on the screen, and start polling it. It replaces the model that was shown before."""
        earlier_frame, self.frame = self.frame, WindowFrame(self.theme, desk, self.press_key, self)
        desk.window_state.is_kiosk = self.is_kiosk
        self.frame.help_panel.browser = DocumentationBrowser(desk, is_kiosk=self.is_kiosk)
        # It belongs to another window of this model.
        if (earlier := desk.page_registry.find_model(PagePreloader)) is not None:
            earlier.close()
        self.page_preloader = PagePreloader(desk, self.frame.find_page)
        desk.page_registry.attach_model(self.page_preloader)
        self._keys = {**make_key_actions(desk), "T": self.toggle_theme, "Esc": self._handle_escape}
        desk.window_state.connect_window(
            self._wake_from_thread,
            self.keyboard_filter.is_stop_key_held,
            lambda: self.input_times.clock() - self.keyboard_filter.event_time_s,
        )
        report_end = partial(report_watcher_end, desk)
        open_channel = desk.desk_control.open_stop_channel
        if (watched := self.keyboard_filter.start_key_watcher(open_channel, report_end)) is not None:
            desk.page_registry.attach_model(watched)
        late = desk.window_state.late_presses
        late.report_dropped_names = self._show_dropped
        late.on_answer_dropped = self.keyboard_filter.record_dropped_answer
        self.frame.setGeometry(self.rect())
        self.refresh()
        self.frame.show()
        if earlier_frame is not None:
            earlier_frame.hide()
            earlier_frame.deleteLater()
            self.keyboard_filter.read_pressed_keys()
        self.setFocus()
        self._timer.start(FRAME_MS)

    def _handle_tick(self) -> None:
        """Refresh the screen at the full rate, or only after a change while the machine is at rest."""
        known = self.input_times.has_seen_screen
        self.input_times.frame()
        known = known and self.input_times.has_seen_screen  # False after a stall
        if (frame := self.frame) is None:
            return
        self.set_event_late(is_late=False)
        changed = not known or self._is_animating(frame) or frame.has_changed_since_refresh()
        if changed or frame.is_refresh_due():
            self.refresh()
        if not self._faces or self._faces[-1][1] != frame.screen_context:
            self._faces.append((self.input_times.clock(), frame.screen_context))
        makes = self.page_preloader is not None and not self.page_preloader.is_done
        self.keyboard_filter.complete_frame()
        if self.page_preloader is not None:
            self.page_preloader.continue_loading()
        self._pace(
            FRAME_MS if self._is_animating(frame) else IDLE_FRAME_MS if changed or makes else AT_REST_FRAME_MS
        )

    def _is_animating(self, frame: WindowFrame) -> bool:
        """Return whether the full frame rate is needed because of motion, animation or recent input."""
        played = frame.current_page.is_animating() and not self.isMinimized()
        return (
            not frame.is_at_rest
            or played
            or self.input_times.clock() - self.input_times.input_time_s < IDLE_DELAY_S
        )

    def _wake_from_thread(self) -> None:
        """Wake the window from any thread.

        A closed window ignores the call.
        """
        with suppress(RuntimeError):
            self.machine_changed.emit()

    def _resume_polling(self) -> None:
        """Return to the full frame rate at the first event or change of the machine state."""
        self._pace(FRAME_MS)

    def _pace(self, interval: int) -> None:
        if self._timer.isActive() and self._timer.interval() != interval:
            self._timer.setInterval(interval)

    def refresh(self) -> None:
        """Poll one snapshot, and show it in all parts."""
        if self.frame is not None:
            with self.frame.desk.window_state.late_presses.suspend_check():
                self._check_held_inputs(self.frame)
                self.frame.refresh()
                self._apply_settings(self.frame)

    def _check_held_inputs(self, frame: WindowFrame) -> None:
        """Check which keys and buttons are physically down, and handle releases that were lost."""
        if self._page != frame.current_page.NAME:
            self._page = frame.current_page.NAME
            self.keyboard_filter.ignore_pressed_keys()
        self.keyboard_filter.update()
        if (
            QApplication.mouseButtons() is not Qt.MouseButton.NoButton
            and not self.keyboard_filter.is_mouse_button_held()
        ):
            for panel in frame.findChildren(TouchPanel):
                panel.release_mouse()

    def press_key(self, key_name: str) -> None:
        """Execute the action of a key.

        Touch targets also call this.
        """
        frame = self.frame
        if frame is not None and key_name in ROW_ACTION_KEYS and frame.search_bar.refuse_hidden_row():
            self.refresh()
            return
        action = (frame.make_key_actions().get(key_name) if frame else None) or self._keys.get(key_name)
        if action is not None:
            if frame is not None:
                frame.current_page.stop_held_key_actions()
                if key_name != HELP_KEY:
                    frame.help_panel.close_help()
                if key_name in SEARCH_CLOSING_KEYS:
                    frame.search_bar.search.close()
                if key_name in PAGE_FUNCTION_KEYS:
                    frame.alarm_list.close_list()
                if key_name != "Esc":  # Esc removes the message itself.
                    frame.desk.prompt_line.clear_message()
            action()
            self.refresh()
        elif frame is not None and key_name.startswith("F") and key_name[1:].isdecimal():
            frame.desk.say(tr(Message("{key} HAS NO FUNCTION ON THIS PAGE", key=key_name)))
            self.refresh()

    def toggle_theme(self) -> None:
        """Select the next theme. The theme then no longer follows the operating system."""
        if self.frame is not None:
            names = tuple(PALETTES)
            following = names[(names.index(self.theme.palette.name) + 1) % len(names)]
            self.frame.desk.apply_setting("theme", following)

    def _apply_settings(self, frame: WindowFrame) -> None:
        """Apply the selected colors, language and window size."""
        settings = frame.desk.settings_store.current_settings
        if settings.language != get_language():
            set_language(settings.language)
            frame.apply_theme()
        palette = find_palette(settings.theme)
        if palette is not self.theme.palette:
            self.theme.set_palette(palette)
            style_application(self.theme.palette)
            frame.apply_theme()

        if not self.is_kiosk and settings.full_screen is not (self._full or False):
            self._set_full_screen(settings.full_screen)

    def _set_full_screen(self, full: bool) -> None:
        """Show the window on the full screen, or maximized."""
        self._full = full
        if full:
            show_full_screen(self)
        else:
            self.showMaximized()

    def show_on_screen(self, screen: QScreen) -> None:
        """Show the window in a size that suits the screen.

        The window fills a small screen completely. Otherwise the title bar of a window manager could push
        the function keys off a screen with 600 lines.
        """
        show_in_suitable_size(self, screen, is_kiosk=self.is_kiosk)

    def _handle_escape(self) -> None:
        """Handle Esc with the first of these actions that is possible.

        1. Go back one step on the page. 2. Close a question. 3. Start feed hold. 4. Open the Automatic
        page.
        """
        frame = self.frame
        if frame is not None and not (frame.handle_escape() or frame.desk.handle_escape()):
            frame.open_page(AUTOMATIC)

    def close_silently(self) -> None:
        """Stop polling, and delete the window without asking, in a script that only reads the screen."""
        self._timer.stop()
        self.hide()
        self.deleteLater()

    # --- functions for the keyboard ------------------------------------------------------------------

    def start_feed_hold(self, source: str = "", press: int = 0) -> None:
        """Start feed hold, regardless of the open page, input field or question.

        ``source`` names the key in the log.
        """
        if self.frame is not None:
            self.frame.current_page.stop_held_key_actions()
            self.frame.help_panel.close_help()
            self.frame.desk.start_feed_hold(source or SOURCE_SCREEN, press)
            self.refresh()

    def press_estop(self, press: int = 0) -> None:
        """Press the E-stop, regardless of the open page, input field or question."""
        if self.frame is not None:
            self.frame.current_page.stop_held_key_actions()
            self.frame.help_panel.close_help()
            self.frame.desk.station_keys.press_estop(press)
            self.refresh()

    def show_estop_pressed(self) -> None:
        """Show the simulated E-stop as pressed after the key watcher has pressed it."""
        if self.frame is not None and self.frame.desk.desk_control.station_panel is not None:
            self.frame.desk.station_keys.press_estop()

    def is_esc_stop_key(self) -> bool:
        """Return whether Esc starts feed hold now.

        It does if the machine moves and Esc has no other function.
        """
        frame = self.frame
        return (
            frame is not None
            and frame.desk.read_snapshot().state in MOVING_STATES
            and frame.is_esc_stop_key()
        )

    def has_text_field(self) -> bool:
        """Return whether an input field has the keyboard focus and therefore gets all characters."""
        return self.frame is not None and self.frame.has_text_field()

    def record_activity(self) -> None:
        """Record that the signed-in user has pressed a key or touched the screen."""
        if self.frame is not None:
            self.frame.desk.user_access.record_activity()

    def accepts_text(self, key: str) -> bool:
        """Return whether this character goes to an input field now."""
        return self.frame is not None and self.frame.accepts_text(key)

    def set_event_late(self, *, is_late: bool) -> None:
        """Set whether the current event was delayed by a stall and must not start anything."""
        if self.frame is not None:
            self.frame.desk.window_state.late_presses.is_press_late = is_late

    def has_screen_changed_since(self, time_s: float) -> bool:
        """Return whether the content of the screen has changed after a given time.

        An earlier touch was meant for the previous content.
        """
        seen = [face for since, face in self._faces if since <= time_s]
        return bool(seen) and self.frame is not None and seen[-1] != self.frame.screen_context

    def report_dropped_press(self, action: BlockedLateAction) -> None:
        """Report a press that is not executed because a stall delayed it."""
        if self.frame is not None:
            self.frame.desk.window_state.late_presses.report_dropped_action(action)

    def _show_dropped(self, names: tuple[str, ...]) -> None:
        if self.frame is not None:
            text = tr("SCREEN FROZE {seconds} S. NOT DONE: {what}. PRESS AGAIN")
            seconds = f"{self.keyboard_filter.delay_s:.1f}"
            self.frame.desk.show_warning(tr(Message(text, seconds=seconds, what=", ".join(names))))

    def is_stop_control_at(self, event: QInputEvent) -> bool:
        """Return whether a press is on a control that stops something."""
        return self.frame is not None and is_stop_control_at(self.frame, event)

    def is_page_stop_key(self, event: QKeyEvent) -> bool:
        """Return whether a key stops something on the current page."""
        return self.frame is not None and is_page_stop_key(self.frame, event)

    def find_stop_areas(self) -> tuple[StopArea, ...]:
        """Return the rectangles of the visible E-stop and feed hold of the on-screen station."""
        return find_stop_areas(self.frame) if self.frame is not None else ()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def showEvent(self, _event: QShowEvent) -> None:
        """Start filtering the keys of the new window, and read the screen's resolution."""
        window = self.windowHandle()
        if window is not None:
            self.keyboard_filter.filter_window_events(window)
            self._update_resolution()
            window.screenChanged.connect(self._update_resolution)

    def _update_resolution(self) -> None:
        """Read the real size of the screen, on which the heights of texts and list rows depend."""
        screen = self.screen()
        if screen is not None:
            size, real = screen.size(), screen.physicalSize()
            self.theme.screen = make_screen_resolution(
                size.width(), size.height(), real.width(), real.height()
            )
            if self.frame is not None:
                self.frame.arrange_parts()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle a key press.

        A repeat is accepted only for keys that may repeat.
        """
        frame = self.frame
        if frame is None or self.typed_keys.handle_priority_key(frame, event):
            return
        if self._handle_help_key(frame, event) or (
            not frame.is_page_covered and frame.current_page.handle_key_press(event)
        ):
            self.refresh()
            return
        if (
            not event.isAutoRepeat()
            and event.key() in PALM_BUTTON_KEYS
            and not frame.automatic_page.file_prompt.isVisible()
        ):
            self._palm(PALM_BUTTON_KEYS[Qt.Key(event.key())], down=True)
            return
        if self.typed_keys.handle_typed_key(frame, event) or self.typed_keys.is_character_rejected(
            frame, event
        ):
            return
        name = find_key_name(find_key_code(event), event.modifiers())
        if (
            name
            and (name in REPEATING_KEYS or not event.isAutoRepeat())
            and not self.typed_keys.is_used_elsewhere(frame, name)
        ):
            self.press_key(name)

    def _handle_help_key(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the help handled the key, because it is open or because the key opens it."""
        if not frame.help_panel.isHidden():
            frame.help_panel.handle_key(event)
            return True
        if event.text() != HELP_KEY or event.isAutoRepeat() or frame.accepts_text(HELP_KEY):
            return False
        self.press_key(HELP_KEY)
        return True

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Release a palm button or a key of the page."""
        if self.frame is not None:
            self.frame.current_page.handle_key_release(event)
        if not event.isAutoRepeat() and event.key() in PALM_BUTTON_KEYS:
            self._palm(PALM_BUTTON_KEYS[Qt.Key(event.key())], down=False)

    def _palm(self, side: str, *, down: bool) -> None:
        if self.frame is not None:
            desk = self.frame.desk
            if desk.machine.has_two_hand_start:
                desk.station_controls.palm(side, down)
            elif down and side == "right":
                desk.station_keys.press_start()
            self.refresh()

    def changeEvent(self, event: QEvent) -> None:
        """Release all buttons when the window loses the keyboard focus.

        Without the focus, the window receives no release events.
        """
        if event.type() == QEvent.Type.ActivationChange:
            self._tell_keyboard()
            if self.isActiveWindow():
                self.keyboard_filter.read_pressed_keys()
            else:
                self.release_all_inputs()
        super().changeEvent(event)

    def _tell_keyboard(self) -> None:
        if self.frame is not None:
            self.frame.desk.window_state.set_keyboard_lost(not self.isActiveWindow())

    def release_all_inputs(self) -> None:
        """Release all keys, buttons and controls that are pressed."""
        self.keyboard_filter.ignore_pressed_keys()
        if self.frame is not None:
            if self.frame.station_dock is not None:
                self.frame.station_dock.release_all_controls()
            self.frame.desk.station_controls.release_all_buttons()
            self.frame.current_page.release_all_keys()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Resize the frame so that it fills the window."""
        if self.frame is not None:
            self.frame.setGeometry(self.rect())

    def _may_close(self, frame: WindowFrame) -> bool:
        return self._meant or frame.desk.can_close(self._close_window)

    def _close_window(self) -> None:
        """Close the window even if unsaved data is lost."""
        self._meant = True
        self.close()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close the window, except in kiosk mode, while a program runs, or if the page prevents closing."""
        frame = self.frame
        if self.is_kiosk and frame is not None and not self._meant:
            frame.desk.say(tr("KIOSK MODE: SHUT DOWN THE COMPUTER TO CLOSE TURNDESK"))
            self.refresh()
            event.ignore()
            return
        if frame is not None and frame.desk.read_snapshot().state in ACTIVE_STATES:
            frame.desk.say("PROGRAM RUNNING. STOP IT AND PRESS R FIRST")
            self.refresh()
            event.ignore()
            return
        if frame is not None and not (frame.current_page.try_leave_page() and self._may_close(frame)):
            self.refresh()
            event.ignore()
            return
        self._timer.stop()
        self.release_all_inputs()
        event.accept()
        self._closed()
