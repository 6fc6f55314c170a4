"""F4 MDI: one line at a time, proved before it may run, with what is in force beside it."""

from __future__ import annotations

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.inforce import rows_of
from app.desk.mdi.mdi import MdiDesk
from app.desk.session import Loaded
from app.desk.view import View
from app.screen.letter_keys import LINES, LetterPad
from app.screen.mdi.history import HistoryPanel
from app.screen.mdi.inforce import InForcePanel
from app.screen.mdi.line import LinePanel
from app.screen.pages import Doings, Host, Page
from core.executor.snapshot import CYCLE, Snapshot, Starts
from core.interpreter.checkpoint import Checkpoint

LINE, STATE = 15.6, 46.0  # units: height of the line, width of what is in force


class MdiPage(Page):
    """The model decides, this only shows it and hands the keys on."""

    NAME = pages.MDI
    LABELS = ("MENU", "AUTO", "", "READOUT", "DRIVES", "RESET", "ALARMS", "SPN STOP", "SECCMP", "")
    STARTS = True

    def __init__(self, host: Host, model: MdiDesk, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self.line = LinePanel(self.look, self._other_hand, self)
        self.history = HistoryPanel(self.look, self._recall, self)
        self.letters = LetterPad(self.look, self._touched, self, LINES)
        self.inforce = InForcePanel(self.look, self)

    def doings(self) -> Doings:
        """Keys of this page alone."""
        return {
            "F2": lambda: self._go(pages.AUTOMATIC),
            "F4": self.desk.next_readout,
            "F5": self.desk.enable,
            "F6": self.desk.reset,
            "F8": self.model.stop_spindle,
            "F9": lambda: self._go(pages.SECCMP),
        }

    def _go(self, name: str) -> None:
        self.host.go(name)

    def _recall(self, back: int) -> None:
        if self.model.has_keyboard:
            self.model.recall(back)

    def _other_hand(self) -> None:
        """A finger on the line: letters to touch in the place of the history, or the history again."""
        self.letters.setVisible(self.letters.isHidden())
        self.letters.raise_()

    def _touched(self, key: str) -> None:
        self.typed(key)

    def typed(self, key: str) -> bool:
        """At rest, text; while a line is under way the letters are the keys they are everywhere."""
        return self.model.typed(key)

    def takes(self, key: str) -> bool:
        """As the model says."""
        return self.model.takes(key)

    def has_field(self) -> bool:
        """The line, while none is under way."""
        return self.model.has_keyboard

    def prompt(self) -> str:
        """From the model."""
        return self.model.prompt(self.desk.snapshot(), self.desk.start_words)

    def opens(self) -> bool:
        """Not while a program is under way."""
        return self.model.opens()

    def opened(self) -> None:
        """Cycle Start now means lines."""
        self.model.opened()

    def leave(self) -> bool:
        """Not while a line is under way."""
        return self.model.leave()

    def escape(self) -> bool:
        """Take back a ready line, then the text."""
        return self.model.escape()

    def refresh(self, snapshot: Snapshot, _view: View, _loaded: Loaded) -> None:
        """The line, what was found, and the state of this instant."""
        model, typing = self.model, self.model.typing
        model.look(snapshot)
        running = snapshot.state in CYCLE and snapshot.starts is Starts.LINE
        text = snapshot.block_text if running and not typing.text else typing.text
        self.line.show_line(text, len(text) if running else typing.at, model.found, model.ready is not None)
        self.history.show_history(typing.history, typing.back)
        angle = snapshot.demand[2] - snapshot.modal.offset_c
        self.inforce.show_rows(rows_of(Checkpoint(snapshot.modal, c=angle)))

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """The line over the history, what is in force at their right."""
        u = self.look.u
        gap, high, state = max(4, round(0.7 * u)), round(LINE * u), round(STATE * u)
        wide = self.width() - state - gap
        self.line.setGeometry(0, 0, wide, high)
        for part in (self.history, self.letters):
            part.setGeometry(0, high + gap, wide, self.height() - high - gap)
        self.inforce.setGeometry(wide + gap, 0, state, self.height())
