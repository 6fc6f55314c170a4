"""Jog page with the jog pad on the left, and tool setting or manual functions on the right.

The entry line is at the bottom on the right.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.jog.held_keys_view import CHORD_MODIFIERS, HeldKeysPage
from app.jog.jog_model import JogModel
from app.jog.jog_pad_view import JogPad
from app.jog.manual_functions import (
    CLOSE,
    COOLANT_OFF,
    COOLANT_ON,
    FORWARD,
    MANUAL_KEYS,
    OPEN,
    REVERSE,
    SPEED_KEY,
    STOP,
)
from app.jog.skim_cut_and_setter import SkimCutStep
from app.jog.tool_setting_view import MillJogPanel, ToolSettingPanel
from app.jog.tool_touch_off import TOUCH_X, TOUCH_Z
from app.screen import page_table
from app.screen.entry_panel import EntryPanel, EntryTexts, NumberPad
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import RedrawingAttribute, TouchPanel, make_press_control
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot
from core.message import Message

KEY_HEIGHT = 4.5  # Units: height of a key in the strip.
StripKey = tuple[str, str, Callable[[], object]]  # Letter, label and action.


def draw_function_key(
    painter: ThemedPainter, box: QRectF, key_letter: str, label: str, *, is_selected: bool, is_on: bool
) -> None:
    """Draw the key of a manual function with its letter and its label.

    The key is filled if its function is on, and framed if its function is selected.
    """
    u = painter.theme.unit_px
    ground, ink = ("run", "on_state") if is_on else ("here" if is_selected else "key", "text")
    painter.draw_box(box, "lit" if is_selected else "frame", 0.3 if is_selected else 0.16, ground)
    painter.draw_text_line(
        QRectF(box.x() + 0.8 * u, box.y(), 2.6 * u, box.height()), key_letter, 1.9, ink if is_on else "accent"
    )
    painter.draw_text_line(box.adjusted(3.2 * u, 0, -0.6 * u, 0), label, 2.1, ink, at=ALIGN_CENTER)


class ManualFunctionPanel(TouchPanel):
    """Panel of the manual functions.

    A touch selects a function, and the start buttons run it. STOP takes effect immediately, even if the
    press arrives late. The keys have no letters while an entry is open, because the keyboard then types.
    """

    _shown: RedrawingAttribute[object] = RedrawingAttribute(None)

    def __init__(self, theme: ScreenTheme, model: JogModel, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._model = model

    def show_functions(self, snapshot: Snapshot) -> None:
        """Update which manual functions are displayed as selected, prepared or on."""
        hand = self._model.manual_functions
        self._shown = (
            hand.selected_function,
            hand.prepared_line.ready_job is not None,
            hand.start_speed_rpm,
            self._model.is_entry_open,
            (round(snapshot.rpm_actual), snapshot.rpm_command, snapshot.outputs),
            snapshot.state,
        )

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the keys for spindle, coolant and collet, and set their touch targets.

        The coolant and collet keys are drawn only if the machine has these functions.
        """
        self.controls.clear()
        self.frame(painter, tr("MANUAL FUNCTIONS  ·  PICK, THEN CYCLE START"))
        u, hand = self.theme.unit_px, self._model.manual_functions
        room = self.inside().adjusted(0, -0.4 * u, 0, 0.6 * u)
        rows = 4 if CLOSE in hand.available_functions else 3
        high = (room.height() + 0.6 * u) / rows
        row = QRectF(room.x(), room.y(), room.width(), high - 0.6 * u)
        self._draw_spindle(painter, row)
        on = hand.desk.read_snapshot()
        turns = on.rpm_command
        row.translate(0, high)
        speed = f"S {hand.start_speed_rpm:g} {tr('RPM')}" if hand.start_speed_rpm else tr("SPEED …")
        self._keys(
            painter,
            row,
            (SPEED_KEY, speed, "", False),
            ("1", tr("FORWARD"), FORWARD, turns > 0),
            ("2", tr("REVERSE"), REVERSE, turns < 0),
        )
        row.translate(0, high)
        if COOLANT_ON in hand.available_functions:
            wet = "coolant" in on.outputs
            self._keys(
                painter,
                row,
                ("3", tr("COOLANT ON"), COOLANT_ON, wet),
                ("4", tr("COOLANT OFF"), COOLANT_OFF, False),
            )
        if CLOSE in hand.available_functions:
            row.translate(0, high)
            closed = "collet" in on.outputs
            self._keys(
                painter,
                row,
                ("5", tr("CLOSE COLLET"), CLOSE, closed),
                ("6", tr("OPEN COLLET"), OPEN, not closed),
            )

    def _draw_spindle(self, painter: ThemedPainter, row: QRectF) -> None:
        """Draw the state of the spindle and the key that stops the spindle."""
        u, hand, snapshot = self.theme.unit_px, self._model.manual_functions, self._model.desk.read_snapshot()
        words = tr("SPINDLE STOPPED")
        if hand.is_spindle_turning(snapshot):
            words = tr(Message("SPINDLE TURNING AT {rpm:.0f} RPM", rpm=abs(snapshot.rpm_actual)))
        left = QRectF(row.x(), row.y(), 0.56 * row.width(), row.height())
        painter.draw_text_line(
            left, words, 2.4, "pause" if hand.is_spindle_turning(snapshot) else "text", at=ALIGN_LEFT
        )
        box = QRectF(left.right() + 0.6 * u, row.y(), row.right() - left.right() - 0.6 * u, row.height())
        painter.draw_box(box, "alarm", 0.3, "key")
        letter_box = QRectF(box.x() + 0.8 * u, box.y(), 2.6 * u, box.height())
        painter.draw_text_line(letter_box, self._find_letter("0"), 1.9, "accent")
        painter.draw_text_line(
            box.adjusted(3.2 * u, 0, -0.6 * u, 0), tr("SPINDLE STOP"), 2.4, "alarm", at=ALIGN_CENTER
        )
        stop = make_press_control(box, partial(self._model.select_manual_function, STOP))
        self.controls.append(stop.make_stop_control())

    def _find_letter(self, letter: str) -> str:
        """Return the letter of a key, or an empty string while the letter belongs to an entry."""
        return "" if self._model.is_entry_open else letter

    def _keys(self, painter: ThemedPainter, row: QRectF, *keys: tuple[str, str, str, bool]) -> None:
        u, hand = self.theme.unit_px, self._model.manual_functions
        wide = (row.width() + 0.6 * u) / len(keys)
        for number, (letter, words, name, on) in enumerate(keys):
            box = QRectF(row.x() + number * wide, row.y(), wide - 0.6 * u, row.height())
            chosen = hand.selected_function == (name or SPEED_KEY)
            draw_function_key(painter, box, self._find_letter(letter), words, is_selected=chosen, is_on=on)
            press = (
                partial(self._model.select_manual_function, name)
                if name
                else self._model.ask_for_spindle_speed
            )
            self.controls.append(make_press_control(box, press))


def find_strip_key_height(theme: ScreenTheme) -> float:
    """Return the height of the keys in the strip in pixels, at least that of a fingertip."""
    return max(float(FINGERTIP_PX), KEY_HEIGHT * theme.unit_px)


class ManualFunctionStrip(TouchPanel):
    """Strip with the keys for manual functions and skim cuts, below the tool setting panel.

    The strip is hidden while a question is open.
    """

    _shown: RedrawingAttribute[object] = RedrawingAttribute(None)
    change_text, footer_text = RedrawingAttribute(""), RedrawingAttribute("")

    def __init__(self, theme: ScreenTheme, model: JogModel, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._model = model

    def show_keys(self, snapshot: Snapshot, change_text: str, footer_text: str) -> None:
        """Show the available keys, the last offset change, and the hint about further keys."""
        skim, hand = self._model.skim_cut, self._model.manual_functions
        self.change_text, self.footer_text = change_text, footer_text
        self._shown = (
            skim.cut_step,
            skim.measured_axis,
            hand.is_panel_shown,
            hand.is_spindle_turning(snapshot),
        )

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the keys for manual functions and skim cut, with the last offset change or the hint above."""
        self.controls.clear()
        u = self.theme.unit_px
        painter.fill_rect(self.find_full_area(), "ground")
        keys = self._keys()
        room = self.find_full_area()
        low = self.height() - find_strip_key_height(self.theme)
        wide = (room.width() + 0.6 * u) / len(keys)
        for number, (letter, words, press) in enumerate(keys):
            box = QRectF(room.x() + number * wide, low, wide - 0.6 * u, room.bottom() - low)
            draw_function_key(painter, box, letter, words, is_selected=False, is_on=False)
            control = make_press_control(box, partial(self._press, press))
            is_stop = MANUAL_KEYS.get(letter) == STOP
            self.controls.append(control.make_stop_control() if is_stop else control)
        text = QRectF(room.x() + u, room.y(), room.width() - 2 * u, low - 0.3 * u)
        if self._model.skim_cut.is_in_progress or not self.change_text:
            painter.draw_text_line(text, self.footer_text, 1.8, "soft", bold=False)
        else:
            painter.draw_text_line(text, self.change_text, 1.8, "accent")

    def _press(self, press: Callable[[], object]) -> None:
        self._model.held_jog.stop_for_other_key()
        press()

    def _keys(self) -> tuple[StripKey, ...]:
        model, skim = self._model, self._model.skim_cut
        leave: StripKey = ("Esc", tr("CANCEL"), skim.handle_escape)
        hand: StripKey = (
            "B",
            tr("TOOL SETTING") if model.manual_functions.is_panel_shown else tr("MANUAL FUNCTIONS"),
            model.toggle_manual_functions,
        )
        if skim.cut_step is SkimCutStep.CHOOSE_AXIS:
            return (
                ("X", tr("DIAMETER"), partial(skim.select_cut_type, TOUCH_X)),
                ("Z", tr("FACE"), partial(skim.select_cut_type, TOUCH_Z)),
                leave,
            )
        if skim.cut_step is SkimCutStep.CUTTING:
            return (hand, ("↵", tr("CUT DONE"), skim.finish_cut), leave)
        if skim.cut_step is SkimCutStep.RETRACT:
            return (hand, ("0", tr("SPINDLE STOP"), partial(model.select_manual_function, STOP)), leave)
        return (hand,) if model.is_mill else (hand, ("C", tr("SKIM CUT"), skim.begin_skim_cut))


# Width fraction of the pad; height of the entry line and of a text line in units.
WIDE, ASKED, WORDS = 0.46, 12.0, 2.6


class JogPage(HeldKeysPage):
    """Screen page for manual axis motion.

    ``refresh`` renews the motion lease of the jog. If the screen stalls, the lease expires and the motion
    stops.
    """

    NAME = page_table.JOG
    CAN_START_CYCLES = True
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

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        machine = host.desk.machine.machine
        if machine is None:
            raise RuntimeError("the desk was put together without a machine to move by hand")
        super().__init__(host, JogModel(host.desk, machine), parent)
        self.jog_cross: JogPad = JogPad(self.theme, self.model, self)
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=None, parent=self)
        self.mill_panel = MillJogPanel(self.theme, self.model, self._to_tools, self._to_presets, self)
        self.tool_panel = ToolSettingPanel(self.theme, self.model, self)
        self.entry_panel = EntryPanel(self.theme, self)
        self.manual_panel = ManualFunctionPanel(self.theme, self.model, self)
        self.manual_strip = ManualFunctionStrip(self.theme, self.model, self)

    def _to_tools(self) -> None:
        self.host.open_page(page_table.TOOLS)

    def _to_presets(self) -> None:
        self.host.open_page(page_table.SECCMP)

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of the function keys.

        A mill has no touch-off keys here, because tools and presets are set on their own pages.
        """
        labels = super().make_key_labels()
        return (*labels[:3], "", "3D-ROT", "", *labels[6:]) if self.model.is_mill else labels

    def handle_other_key(self, event: QKeyEvent) -> bool:
        """Handle the Home key by asking which axes to home, and return whether the key was used."""
        if event.key() != Qt.Key.Key_Home or event.isAutoRepeat() or event.modifiers() & CHORD_MODIFIERS:
            return False
        self.model.handle_home_key()
        return True

    def make_key_actions(self) -> KeyActions:
        """Return the key actions for steps, speeds, readout, touch-off and undo."""
        model = self.model
        common: KeyActions = {
            "F2": model.select_next_step,
            "F3": model.select_next_speed,
            "F8": partial(self.host.open_page, page_table.TOOLS),
            "F9": partial(self.host.open_page, page_table.SECCMP),
            "F10": self.desk.select_next_readout,
        }
        if model.is_mill:
            return {**common, "F5": model.toggle_tilted_jog}
        touch = {"F5": lambda: model.ask_tool_value(TOUCH_X), "F6": lambda: model.ask_tool_value(TOUCH_Z)}
        return {**common, **touch, "F4": model.tool_setting.ask_to_undo_change}

    def make_stop_key_actions(self) -> KeyActions:
        """Return the action of 0, which stops the spindle unless it is a digit of an entry."""
        return {} if self.model.is_entry_open else {"0": partial(self.model.select_manual_function, STOP)}

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the function keys of this page that are currently disabled.

        On a lathe, the touch-off keys F5 and F6 and the undo key F4 can be disabled. On a mill, the key F5
        (3D-ROT) can be disabled.
        """
        model, snapshot = self.model, self.desk.read_snapshot()
        if model.is_mill:
            return frozenset() if model.tilted_jog.is_available(snapshot) else frozenset({"F5"})
        found = {
            "F5": model.tool_setting.find_refusal(TOUCH_X, snapshot),
            "F6": model.tool_setting.find_refusal(TOUCH_Z, snapshot),
            "F4": model.tool_setting.find_undo_refusal()
            or not model.tool_setting.offset_history.can_undo(model.tool_setting.tool_number),
        }
        return frozenset(key for key, why in found.items() if why)

    def needs_height(self) -> bool:
        """Return whether the number pad is shown."""
        return self.model.is_entry_open

    def has_text_field(self) -> bool:
        """Return whether the operator is entering a tool value or the spindle speed."""
        return self.model.is_entry_open

    # --- page ----------------------------------------------------------------------------------------

    def prompt_text(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt_text(self.desk.read_snapshot())

    def try_leave_page(self) -> bool:
        """Release all keys, and return whether the page can close.

        The page cannot close while an MDI line is running.
        """
        self.jog_cross.release_all_controls()
        return self.model.try_leave()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Update the model, which renews the motion lease of the jog, and show its state."""
        if not self._has_keyboard():
            self.stop_if_active()
        self.model.update(snapshot)
        entering = self.model.is_entry_open
        self.jog_cross.setVisible(not entering)
        self.number_pad.setVisible(entering)
        self.number_pad.selected_page_key = (
            ("L", tr("THIS TOOL ONLY")) if self.model.tool_setting.is_master_touch_off else None
        )
        self.jog_cross.show_state(snapshot)
        functions = self._are_functions_shown(snapshot)
        self.manual_panel.setVisible(functions)
        self.mill_panel.setVisible(self.model.is_mill and not functions)
        self.tool_panel.setVisible(not self.model.is_mill and not functions)
        if entering is self.entry_panel.isHidden():
            self.entry_panel.setVisible(entering)
            self._arrange_parts()
        self.manual_strip.setVisible(not entering)
        self.manual_panel.show_functions(snapshot)
        if self.model.is_mill:
            self.mill_panel.show_state(snapshot)
        else:
            self.tool_panel.show_tool(snapshot)
        self._show_question(snapshot)

    def _are_functions_shown(self, snapshot: Snapshot) -> bool:
        """Return whether the manual functions are shown.

        The picture of a touch-off replaces them, unless the operator needs the key that stops the spindle.
        """
        hand = self.model.manual_functions
        has_picture = self.model.touch_off_pictures.picture is not None
        return hand.is_panel_shown and (not has_picture or hand.is_spindle_turning(snapshot))

    def _show_question(self, snapshot: Snapshot) -> None:
        """Show the open question, or the available keys if no question is open."""
        tool, hand = self.model.tool_setting, self.model.manual_functions
        if hand.is_asking_speed:
            foot = tr("Enter: accept   Esc: cancel")
            self.entry_panel.entry_texts = EntryTexts("", tr("SPINDLE SPEED, RPM?"), hand.text, "", foot)
            return
        foot = tool.make_note_text() or (
            tr("Enter: accept   Esc: cancel")
            if self.model.is_entry_open
            else tr("T tool · X Z touch off · W wear · N nose radius · Q tip · K remark · M master · F4 undo")
        )
        if self.model.is_mill:
            foot = ""
        text = tool.touch_off.change_reason if tool.is_tool_setter_result else tool.text
        self.entry_panel.entry_texts = EntryTexts(
            "", tool.make_question_text(), text, tool.describe_change(), foot
        )
        self.manual_strip.show_keys(snapshot, tool.offset_history.last_change_text, foot)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the parts of the page for its new size."""
        self._arrange_parts()

    def _arrange_parts(self) -> None:
        """Arrange the jog pad on the left, and the tool panel above the entry line on the right."""
        u, gap = self.theme.unit_px, max(4, round(0.7 * self.theme.unit_px))
        left = round(WIDE * self.width())
        for part in (self.jog_cross, self.number_pad):
            part.setGeometry(0, 0, left, self.height())
        wide, asked = self.width() - left - gap, round(ASKED * u)
        strip = round(find_strip_key_height(self.theme) + WORDS * u)
        sides: tuple[tuple[QWidget, int], ...] = (
            (self.tool_panel, strip if self.entry_panel.isHidden() else asked),
            (self.mill_panel, strip),
            (self.manual_panel, strip if self.entry_panel.isHidden() else asked),
        )
        for side, foot in sides:
            side.setGeometry(left + gap, 0, wide, self.height() - foot - gap)
        self.entry_panel.setGeometry(left + gap, self.height() - asked, wide, asked)
        self.manual_strip.setGeometry(left + gap, self.height() - strip, wide, strip)
