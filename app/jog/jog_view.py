"""The Jog page: jog pad at the left, tool setting or manual functions at the right, entry line below."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.jog.hand_functions import (
    CLOSE,
    COOLANT_OFF,
    COOLANT_ON,
    FORWARD,
    OPEN,
    REVERSE,
    SPEED,
    STOP,
)
from app.jog.held_keys_view import CHORDS, HeldKeysPage
from app.jog.jog_model import JogModel
from app.jog.jog_pad_view import JogPad
from app.jog.skim_and_setter import CutStep
from app.jog.tool_setting import TOUCH_X, TOUCH_Z
from app.jog.tool_setting_view import MillJogPanel, ToolPanel
from app.screen import page_table
from app.screen.entry_panel import EntryPanel, EntryWords, KeyPad
from app.screen.look import CENTRE, LEFT, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import FingerPanel, Shown, pressed
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot
from core.message import Message

KEY = 4.5  # Units: height of a key in the strip.
StepKey = tuple[str, str, Callable[[], object]]  # Letter, label and action.


def draw_key(painter: Painter, box: QRectF, letter: str, words: str, *, chosen: bool, on: bool) -> None:
    """Draw a key with its letter, filled if its function is on, and framed if it is selected."""
    u = painter.look.u
    ground, ink = ("run", "on_state") if on else ("here" if chosen else "key", "text")
    painter.box(box, "lit" if chosen else "frame", 0.3 if chosen else 0.16, ground)
    painter.write(
        QRectF(box.x() + 0.8 * u, box.y(), 2.6 * u, box.height()), letter, 1.9, ink if on else "accent"
    )
    painter.write(box.adjusted(3.2 * u, 0, -0.6 * u, 0), words, 2.1, ink, at=CENTRE)


class HandPanel(FingerPanel):
    """The panel of the manual functions. A touch selects a function; the start buttons run it.

    STOP acts immediately, also as a late press.
    """

    _shown: Shown[object] = Shown(None)

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_hand(self, snapshot: Snapshot) -> None:
        """Show which function is selected, prepared or on."""
        hand = self._model.hand
        self._shown = (
            hand.chosen,
            hand.line.ready is not None,
            hand.speed,
            (round(snapshot.rpm_actual), snapshot.rpm_command, snapshot.outputs),
            snapshot.state,
        )

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        self.frame(painter, tr("MANUAL FUNCTIONS  ·  PICK, THEN CYCLE START"))
        u, room, hand = self.look.u, self.inside(), self._model.hand
        rows = 4 if CLOSE in hand.there else 3
        high = (room.height() + 0.6 * u) / rows
        row = QRectF(room.x(), room.y(), room.width(), high - 0.6 * u)
        self._spindle(painter, row)
        on = hand.desk.snapshot()
        turns = on.rpm_command
        row.translate(0, high)
        speed = f"S {hand.speed:g} {tr('RPM')}" if hand.speed else tr("SPEED …")
        self._keys(
            painter,
            row,
            (SPEED, speed, "", False),
            ("1", tr("FORWARD"), FORWARD, turns > 0),
            ("2", tr("REVERSE"), REVERSE, turns < 0),
        )
        row.translate(0, high)
        if COOLANT_ON in hand.there:
            wet = "coolant" in on.outputs
            self._keys(
                painter,
                row,
                ("3", tr("COOLANT ON"), COOLANT_ON, wet),
                ("4", tr("COOLANT OFF"), COOLANT_OFF, False),
            )
        if CLOSE in hand.there:
            row.translate(0, high)
            closed = "collet" in on.outputs
            self._keys(
                painter,
                row,
                ("5", tr("CLOSE COLLET"), CLOSE, closed),
                ("6", tr("OPEN COLLET"), OPEN, not closed),
            )

    def _spindle(self, painter: Painter, row: QRectF) -> None:
        """Draw the state of the spindle, and the key that stops it."""
        u, hand, snapshot = self.look.u, self._model.hand, self._model.desk.snapshot()
        words = tr("SPINDLE STOPPED")
        if hand.turns(snapshot):
            words = tr(Message("SPINDLE TURNING AT {rpm:.0f} RPM", rpm=abs(snapshot.rpm_actual)))
        left = QRectF(row.x(), row.y(), 0.56 * row.width(), row.height())
        painter.write(left, words, 2.4, "pause" if hand.turns(snapshot) else "text", at=LEFT)
        box = QRectF(left.right() + 0.6 * u, row.y(), row.right() - left.right() - 0.6 * u, row.height())
        painter.box(box, "alarm", 0.3, "key")
        painter.write(QRectF(box.x() + 0.8 * u, box.y(), 2.6 * u, box.height()), "0", 1.9, "accent")
        painter.write(box.adjusted(3.2 * u, 0, -0.6 * u, 0), tr("SPINDLE STOP"), 2.4, "alarm", at=CENTRE)
        stop = pressed(box, partial(self._model.press_hand, STOP))
        self.controls.append(stop.stopping())

    def _keys(self, painter: Painter, row: QRectF, *keys: tuple[str, str, str, bool]) -> None:
        u, hand = self.look.u, self._model.hand
        wide = (row.width() + 0.6 * u) / len(keys)
        for number, (letter, words, name, on) in enumerate(keys):
            box = QRectF(row.x() + number * wide, row.y(), wide - 0.6 * u, row.height())
            chosen = hand.chosen == (name or SPEED)
            draw_key(painter, box, letter, words, chosen=chosen, on=on)
            press = partial(self._model.press_hand, name) if name else self._model.ask_speed
            self.controls.append(pressed(box, press))


def strip_keys(look: Look) -> float:
    """Return the height of the strip keys in pixels, at least a fingertip."""
    return max(float(FINGER), KEY * look.u)


class HandStrip(FingerPanel):
    """The strip below tool setting while no question is open, with keys for manual functions and skim cut."""

    _shown: Shown[object] = Shown(None)
    change, foot = Shown(""), Shown("")

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_strip(self, snapshot: Snapshot, change: str, foot: str) -> None:
        """Show the available keys, the last change, and the hint for other keys."""
        skim, hand = self._model.skim, self._model.hand
        self.change, self.foot = change, foot
        self._shown = (skim.step, skim.axis, hand.shown, hand.turns(snapshot))

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        u = self.look.u
        painter.fill(self.area(), "ground")
        keys = self._keys()
        room = self.area()
        low = self.height() - strip_keys(self.look)
        wide = (room.width() + 0.6 * u) / len(keys)
        for number, (letter, words, press) in enumerate(keys):
            box = QRectF(room.x() + number * wide, low, wide - 0.6 * u, room.bottom() - low)
            draw_key(painter, box, letter, words, chosen=False, on=False)
            self.controls.append(pressed(box, partial(self._press, press)))
        text = QRectF(room.x() + u, room.y(), room.width() - 2 * u, low - 0.3 * u)
        if self._model.skim.open or not self.change:
            painter.write(text, self.foot, 1.8, "soft", bold=False)
        else:
            painter.write(text, self.change, 1.8, "accent")

    def _press(self, press: Callable[[], object]) -> None:
        self._model.hold.other_key()
        press()

    def _keys(self) -> tuple[StepKey, ...]:
        model, skim = self._model, self._model.skim
        leave: StepKey = ("Esc", tr("CANCEL"), skim.escape)
        hand: StepKey = (
            "B",
            tr("TOOL SETTING") if model.hand.shown else tr("MANUAL FUNCTIONS"),
            model.show_hand,
        )
        if skim.step is CutStep.AXIS:
            return (
                ("X", tr("DIAMETER"), partial(skim.choose, TOUCH_X)),
                ("Z", tr("FACE"), partial(skim.choose, TOUCH_Z)),
                leave,
            )
        if skim.step is CutStep.CUT:
            return (hand, ("↵", tr("CUT DONE"), skim.made), leave)
        if skim.step is CutStep.AWAY:
            return (hand, ("0", tr("SPINDLE STOP"), partial(model.press_hand, STOP)), leave)
        return (hand,) if model.on_mill else (hand, ("C", tr("SKIM CUT"), skim.begin))


# Width fraction of the pad; height of the entry line and of a text line in units.
WIDE, ASKED, WORDS = 0.46, 12.0, 2.6


class JogPage(HeldKeysPage):
    """The Jog page. ``refresh`` renews the jog, so that a stall of the screen ends the motion."""

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
        machine = host.desk.machine.model
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
        """Return the key labels. A mill touches off on the pages of tools and presets."""
        labels = super().labels()
        return (*labels[:3], "", "3D-ROT", "", *labels[6:]) if self.model.on_mill else labels

    def other_key(self, event: QKeyEvent) -> bool:
        """Handle the Home key, which asks which axes to home."""
        if event.key() != Qt.Key.Key_Home or event.isAutoRepeat() or event.modifiers() & CHORDS:
            return False
        self.model.home_key()
        return True

    def key_actions(self) -> KeyActions:
        """Return the key actions: steps, speeds, readout, touch-off and undo."""
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
        """Return the disabled keys of touch-off, undo and tilted plane."""
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
        """Return whether a value of the tool or the spindle speed is being entered."""
        return self.model.asked

    # --- page ----------------------------------------------------------------------------------------

    def prompt(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt(self.desk.snapshot())

    def leave(self) -> bool:
        """Release all keys, and return whether the page can close. It cannot while a line runs."""
        self.pad.let_go()
        return self.model.leave()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Update the model, which renews the jog, and show its state."""
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
        """Show the open question, or the keys that are available without a question."""
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
        """Lay out the pad at the left, and the tool above the entry line at the right."""
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
