"""The Jog page: held moves at the left, tool setting at the right, the question under it."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.jog.hand_functions_view import HandPanel, HandStrip, strip_keys
from app.jog.held_keys_view import CHORDS, HeldKeysPage
from app.jog.jog_model import JogModel
from app.jog.jog_pad_view import JogPad
from app.jog.tool_setting import TOUCH_X, TOUCH_Z
from app.jog.tool_setting_view import MillJogPanel, ToolPanel
from app.screen import page_table
from app.screen.entry_panel import EntryPanel, EntryWords, KeyPad
from app.screen.page_base import Host, KeyActions
from core.executor.snapshot import Snapshot

Key = Qt.Key
WIDE, ASKED, WORDS = 0.46, 12.0, 2.6  # share of the pad, height of the question and of a line, units


class JogPage(HeldKeysPage):
    """What is held is renewed from ``refresh``: a screen that stands still moves nothing for longer."""

    NAME = page_table.JOG
    STARTS = True
    LABELS = (
        "MENU",
        "STEP",
        "SPEED",
        "UNDO",
        "TOUCH X",
        "TOUCH Z",
        "ALARMS",
        "TOOLS",
        "SECCMP",
        "READOUT",
    )

    model: JogModel

    def __init__(self, host: Host, parent: QWidget) -> None:
        machine = host.desk.lathe
        if machine is None:
            raise RuntimeError("the desk was put together without a machine to move by hand")
        super().__init__(host, JogModel(host.desk, machine), parent)
        self.pad: JogPad = JogPad(self.look, self.model, self)
        self.numbers = KeyPad(self.look, self.touched, own=None, parent=self)
        self.mill = MillJogPanel(self.look, self.model, self._to_tools, self._to_presets, self)
        self.tool = ToolPanel(self.look, self.model, self)
        self.asked = EntryPanel(self.look, self)
        self.hand = HandPanel(self.look, self.model, self)
        self.strip = HandStrip(self.look, self.model, self)

    def _to_tools(self) -> None:
        self.host.go(page_table.TOOLS)

    def _to_presets(self) -> None:
        self.host.go(page_table.SECCMP)

    def labels(self) -> tuple[str, ...]:
        """A mill touches off on the pages of tools and presets."""
        labels = super().labels()
        return (*labels[:3], "", "3D-ROT", "", *labels[6:]) if self.model.on_mill else labels

    def other_key(self, event: QKeyEvent) -> bool:
        """Home asks, and again homes."""
        if event.key() != Key.Key_Home or event.isAutoRepeat() or event.modifiers() & CHORDS:
            return False
        self.model.home_key()
        return True

    def key_actions(self) -> KeyActions:
        """Steps, speeds, readout, touching off, undo."""
        model = self.model
        common: KeyActions = {
            "F2": model.next_step,
            "F3": model.next_speed,
            "F8": partial(self.host.go, page_table.TOOLS),
            "F9": partial(self.host.go, page_table.SECCMP),
            "F10": self.desk.next_readout,
        }
        if model.on_mill:
            return {**common, "F5": model.turn_tilt}
        touch = {"F5": lambda: model.ask(TOUCH_X), "F6": lambda: model.ask(TOUCH_Z)}
        return {**common, **touch, "F4": model.tool.undo}

    def barred(self) -> frozenset[str]:
        """Return the keys of touching off, of undo and of the tilted plane while they would be refused."""
        model, snapshot = self.model, self.desk.snapshot()
        if model.on_mill:
            return frozenset() if model.tilt.turns(snapshot) else frozenset({"F5"})
        found = {
            "F5": model.tool.barred(TOUCH_X, snapshot),
            "F6": model.tool.barred(TOUCH_Z, snapshot),
            "F4": model.tool.undo_barred() or not model.tool.history.undoable(model.tool.number),
        }
        return frozenset(key for key, why in found.items() if why)

    def has_field(self) -> bool:
        """A question about the tool, or the spindle speed."""
        return self.model.asked

    # --- as every page -------------------------------------------------------------------------------

    def prompt(self) -> str:
        """What the model has to say on the prompt line."""
        return self.model.prompt(self.desk.snapshot())

    def leave(self) -> bool:
        """Nothing stays held or half entered; not while a line is under way."""
        self.pad.let_go()
        return self.model.leave()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Renew what is held, show what is so."""
        if not self._has_keyboard():
            self.let_go_if_held()
        self.model.look(snapshot)
        entering, hand = self.model.asked, self.model.hand
        self.pad.setVisible(not entering)
        self.numbers.setVisible(entering)
        self.numbers.own = ("L", tr("THIS TOOL ONLY")) if self.model.tool.masters else None
        self.pad.show_jog(snapshot)
        self.hand.setVisible(hand.shown)
        self.mill.setVisible(self.model.on_mill and not hand.shown)
        self.tool.setVisible(not self.model.on_mill and not hand.shown)
        self.asked.setVisible(entering)
        self.strip.setVisible(not entering)
        self.hand.show_hand(snapshot)
        if self.model.on_mill:
            self.mill.show_mill(snapshot)
        else:
            self.tool.show_tool(snapshot)
        self._show_question(snapshot)

    def _show_question(self, snapshot: Snapshot) -> None:
        """What is asked; while nothing is, what else can be opened here."""
        tool, hand = self.model.tool, self.model.hand
        if hand.asked:
            foot = tr("Enter: accept   Esc: cancel")
            self.asked.asked = EntryWords("", tr("SPINDLE SPEED, RPM?"), hand.text, "", foot)
            return
        foot = tool.note() or (
            tr("Enter: accept   Esc: cancel")
            if self.model.asked
            else tr("T tool · X Z touch off · W wear · N nose radius · Q tip · K remark · M master · F4 undo")
        )
        if self.model.on_mill:
            foot = ""
        text = tool.touching.cause if tool.by_setter else tool.text
        self.asked.asked = EntryWords("", tool.question(), text, tool.old_to_new(), foot)
        self.strip.show_strip(snapshot, tool.history.last_in_words, foot)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Pad at the left; tool over question at the right."""
        u, gap = self.look.u, max(4, round(0.7 * self.look.u))
        left = round(WIDE * self.width())
        for part in (self.pad, self.numbers):
            part.setGeometry(0, 0, left, self.height())
        wide, asked = self.width() - left - gap, round(ASKED * u)
        strip = round(strip_keys(self.look) + WORDS * u)
        sides: tuple[tuple[QWidget, int], ...] = ((self.tool, asked), (self.mill, strip), (self.hand, asked))
        for side, foot in sides:
            side.setGeometry(left + gap, 0, wide, self.height() - foot - gap)
        self.asked.setGeometry(left + gap, self.height() - asked, wide, asked)
        self.strip.setGeometry(left + gap, self.height() - strip, wide, strip)
