"""The main window: takes the keys, polls the snapshot once a frame, and lets go of everything it holds."""

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

FRAME_MS = 16  # at most 60 pictures a second
SOON_MS = 48  # the same at rest, once nobody has touched anything of late, and something new was to be shown
REST_MS = 96  # the same where nothing was: what changes at rest rings
UNTOUCHED = 2.0  # s
START_SIZE = (1280, 720)
TITLE_BAR = 60  # pixels: what a window manager takes of the height


def fill_screen(window: QWidget, *, frameless: bool = False) -> None:
    """The whole screen; the geometry is set too, as without a window manager nobody else does it."""
    if frameless:
        window.setWindowFlag(Qt.WindowType.FramelessWindowHint)
    screen = window.screen()
    if screen is not None:
        window.setGeometry(screen.geometry())
    window.showFullScreen()


class MainWindow(QWidget):
    """One page at a time; without a desk yet it shows that it is starting."""

    stirred = Signal()  # from any thread: the machine has changed

    def __init__(self, look: Look, closed: Callable[[], None] = lambda: None) -> None:
        super().__init__()
        self._closed = closed
        self._meant = False  # to leave, whatever is lost by it
        self._untaken = ""  # what was said of the last character that an entry did not take
        self.look = look
        self.frame: Frame | None = None
        self.ahead: PagesAhead | None = None
        self._keys: dict[str, Callable[[], None]] = {}
        self.times = EventTimes()
        self.times.woken = self._wake
        self.stirred.connect(self._wake, Qt.ConnectionType.QueuedConnection)
        self.keyboard = Keyboard(self, self.times)
        self._page = ""  # that has the keyboard
        self._faces: deque[tuple[float, Face]] = deque(maxlen=32)  # that were shown, and since when
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        self.setWindowTitle("TurnDesk")
        self.setMinimumSize(*LEAST)
        self.setWindowIcon(QIcon(str(files("resources") / "desktop" / "turndesk.svg")))
        self.kiosk = False  # nothing but the desk is to be seen, and nobody closes it
        self._full: bool | None = None  # as it is shown now; None: as it was opened
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def open_desk(self, desk: Desk) -> None:
        """Put the desk on the screen and begin to poll it."""
        self.frame = Frame(self.look, desk, self.press, self)
        if (earlier := desk.pages.find(PagesAhead)) is not None:  # of another window on this desk
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
        """Every picture at the full pace; at rest those in which there is something new."""
        known, frame = self.times.known, self.frame
        self.times.frame()
        known = (
            known and self.times.known
        )  # a stall has just been noticed, or what waited for it is not shown
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
        """Whether every picture counts: something moves or was touched, on the machine or on the screen."""
        played = frame.page.lively() and not self.isMinimized()
        return not frame.at_rest or played or self.times.clock() - self.times.touched < UNTOUCHED

    def _stir(self) -> None:
        """Called from any thread; a window that has gone has nothing to show."""
        with suppress(RuntimeError):
            self.stirred.emit()

    def _wake(self) -> None:
        """The first event ends the leisure, before it is judged; so does a change of the machine."""
        self._pace(FRAME_MS)

    def _pace(self, interval: int) -> None:
        if self._timer.isActive() and self._timer.interval() != interval:
            self._timer.setInterval(interval)

    def refresh(self) -> None:
        """Poll the snapshot once, and show it everywhere."""
        if self.frame is not None:
            with self.frame.desk.window.late.suspended():
                self._look_at_hands(self.frame)
                self.frame.refresh()
                self._wear(self.frame)

    def _look_at_hands(self, frame: Frame) -> None:
        """What is held is held really, and for this page; a release that was lost is made up for."""
        if self._page != frame.page.NAME:
            self._page = frame.page.NAME
            self.keyboard.away()
        self.keyboard.look()
        if QApplication.mouseButtons() is not Qt.MouseButton.NoButton and not self.keyboard.button_held():
            for panel in frame.findChildren(FingerPanel):
                panel.mouse_is_up()

    def press(self, key: str) -> None:
        """Do what a key does; fingers on the screen come here too."""
        frame = self.frame
        action = (frame.key_actions().get(key) if frame else None) or self._keys.get(key)
        if action is not None:
            if frame is not None:
                frame.page.pressed()
                if key != "Esc":  # which removes the answer, and does nothing else then
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
        """Dark to light and back, for a shop with the doors open."""
        if self.frame is not None:
            self.frame.desk.choose_setting("theme", self.frame.desk.settings.following("theme"))

    def _wear(self, frame: Frame) -> None:
        """The colours and the language that are chosen now."""
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
        """The whole screen, or a window again."""
        self._full = full
        if full:
            fill_screen(self)
        else:
            self.showMaximized()

    def open_on(self, screen: QScreen) -> None:
        """As large as it needs to be: a panel that is hardly larger than the least window is filled.

        So is any where no window manager would place it (a title bar that takes some lines of a panel of 600
        would push the function keys off it).
        """
        room = screen.availableGeometry()
        self.setMinimumSize(min(LEAST[0], room.width()), min(LEAST[1], room.height()))
        if self.kiosk or room.height() < LEAST[1] + TITLE_BAR or room.width() <= LEAST[0]:
            fill_screen(self, frameless=self.kiosk)
        elif room.width() < 2 * START_SIZE[0]:
            self.setGeometry(room)  # without a window manager nothing else would
            self.showMaximized()
        else:  # a window among others: a quarter of a large glass
            self.resize(max(START_SIZE[0], room.width() // 2), max(START_SIZE[1], room.height() // 2))
            self.show()

    def _escape(self) -> None:
        """One step back: in the page, then a question or the feed, and from the last step to Automatic."""
        frame = self.frame
        if frame is not None and not (frame.escape() or frame.desk.escape()):
            frame.go(AUTOMATIC)

    def put_away(self) -> None:
        """Stop polling and go, without asking; for scripts that only look."""
        self._timer.stop()
        self.hide()
        self.deleteLater()

    # --- what the keyboard does at once --------------------------------------------------------------

    def hold(self, by: str = "", press: int = 0) -> None:
        """Feed hold, whatever page, field or question has the keyboard; ``by`` which key, for the log."""
        if self.frame is not None:
            self.frame.page.pressed()
            self.frame.desk.feed_hold(by or BY_SCREEN, press)
            self.refresh()

    def estop(self, press: int = 0) -> None:
        """E-stop, whatever page, field or question has the keyboard."""
        if self.frame is not None:
            self.frame.page.pressed()
            self.frame.desk.station.press_estop(press)
            self.refresh()

    def estop_sent(self) -> None:
        """Show the E-stop of the simulated station pressed: the key watcher has pressed it."""
        if self.frame is not None and self.frame.desk.control.panel is not None:
            self.frame.desk.station.press_estop()

    def esc_holds(self) -> bool:
        """Return whether Esc holds the feed now: something moves, and nothing else is offered for Esc."""
        frame = self.frame
        return frame is not None and frame.desk.snapshot().state in MOVING and frame.esc_holds()

    def has_field(self) -> bool:
        """Return whether an entry has the keyboard, and with it all characters."""
        return self.frame is not None and self.frame.has_field()

    def used(self) -> None:
        """A key or a finger: who has signed in is there."""
        if self.frame is not None:
            self.frame.desk.access.used()

    def is_text(self, key: str) -> bool:
        """Whether a character goes to an entry now."""
        return self.frame is not None and self.frame.is_text(key)

    def judge(self, *, late: bool) -> None:
        """Note whether the event that is handled now waited behind a stall: it starts nothing then."""
        if self.frame is not None:
            self.frame.desk.window.late.late = late

    def looks_different(self, at: float) -> bool:
        """Return whether the screen showed something else at this time, so that a touch meant that."""
        seen = [face for since, face in self._faces if since <= at]
        return bool(seen) and self.frame is not None and seen[-1] != self.frame.face

    def drop(self, starting: Starting) -> None:
        """Report a press that waited behind a stall and is not carried out."""
        if self.frame is not None:
            self.frame.desk.window.late.report_dropped(starting)

    def _show_dropped(self, names: tuple[str, ...]) -> None:
        if self.frame is not None:
            text = tr("SCREEN FROZE {seconds} S. NOT DONE: {what}. PRESS AGAIN")
            seconds = f"{self.keyboard.delay:.1f}"
            self.frame.desk.warn(tr(Message(text, seconds=seconds, what=", ".join(names))))

    def stops_at(self, event: QInputEvent) -> bool:
        """Whether a press is on something that stops the machine."""
        dock = self.frame.dock if self.frame is not None else None
        if dock is None or not dock.isVisible() or not isinstance(event, QPointerEvent):
            return False
        places = (dock.mapFromGlobal(point.globalPosition()) for point in event.points())
        return any(dock.stops_at(place) for place in places)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def showEvent(self, _event: QShowEvent) -> None:
        """There is a window now whose keys can be watched."""
        window = self.windowHandle()
        if window is not None:
            self.keyboard.watch(window)
            self._measure()
            window.screenChanged.connect(self._measure)

    def _measure(self) -> None:
        """How large the glass is: rows of lists are told in millimetres."""
        screen = self.screen()
        if screen is not None:
            self.look.measure(screen.physicalDotsPerInch())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """A key goes down. A key that repeats by being held counts once, where once is what is meant."""
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
        """Return whether a key that changes how a cycle runs is typed on another page; say so."""
        if name not in OF_AUTOMATIC or frame.page is frame.automatic or name in frame.page.key_actions():
            return False
        frame.desk.say(tr(Message("{key} WORKS ON THE AUTOMATIC PAGE: PRESS F1, THEN F2", key=name)))
        self.refresh()
        return True

    def _answered(self, frame: Frame, event: QKeyEvent) -> bool:
        """Whether the key was the answer to a question: pressed by itself, after all others were let go."""
        typed = {letter_of(event), typed_of(event)} - {""}
        if not frame.desk.asked or not typed & {frame.desk.asked, "N"}:
            return False
        if "N" in typed and frame.desk.asked != "N":
            self.press(NO)
        elif not event.isAutoRepeat() and self.keyboard.alone(event):
            self.press(ANSWER)
        return True

    def _kept_from(self, frame: Frame, event: QKeyEvent) -> bool:
        """Whether an entry has the keyboard and does not take a character: it is no other key then.

        Neither do Ctrl+H, Ctrl+Space and Ctrl+E stop the machine there.
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
        """Whether the page has taken the key as text."""
        key = typed_of(event)
        if not key or (event.isAutoRepeat() and key not in TYPED_AGAIN) or not frame.page.typed(key):
            return False
        if frame.desk.notice == self._untaken:
            frame.desk.clear()  # the next key was taken
        self.refresh()
        return True

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """A palm, or what a page holds, is let go."""
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
        """Losing the keyboard lets every held button go: the release would be somebody else's to see."""
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
        """Hands off everything that is held."""
        self.keyboard.away()
        if self.frame is not None:
            if self.frame.dock is not None:
                self.frame.dock.let_go()
            self.frame.desk.hands.let_go()
            self.frame.page.let_go()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """The frame fills the window."""
        if self.frame is not None:
            self.frame.setGeometry(self.rect())

    def _may_close(self, frame: Frame) -> bool:
        return self._meant or frame.desk.may_close(self._close)

    def _close(self) -> None:
        """Although something is lost by it."""
        self._meant = True
        self.close()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Not while a program is under way."""
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
