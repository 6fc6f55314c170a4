"""The Jog page: held moves at the left, tool setting at the right, the question under it."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.machine_status import MachineStatus
from app.desk.program_loading import Loaded
from app.desk.translation import tr
from app.jog.held_keys_view import CHORDS, HeldKeysPage
from app.jog.jog_model import JogModel
from app.jog.jog_pad_view import JogPad
from app.jog.jog_touch_off import TOUCH_X, TOUCH_Z
from app.jog.tool_setting_view import ToolPanel
from app.screen import page_table
from app.screen.entry_panel import EntryPanel, EntryWords, KeyPad
from app.screen.page_base import Host, KeyActions
from core.executor.snapshot import Snapshot

Key = Qt.Key
WIDE, ASKED = 0.46, 12.0  # share of the pad, height of the question in units


class JogPage(HeldKeysPage):
    """What is held is renewed from ``refresh``: a screen that stands still moves nothing for longer."""

    NAME = page_table.JOG
    LABELS = (
        "MENU",
        "STEP",
        "SPEED",
        "READOUT",
        "TOUCH X",
        "TOUCH Z",
        "ALARMS",
        "TOOLS",
        "SECCMP",
        "UNDO",
    )

    model: JogModel

    def __init__(self, host: Host, parent: QWidget) -> None:
        machine = host.desk.lathe
        if machine is None:
            raise RuntimeError("the desk was put together without a machine to move by hand")
        super().__init__(host, JogModel(host.desk, machine), parent)
        self.pad: JogPad = JogPad(self.look, self.model, self)
        self.numbers = KeyPad(self.look, self.touched, own=("L", tr("ALONE")), parent=self)
        self.tool = ToolPanel(self.look, self.model, self)
        self.asked = EntryPanel(self.look, self)

    def other_key(self, event: QKeyEvent) -> bool:
        """Home asks, and again homes."""
        if event.key() != Key.Key_Home or event.isAutoRepeat() or event.modifiers() & CHORDS:
            return False
        self.model.home_key()
        return True

    def key_actions(self) -> KeyActions:
        """Steps, speeds, readout, touching off, undo."""
        model = self.model
        return {
            "F2": model.next_step,
            "F3": model.next_speed,
            "F4": self.desk.next_readout,
            "F5": lambda: model.ask(TOUCH_X),
            "F6": lambda: model.ask(TOUCH_Z),
            "F8": partial(self.host.go, page_table.TOOLS),
            "F9": partial(self.host.go, page_table.SECCMP),
            "F10": model.tool.undo,
        }

    def has_field(self) -> bool:
        """A question about the tool."""
        return bool(self.model.tool.asked)

    # --- as every page -------------------------------------------------------------------------------

    def prompt(self) -> str:
        """What the model has to say on the prompt line."""
        return self.model.prompt(self.desk.snapshot())

    def leave(self) -> bool:
        """Nothing stays held or half entered."""
        self.pad.let_go()
        self.model.leave()
        return True

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Renew what is held, show what is so."""
        if not self._has_keyboard():
            self.let_go_if_held()
        self.model.look(snapshot)
        tool = self.model.tool
        entering = bool(tool.asked)
        self.pad.setVisible(not entering)
        self.numbers.setVisible(entering)
        self.pad.show_jog(snapshot)
        self.tool.show_tool(snapshot)
        foot = tool.note() or (
            tr("Return enters it, Esc leaves it as it was")
            if entering
            else tr("T tool · X Z touch · W wear · N nose · Q tip · K remark · M master · F10 undo")
        )
        text = tool.touching.cause if tool.by_setter else tool.text
        self.asked.asked = EntryWords("", tool.question(), text, tool.old_to_new(), foot, tool.large)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Pad at the left; tool over question at the right."""
        u, gap = self.look.u, max(4, round(0.7 * self.look.u))
        left = round(WIDE * self.width())
        for part in (self.pad, self.numbers):
            part.setGeometry(0, 0, left, self.height())
        high, wide = round(ASKED * u), self.width() - left - gap
        self.tool.setGeometry(left + gap, 0, wide, self.height() - high - gap)
        self.asked.setGeometry(left + gap, self.height() - high, wide, high)
