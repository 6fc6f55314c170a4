"""The main window: handles keys, polls the snapshot once a frame, and releases keys that are held down."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib.resources import files

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import (
    QCloseEvent,
    QIcon,
    QInputEvent,
    QKeyEvent,
    QPointerEvent,
    QResizeEvent,
    QScreen,
    QShowEvent,
)
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.desk import Desk
from app.desk.late_presses import Starting
from app.desk.status.prompt_line import MOVING, UNDER_WAY
from app.desk.stop_keys.stop_records import BY_SCREEN
from app.desk.translation import spoken, tr
from app.screen.look import PALETTES, Look, dress, speak_in
from app.screen.page_table import AUTOMATIC, PagesAhead
from app.screen.panel import FingerPanel
from app.screen.text_sizes import panel_size
from app.screen.window.keyboard import EventTimes, Keyboard, key_of, letter_of
from app.screen.window.keys import (
    ANSWER,
    NO,
    OF_AUTOMATIC,
    PALMS,
    REPEATING,
    STOP_LETTERS,
    TYPED_AGAIN,
    name_of,
    typed_of,
)
from app.screen.window.window_frame import Face, Frame
from app.screen.window_layout import LEAST
from core.message import Message

FRAME_MS = 16  # Maximum 60 frames per second.
SOON_MS = 48  # Interval at rest without recent input, if something new was shown.
REST_MS = 96  # Interval if nothing new was shown. A change at rest wakes the window.
UNTOUCHED = 2.0  # Seconds.
START_SIZE = (1280, 720)
TITLE_BAR = 60  # Pixels that the title bar of a window manager uses.


def fill_screen(window: QWidget, *, frameless: bool = False) -> None:
    """Show a window on the whole screen. The geometry is set too, in case there is no window manager."""
    if frameless:
        window.setWindowFlag(Qt.WindowType.FramelessWindowHint)
    screen = window.screen()
    if screen is not None:
        window.setGeometry(screen.geometry())
    window.showFullScreen()


class MainWindow(QWidget):
    """The main window, with one page at a time. Without a model, it shows that TurnDesk is starting."""

    stirred = Signal()  # The machine has changed. Any thread may emit this signal.

    def __init__(self, look: Look, closed: Callable[[], None] = lambda: None) -> None:
        super().__init__()
        self._closed = closed
        self._meant = False  # The operator confirmed closing although data will be lost.
        self._untaken = ""  # Message about the last character that an input field rejected.
        self.look = look
        self.frame: Frame | None = None
        self.ahead: PagesAhead | None = None
        self._keys: dict[str, Callable[[], None]] = {}
        self.times = EventTimes()
        self.times.woken = self._wake
        self.stirred.connect(self._wake, Qt.ConnectionType.QueuedConnection)
        self.keyboard = Keyboard(self, self.times)
        self._page = ""  # The page that has the keyboard.
        # Screen states that were shown, with their start times.
        self._faces: deque[tuple[float, Face]] = deque(maxlen=32)
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        self.setWindowTitle("TurnDesk")
        self.setMinimumSize(*LEAST)
        self.setWindowIcon(QIcon(str(files("resources") / "desktop" / "turndesk.svg")))
        self.kiosk = False  # Only TurnDesk is visible, and the operator cannot close it.
        self._full: bool | None = None  # Whether the window is full screen now; None: as it was opened.
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def open_desk(self, desk: Desk) -> None:
        """Show the model on the screen and begin to poll it."""
        self.frame = Frame(self.look, desk, self.press, self)
        # It belongs to another window of this model.
        if (earlier := desk.pages.find(PagesAhead)) is not None:
            earlier.close()
        self.ahead = PagesAhead(desk, self.frame.page_named)
        desk.pages.attach(self.ahead)
        self._keys = self._table(desk)
        desk.window.connect(
            self._stir, self.keyboard.stop_held, lambda: self.times.clock() - self.keyboard.now
        )
        watched = self.keyboard.watch_stops(desk.control.open_stop_line)
        if watched is not None:
            desk.pages.attach(watched)
        late = desk.window.late
        late.report, late.on_answer = self._show_dropped, self.keyboard.answer_dropped
        self.frame.setGeometry(self.rect())
        self.refresh()
        self.frame.show()
        self.setFocus()
        self._timer.start(FRAME_MS)

    def _tick(self) -> None:
        """Refresh the screen at the full rate, or at rest only if something has changed."""
        known, frame = self.times.known, self.frame
        self.times.frame()
        known = known and self.times.known  # A stall was just detected, or its changes are not shown yet.
        if frame is None:
            return
        self.judge(late=False)
        changed = not known or self._lively(frame) or frame.changed()
        if changed or frame.aged():
            self.refresh()
        if not self._faces or self._faces[-1][1] != frame.face:
            self._faces.append((self.times.clock(), frame.face))
        makes = self.ahead is not None and not self.ahead.done
        if self.ahead is not None:
            self.ahead.step()
        self._pace(FRAME_MS if self._lively(frame) else SOON_MS if changed or makes else REST_MS)

    def _lively(self, frame: Frame) -> bool:
        """Return whether the full frame rate is needed, because of motion, animation or recent input."""
        played = frame.page.lively() and not self.isMinimized()
        return not frame.at_rest or played or self.times.clock() - self.times.touched < UNTOUCHED

    def _stir(self) -> None:
        """Wake the window from any thread. A closed window ignores the call."""
        with suppress(RuntimeError):
            self.stirred.emit()

    def _wake(self) -> None:
        """Return to the full frame rate at the first event or change of the machine."""
        self._pace(FRAME_MS)

    def _pace(self, interval: int) -> None:
        if self._timer.isActive() and self._timer.interval() != interval:
            self._timer.setInterval(interval)

    def refresh(self) -> None:
        """Poll one snapshot and show it in all parts."""
        if self.frame is not None:
            with self.frame.desk.window.late.suspended():
                self._look_at_hands(self.frame)
                self.frame.refresh()
                self._wear(self.frame)

    def _look_at_hands(self, frame: Frame) -> None:
        """Check which keys and buttons are really down for this page, and handle lost releases."""
        if self._page != frame.page.NAME:
            self._page = frame.page.NAME
            self.keyboard.away()
        self.keyboard.look()
        if QApplication.mouseButtons() is not Qt.MouseButton.NoButton and not self.keyboard.button_held():
            for panel in frame.findChildren(FingerPanel):
                panel.mouse_is_up()

    def press(self, key: str) -> None:
        """Execute the action of a key. Touch targets call this, too."""
        frame = self.frame
        action = (frame.key_actions().get(key) if frame else None) or self._keys.get(key)
        if action is not None:
            if frame is not None:
                frame.page.pressed()
                if key != "Esc":  # Esc removes the message itself.
                    frame.desk.answers.next_key()
            action()
            self.refresh()
        elif frame is not None and key.startswith("F") and key[1:].isdecimal():
            frame.desk.say(tr(Message("{key} HAS NO FUNCTION ON THIS PAGE", key=key)))
            self.refresh()

    def _table(self, desk: Desk) -> dict[str, Callable[[], None]]:
        return {
            "S": partial(desk.switch, "single_block"),
            "O": partial(desk.switch, "optional_stop"),
            "C": partial(desk.switch, "cycle_repeat"),
            "P": partial(desk.switch, "no_count"),
            "/": desk.programs.switch_block_delete,
            "H": desk.feed_hold,
            "R": desk.reset,
            "D": desk.enable,
            "E": desk.station.press_estop,
            "U": desk.station.release_estop,
            ANSWER: desk.answer,
            NO: desk.no,
            "A": desk.station.turn_spindle_switch,
            ",": partial(desk.hands.turn_spindle_pot, -1),
            ".": partial(desk.hands.turn_spindle_pot, 1),
            "+": partial(desk.station.step_override, 1),
            "-": partial(desk.station.step_override, -1),
            "T": self.other_theme,
            "Y": desk.yes,
            "Esc": self._escape,
        }

    def other_theme(self) -> None:
        """Switch between the dark and the light theme."""
        if self.frame is not None:
            self.frame.desk.choose_setting("theme", self.frame.desk.settings.following("theme"))

    def _wear(self, frame: Frame) -> None:
        """Apply the selected colors, language and window size."""
        settings = frame.desk.settings.now
        if settings.language != spoken():
            speak_in(settings.language)
            frame.dress()
        if settings.theme != self.look.palette.name:
            self.look.repaint(PALETTES[settings.theme])
            dress(self.look.palette)
            frame.dress()

        if not self.kiosk and settings.full_screen is not (self._full or False):
            self._fill(settings.full_screen)

    def _fill(self, full: bool) -> None:
        """Show the window on the full screen, or maximized."""
        self._full = full
        if full:
            fill_screen(self)
        else:
            self.showMaximized()

    def open_on(self, screen: QScreen) -> None:
        """Show the window in a size that suits the screen.

        A small screen is filled completely. The title bar of a window manager could otherwise push the
        function keys off a screen with 600 lines.
        """
        room = screen.availableGeometry()
        self.setMinimumSize(min(LEAST[0], room.width()), min(LEAST[1], room.height()))
        if self.kiosk or room.height() < LEAST[1] + TITLE_BAR or room.width() <= LEAST[0]:
            fill_screen(self, frameless=self.kiosk)
        elif room.width() < 2 * START_SIZE[0]:
            self.setGeometry(room)  # Without a window manager, nothing else sets the geometry.
            self.showMaximized()
        else:  # On a large screen, use a quarter of it.
            self.resize(max(START_SIZE[0], room.width() // 2), max(START_SIZE[1], room.height() // 2))
            self.show()

    def _escape(self) -> None:
        """Go one step back: on the page, then a question or feed hold, and finally to the Automatic page."""
        frame = self.frame
        if frame is not None and not (frame.escape() or frame.desk.escape()):
            frame.go(AUTOMATIC)

    def put_away(self) -> None:
        """Stop polling and delete the window without asking. For scripts that only read the screen."""
        self._timer.stop()
        self.hide()
        self.deleteLater()

    # --- functions for the keyboard ------------------------------------------------------------------

    def hold(self, by: str = "", press: int = 0) -> None:
        """Start feed hold on any page, field or question. ``by`` names the key in the log."""
        if self.frame is not None:
            self.frame.page.pressed()
            self.frame.desk.feed_hold(by or BY_SCREEN, press)
            self.refresh()

    def estop(self, press: int = 0) -> None:
        """Press the E-stop on any page, field or question."""
        if self.frame is not None:
            self.frame.page.pressed()
            self.frame.desk.station.press_estop(press)
            self.refresh()

    def estop_sent(self) -> None:
        """Show the simulated E-stop as pressed, after the key watcher has pressed it."""
        if self.frame is not None and self.frame.desk.control.panel is not None:
            self.frame.desk.station.press_estop()

    def esc_holds(self) -> bool:
        """Return whether Esc starts feed hold now: the machine moves, and Esc has no other function."""
        frame = self.frame
        return frame is not None and frame.desk.snapshot().state in MOVING and frame.esc_holds()

    def has_field(self) -> bool:
        """Return whether an input field has the keyboard and thus gets all characters."""
        return self.frame is not None and self.frame.has_field()

    def used(self) -> None:
        """Note that the signed-in user pressed a key or touched the screen."""
        if self.frame is not None:
            self.frame.desk.access.used()

    def is_text(self, key: str) -> bool:
        """Return whether this character goes to an input field now."""
        return self.frame is not None and self.frame.is_text(key)

    def judge(self, *, late: bool) -> None:
        """Set whether the present event waited during a stall and therefore must not start anything."""
        if self.frame is not None:
            self.frame.desk.window.late.late = late

    def looks_different(self, at: float) -> bool:
        """Return whether the screen showed something else at this time, which the touch was meant for."""
        seen = [face for since, face in self._faces if since <= at]
        return bool(seen) and self.frame is not None and seen[-1] != self.frame.face

    def drop(self, starting: Starting) -> None:
        """Report a press that waited during a stall and is not executed."""
        if self.frame is not None:
            self.frame.desk.window.late.report_dropped(starting)

    def _show_dropped(self, names: tuple[str, ...]) -> None:
        if self.frame is not None:
            text = tr("SCREEN FROZE {seconds} S. NOT DONE: {what}. PRESS AGAIN")
            seconds = f"{self.keyboard.delay:.1f}"
            self.frame.desk.warn(tr(Message(text, seconds=seconds, what=", ".join(names))))

    def stops_at(self, event: QInputEvent) -> bool:
        """Return whether a press is on a control that stops the machine."""
        dock = self.frame.dock if self.frame is not None else None
        if dock is None or not dock.isVisible() or not isinstance(event, QPointerEvent):
            return False
        places = (dock.mapFromGlobal(point.globalPosition()) for point in event.points())
        return any(dock.stops_at(place) for place in places)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def showEvent(self, _event: QShowEvent) -> None:
        """Start filtering the keys of the new window, and read the screen's resolution."""
        window = self.windowHandle()
        if window is not None:
            self.keyboard.watch(window)
            self._measure()
            window.screenChanged.connect(self._measure)

    def _measure(self) -> None:
        """Read the real size of the screen, on which the heights of texts and list rows depend."""
        screen = self.screen()
        if screen is not None:
            size, real = screen.size(), screen.physicalSize()
            self.look.screen = panel_size(size.width(), size.height(), real.width(), real.height())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle a key press. A repeat counts only for keys that may repeat."""
        frame = self.frame
        if frame is None or self._answered(frame, event):
            return
        if frame.page.key_down(event):
            self.refresh()
            return
        if not event.isAutoRepeat() and event.key() in PALMS and not frame.automatic.files.isVisible():
            self._palm(PALMS[Qt.Key(event.key())], down=True)
            return
        if self._typed(frame, event) or self._kept_from(frame, event):
            return
        name = name_of(key_of(event), event.modifiers())
        if name and (name in REPEATING or not event.isAutoRepeat()) and not self._elsewhere(frame, name):
            self.press(name)

    def _elsewhere(self, frame: Frame, name: str) -> bool:
        """Return whether the key belongs to the Automatic page but another page is open, and show this."""
        if name not in OF_AUTOMATIC or frame.page is frame.automatic or name in frame.page.key_actions():
            return False
        frame.desk.say(tr(Message("{key} WORKS ON THE AUTOMATIC PAGE: PRESS F1, THEN F2", key=name)))
        self.refresh()
        return True

    def _answered(self, frame: Frame, event: QKeyEvent) -> bool:
        """Return whether the key answered a question. Yes needs a single key with all others released."""
        typed = {letter_of(event), typed_of(event)} - {""}
        if not frame.desk.asked or not typed & {frame.desk.asked, "N"}:
            return False
        if "N" in typed and frame.desk.asked != "N":
            self.press(NO)
        elif not event.isAutoRepeat() and self.keyboard.alone(event):
            self.press(ANSWER)
        return True

    def _kept_from(self, frame: Frame, event: QKeyEvent) -> bool:
        """Return whether an input field rejects the character, so that the key has no other function.

        Ctrl+H, Ctrl+Space and Ctrl+E do not stop the machine there either.
        """
        text = event.text()
        if not text.isprintable() or not text or not frame.has_field():
            return frame.has_field() and name_of(key_of(event), event.modifiers()) in STOP_LETTERS
        if not event.isAutoRepeat():
            self._untaken = tr(Message("{key} CANNOT BE ENTERED IN THIS FIELD", key=text))
            frame.desk.say(self._untaken)
            self.refresh()
        return True

    def _typed(self, frame: Frame, event: QKeyEvent) -> bool:
        """Return whether the page has handled the key as text input."""
        key = typed_of(event)
        if not key or (event.isAutoRepeat() and key not in TYPED_AGAIN) or not frame.page.typed(key):
            return False
        if frame.desk.notice == self._untaken:
            frame.desk.clear()  # The next key was accepted.
        self.refresh()
        return True

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Release a palm button, or a key of the page."""
        if self.frame is not None:
            self.frame.page.key_up(event)
        if not event.isAutoRepeat() and event.key() in PALMS:
            self._palm(PALMS[Qt.Key(event.key())], down=False)

    def _palm(self, side: str, *, down: bool) -> None:
        if self.frame is not None:
            desk = self.frame.desk
            if desk.machine.two_hand:
                desk.hands.palm(side, down)
            elif down and side == "right":
                desk.station.press_start()
            self.refresh()

    def changeEvent(self, event: QEvent) -> None:
        """Release all buttons when the window loses the keyboard, because it gets no release events."""
        if event.type() == QEvent.Type.ActivationChange:
            self._tell_keyboard()
            if self.isActiveWindow():
                self.keyboard.back()
            else:
                self.let_go()
        super().changeEvent(event)

    def _tell_keyboard(self) -> None:
        if self.frame is not None:
            self.frame.desk.window.set_keyboard_away(not self.isActiveWindow())

    def let_go(self) -> None:
        """Release all keys, buttons and controls that are pressed."""
        self.keyboard.away()
        if self.frame is not None:
            if self.frame.dock is not None:
                self.frame.dock.let_go()
            self.frame.desk.hands.let_go()
            self.frame.page.let_go()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Let the frame fill the window."""
        if self.frame is not None:
            self.frame.setGeometry(self.rect())

    def _may_close(self, frame: Frame) -> bool:
        return self._meant or frame.desk.may_close(self._close)

    def _close(self) -> None:
        """Close the window although data will be lost."""
        self._meant = True
        self.close()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Refuse to close while a program is running, in kiosk mode, or if the page prevents it."""
        frame = self.frame
        if self.kiosk and frame is not None and not self._meant:
            frame.desk.say(tr("KIOSK MODE: SHUT DOWN THE COMPUTER TO CLOSE TURNDESK"))
            self.refresh()
            event.ignore()
            return
        if frame is not None and frame.desk.snapshot().state in UNDER_WAY:
            frame.desk.say("PROGRAM RUNNING. STOP IT AND PRESS R FIRST")
            self.refresh()
            event.ignore()
            return
        if frame is not None and not (frame.page.leave() and self._may_close(frame)):
            self.refresh()
            event.ignore()
            return
        self._timer.stop()
        self.let_go()
        event.accept()
        self._closed()
