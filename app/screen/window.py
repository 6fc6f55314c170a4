"""The main window: takes the keys, polls the snapshot once a frame, and lets go of everything it holds."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QEvent, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import UNDER_WAY, Desk
from app.desk.prompts import LATER
from app.screen.keys import PALMS, REPEATING, name_of
from app.screen.layout import LEAST
from app.screen.look import Look, dress
from app.screen.page import AutomaticPage
from app.screen.theme import DARK, LIGHT

FRAME_MS = 16  # at most 60 pictures a second


def _nobody() -> None:
    """Nobody has to be told."""


class MainWindow(QWidget):
    """One page at a time; without a desk yet it shows that it is starting."""

    def __init__(self, look: Look, closed: Callable[[], None] = _nobody) -> None:
        super().__init__()
        self._closed = closed
        self.look = look
        self.page: AutomaticPage | None = None
        self._keys: dict[str, Callable[[], None]] = {}
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.refresh)
        self.setWindowTitle("TurnDesk")
        self.setMinimumSize(*LEAST)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def open_desk(self, desk: Desk) -> None:
        """Put the desk on the screen and begin to poll it."""
        self.page = AutomaticPage(self.look, desk, self.press, self)
        self._keys = self._table(self.page, desk)
        self.page.setGeometry(self.rect())
        self.refresh()
        self.page.show()
        self.setFocus()
        self._timer.start(FRAME_MS)

    def refresh(self) -> None:
        """Once a frame."""
        if self.page is not None:
            self.page.refresh()

    def press(self, key: str) -> None:
        """Do what a key does; fingers on the screen come here too."""
        action = self._keys.get(key)
        if action is not None:
            action()
            self.refresh()

    def _table(self, page: AutomaticPage, desk: Desk) -> dict[str, Callable[[], None]]:
        return {
            **{key: partial(desk.later, key) for key in LATER},
            **page.doings(),
            "S": partial(desk.switch, "single_block"),
            "O": partial(desk.switch, "optional_stop"),
            "C": partial(desk.switch, "cycle_repeat"),
            "/": desk.block_delete,
            "H": desk.feed_hold,
            "R": desk.reset,
            "D": desk.enable,
            "E": partial(desk.hands.estop, pressed=True),
            "Shift E": partial(desk.hands.estop, pressed=False),
            "A": desk.turn_spindle_switch,
            ",": partial(desk.hands.turn_spindle_pot, -1),
            ".": partial(desk.hands.turn_spindle_pot, 1),
            "+": partial(desk.override, 1),
            "-": partial(desk.override, -1),
            "T": self.other_theme,
            "Esc": self._escape,
        }

    def other_theme(self) -> None:
        """Dark to light and back, for a shop with the doors open."""
        wanted = LIGHT if self.look.palette.name == DARK.name else DARK
        self.look.repaint(wanted)
        dress(wanted)
        if self.page is not None:
            self.page.dress()

    def _escape(self) -> None:
        if self.page is not None and not self.page.escape():
            self.page.desk.escape()

    def put_away(self) -> None:
        """Stop polling and go, without asking; for scripts that only look."""
        self._timer.stop()
        self.hide()
        self.deleteLater()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """A key goes down. A key that repeats by being held counts once, where once is what is meant."""
        page = self.page
        if page is None:
            return
        if not event.isAutoRepeat() and event.key() in PALMS and not page.files.isVisible():
            self._palm(PALMS[Qt.Key(event.key())], down=True)
            return
        name = name_of(event.key(), event.modifiers())
        if name and (name in REPEATING or not event.isAutoRepeat()):
            self.press(name)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """A palm is let go."""
        if not event.isAutoRepeat() and event.key() in PALMS:
            self._palm(PALMS[Qt.Key(event.key())], down=False)

    def _palm(self, side: str, *, down: bool) -> None:
        if self.page is not None:
            desk = self.page.desk
            if desk.two_hand:
                desk.hands.palm(side, down)
            elif down and side == "right":
                desk.start_button()
            self.refresh()

    def changeEvent(self, event: QEvent) -> None:
        """Losing the keyboard lets every held button go: the release would be somebody else's to see."""
        if event.type() == QEvent.Type.ActivationChange and not self.isActiveWindow():
            self.let_go()
        super().changeEvent(event)

    def let_go(self) -> None:
        """Hands off everything that is held."""
        if self.page is not None:
            if self.page.dock is not None:
                self.page.dock.let_go()
            self.page.desk.hands.let_go()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """The page fills the window."""
        if self.page is not None:
            self.page.setGeometry(self.rect())

    def closeEvent(self, event: QCloseEvent) -> None:
        """Not while a program is under way."""
        page = self.page
        if page is not None and page.desk.snapshot().state in UNDER_WAY:
            page.desk.say("A PROGRAM IS UNDER WAY: STOP IT AND PRESS R BEFORE LEAVING")
            self.refresh()
            event.ignore()
            return
        self._timer.stop()
        self.let_go()
        event.accept()
        self._closed()
