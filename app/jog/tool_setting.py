"""Tool setting on the Jog page: select a tool, touch it off, and enter its other values."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.arithmetic import EXPRESSION_CHARACTERS, MAX_LENGTH, InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import apply_edit_key, refused
from app.desk.translation import tr
from app.jog.tool_touch_off import TOUCH_FIELDS, TOUCH_X, TOUCH_Z, TouchOff, find_touch_off_refusal
from app.offsets.change_rules import CORRECTION_FIELDS
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_changes import (
    ConfirmedOffsetChanges,
    OffsetHistory,
    find_change_refusal,
    format_tools_following_master,
)
from app.offsets.offset_table import ToolFieldEditor
from app.offsets.offset_values import (
    TOOL_FIELDS,
    UnitMode,
    describe_missing_offset,
    format_signed_length,
    format_value,
    make_field_heading,
    parse_field_value,
    translate_field_name,
)
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import MAX_REMARK_LENGTH, OFFSET_NUMBERS, FieldType, OffsetKind, ToolOffsetRow
from core.tool_edges import format_edge_name, format_edge_suffix

TOOL_QUESTION = "tool"  # The question for the tool number.
Pair = tuple[float, float]
_NEXT_QUESTIONS = {"wear_x": "wear_z"}  # The question that follows an answer.


@dataclass(slots=True)
class ToolSetting:
    """Model of tool setting, with the selected tool, the open question and the entered text."""

    desk: Desk
    offset_book: OffsetBook
    offset_history: OffsetHistory = field(init=False)
    tool_fields: ToolFieldEditor = field(init=False)
    touch_off: TouchOff = field(default_factory=TouchOff)
    tool_number: int = 0
    question_name: str = ""  # The open question: a touch, "tool", a field, or empty.
    text: str = ""
    confirmation_text: str = ""  # The question about the last suspicious touch-off.
    _active: int = -1  # The active tool at the last update.

    def __post_init__(self) -> None:
        self.offset_history = OffsetHistory(self.desk, OffsetKind.TOOL, key_hint="F8, F5")
        self.tool_fields = ToolFieldEditor(self.offset_history)

    # --- display -------------------------------------------------------------------------------------

    @property
    def tool_row(self) -> ToolOffsetRow | None:
        """Return the offset of the selected tool, or None if the tool was never set."""
        return self.offset_book.tool_offsets.get(self.tool_number)

    @property
    def is_master_touch_off(self) -> bool:
        """Return whether the touch-off that is in progress is for the master tool."""
        return self.question_name in TOUCH_FIELDS and self.tool_row is not None and self.tool_row.master

    @property
    def is_touch_off_confirmation_open(self) -> bool:
        """Return whether the prompt line asks the operator to confirm the last touch-off."""
        question = self.desk.prompt_line.question_text
        return bool(self.desk.confirmation_key) and question == self.confirmation_text

    @property
    def is_tool_setter_result(self) -> bool:
        """Return whether the open question asks whether to save a measurement of the tool setter."""
        return self.question_name in TOUCH_FIELDS and self.touch_off.measured_position_mm is not None

    def ask_to_save_measurement(self, quantity: str, position_mm: float, reason: str) -> None:
        """Ask whether to save a measurement of the tool setter.

        ``position_mm`` is the machine position in mm with the tool tip at part zero. If the value is
        suspicious, the operator is instead asked to confirm a suspicious change.
        """
        self.question_name, self.text = quantity, ""
        self.touch_off.set_measurement(quantity, position_mm, reason)
        if self.tool_row is not None and ConfirmedOffsetChanges(
            self.offset_history
        ).find_suspicious_touch_changes(self.tool_number, self.touch_off.make_touch_position(position_mm)):
            self._enter()

    def ask_cut_size(self, quantity: str, position_mm: float) -> None:
        """Ask for the measured size of a skim cut.

        ``position_mm`` is the machine position in mm during the cut.
        """
        self.desk.clear_prompt_line()
        self.question_name, self.text = quantity, ""
        self.touch_off.set_cut_position(quantity, position_mm)

    @property
    def offset_change_mm(self) -> float | None:
        """Return the measured position minus the current offset including wear, in mm.

        Returns None if there is no measurement of the tool setter or no current offset.
        """
        if (
            not self.is_tool_setter_result
            or self.tool_row is None
            or self.touch_off.measured_position_mm is None
        ):
            return None
        return (
            self.touch_off.measured_position_mm - self.tool_row.offset["xz".index(self.touch_off.field_name)]
        )

    def make_question_text(self) -> str:
        """Return the text of the open question, or an empty string if no question is open."""
        name = format_edge_name(self.tool_number)
        if self.question_name == TOOL_QUESTION:
            return tr("TOOL NUMBER?")
        if self.is_tool_setter_result:
            return tr(
                Message(
                    "SAVE {tool} {axis} MEASURED AT THE TOOL SETTER?",
                    tool=name,
                    axis=self.touch_off.field_name.upper(),
                )
            )
        if self.question_name == TOUCH_X:
            return tr(Message("{tool} MEASURED DIAMETER?", tool=name))
        if self.question_name == TOUCH_Z:
            return tr(Message("{tool} Z POSITION OF THE FACE?", tool=name))
        return f"{name}  {translate_field_name(self.question_name)}?" if self.question_name else ""

    def make_note_text(self) -> str:
        """Return the note that the operator must read before answering, or an empty string without a note."""
        number, new = self.tool_number, self.tool_fields.incomplete_tool
        if self.is_master_touch_off and self.touch_off.moves_only_this_tool:
            return tr(
                Message(
                    "ONLY T{number} CHANGES. L: APPLY TO ALL TOOLS",
                    number=format_edge_suffix(number),
                )
            )
        if self.is_master_touch_off:
            return tr(
                Message(
                    "T{number} IS THE MASTER. ALSO ADJUSTED: {others}. L: THIS TOOL ONLY",
                    number=format_edge_suffix(number),
                    others=format_tools_following_master(self.offset_book.tool_offsets, number)
                    or tr("no tools"),
                )
            )
        return new.describe_missing_axis() if new.tool_number == number else ""

    def describe_change(self) -> str:
        """Return a description of the change that the current entry would make.

        If there is no entry, the last change is described.
        """
        if not self.question_name or self.question_name == TOOL_QUESTION:
            return self.offset_history.last_change_text
        mode, name, row = (
            self.offset_history.unit_mode,
            TOUCH_FIELDS.get(self.question_name, self.question_name),
            self.tool_row,
        )
        touched, title = self.question_name in TOUCH_FIELDS, make_field_heading(name, mode)
        was = (
            format_value(name, getattr(row, name), mode)
            if row
            else describe_missing_offset(is_unreadable=self.offset_book.has_read_failed)
        )
        try:
            value = (
                self.touch_off.find_zero_position(self.text, mode)
                if touched
                else parse_field_value(name, self.text, mode)
            )
            ends = _describe_reset_wear(row, f"wear_{name}", mode) if touched else ""
            apart = self._format_difference(name, mode)
            return f"{title}  {was}  →  {format_value(name, value, mode)}{apart}{ends}"
        except InvalidEntryError:
            return f"{title}  {was}  →  …"  # An incomplete expression is not an error yet.

    def _format_difference(self, name: str, mode: UnitMode) -> str:
        """Return the measured offset minus the current offset as text.

        The result is an empty string if nothing was measured.
        """
        if self.offset_change_mm is None:
            return ""
        shown = 2 * self.offset_change_mm if name == "x" and mode.is_diameter else self.offset_change_mm
        return f"   {tr('DIFFERENCE')} {format_signed_length(shown, mode.is_metric)}"

    def find_tip_position(self, snapshot: Snapshot) -> Pair | None:
        """Return the tip position relative to part zero in mm, or None if the tool was never set."""
        if self.tool_row is None:
            return None
        x, z = self.tool_row.offset
        return snapshot.tip[0] - x, snapshot.tip[1] - z

    def find_master_difference(self) -> Pair | None:
        """Return the offset of the selected tool minus the offset of the master tool, in mm.

        Returns None unless both tools are set.
        """
        master = self.offset_book.tool_offsets.get(self.offset_book.master_tool_number)
        if self.tool_row is None or master is None:
            return None
        (x, z), (mx, mz) = self.tool_row.offset, master.offset
        return x - mx, z - mz

    # --- every frame ---------------------------------------------------------------------------------

    def update(self, snapshot: Snapshot) -> None:
        """Select the tool that becomes active, and discard the entry if the unit of length changes.

        While a question is open, the selected tool remains. This method is called once per frame.
        """
        before = self.offset_history.unit_mode
        self.offset_history.update(snapshot)
        if self.offset_history.unit_mode != before and self.question_name:
            self.close_question()
            self.desk.say(tr("UNITS OR DIAMETER/RADIUS CHANGED. NOT SAVED. RE-ENTER VALUE"))
        if snapshot.modal.tool != self._active and not self.question_name:
            self._active = snapshot.modal.tool
            if self._active:
                self._choose(self._active)

    def _choose(self, number: int) -> None:
        if number != self.tool_number:
            self.tool_number = number
            self.tool_fields.incomplete_tool.discard_values()

    # --- questions -----------------------------------------------------------------------------------

    def open_question(self, quantity: str) -> None:
        """Ask for a tool number or for a value of the selected tool.

        If the value cannot be changed, show the reason instead.
        """
        snapshot = self.desk.read_snapshot()
        why = "" if quantity == TOOL_QUESTION else self.find_refusal(quantity, snapshot)
        if why:
            self.desk.say(why)
            return
        self.desk.clear_prompt_line()
        self.question_name, self.text = quantity, ""
        if quantity == "remark" and self.tool_row is not None:
            self.text = self.tool_row.remark
        if quantity in TOUCH_FIELDS:
            self.touch_off.store_touch_position(quantity, snapshot)

    def find_refusal(self, quantity: str, snapshot: Snapshot) -> str:
        """Return the reason why a value of the tool cannot be changed now, or an empty string if it can."""
        why = self.offset_book.lock_reason or find_change_refusal(
            snapshot, is_correction=quantity in CORRECTION_FIELDS[OffsetKind.TOOL]
        )
        if why or not self.tool_number:
            return why or _which_tool()
        if quantity in TOUCH_FIELDS:
            return find_touch_off_refusal(quantity, snapshot)
        if self.tool_row is None:
            return tr(
                Message(
                    "T{number} IS NOT SET. TOUCH OFF X AND Z FIRST",
                    number=format_edge_suffix(self.tool_number),
                )
            )
        return ""

    def close_question(self) -> None:
        """Close the question and discard the entered text."""
        self.question_name, self.text = "", ""

    def cancel_new_tool(self) -> None:
        """Close the question and discard an incomplete new tool."""
        self.close_question()
        self.tool_fields.incomplete_tool.discard_values()

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the open question."""
        return self.question_name == "remark" or (
            bool(self.question_name) and not self.is_tool_setter_result and key in EXPRESSION_CHARACTERS
        )

    def handle_key(self, key: str) -> bool:
        """Handle a key while a question is open, and return whether the key was used."""
        if key == "Enter":
            self._enter()
        elif key in {"Back", "Delete"} or (len(key) == 1 and self.accepts_key(key)):
            self.text = apply_edit_key(
                self.text, key, MAX_REMARK_LENGTH if self.question_name == "remark" else MAX_LENGTH
            )
        elif key in {"l", "L"} and self.is_master_touch_off:
            self.touch_off.moves_only_this_tool = not self.touch_off.moves_only_this_tool
        else:
            return False
        return True

    def _enter(self) -> None:
        try:
            why = self._save_answer()
        except InvalidEntryError as error:
            self.text = refused(self.text)
            why = tr(Message("REJECTED: {why}", why=error))
        if why:
            self.desk.say(why)

    def _save_answer(self) -> str:
        """Process the entered answer, and return the reason why it is rejected, or else an empty string.

        Raises InvalidEntryError if the entered text is invalid.
        """
        if self.question_name == TOOL_QUESTION:
            return self._tool()
        snapshot = self.desk.read_snapshot()
        why = self.find_refusal(self.question_name, snapshot)
        if why:
            return why
        return self._touched(snapshot) if self.question_name in TOUCH_FIELDS else self._field()

    def _tool(self) -> str:
        value = evaluate_expression(self.text)
        if value not in OFFSET_NUMBERS:
            raise InvalidEntryError(tr(Message("T{number:g} does not exist; tools are T1…32", number=value)))
        self._choose(int(value))
        self._active = self.desk.read_snapshot().modal.tool  # The operator's choice remains.
        self.close_question()
        return ""

    def _touched(self, snapshot: Snapshot) -> str:
        if self.touch_off.has_axis_moved(snapshot):
            return tr("AXIS MOVED AFTER TOUCH-OFF. PRESS ESC, THEN TOUCH OFF AGAIN")
        why = self.touch_off.save_touch_off(
            self.tool_number, self.text, self.offset_history, self.tool_fields.incomplete_tool
        )
        if not why:
            self.close_question()
            self.confirmation_text = self.desk.prompt_line.question_text
        return why

    def _field(self) -> str:
        name, text = self.question_name, self.text
        keeps = not text.strip() and TOOL_FIELDS[name].field_type is not FieldType.TEXT
        why = "" if keeps else self.tool_fields.save_field(self.tool_number, name, text)
        if not why:
            self.close_question()
            self.question_name = "" if self.desk.confirmation_key else _NEXT_QUESTIONS.get(name, "")
        return why

    def ask_to_toggle_master(self) -> None:
        """Ask whether to make the selected tool the master tool.

        If it already is the master tool, ask whether to use no master tool.
        """
        why = self.find_refusal("master", self.desk.read_snapshot())
        self.close_question()
        self.offset_history.show_refusal(why or self.tool_fields.ask_to_toggle_master(self.tool_number))

    def ask_to_undo_change(self) -> None:
        """Ask whether to undo the last change of the selected tool."""
        self.close_question()
        self.offset_history.show_refusal(
            self.find_undo_refusal()
            or ConfirmedOffsetChanges(self.offset_history).ask_to_undo_change(
                OffsetKind.TOOL, self.tool_number
            )
        )

    def find_undo_refusal(self) -> str:
        """Return why the last offset change of the tool cannot be undone, or an empty string if it can."""
        why = self.offset_book.lock_reason or find_change_refusal(
            self.desk.read_snapshot(), is_correction=False
        )
        return why or ("" if self.tool_number else _which_tool())

    def handle_escape(self) -> bool:
        """Close the question and discard an incomplete new tool.

        Returns False if there was neither an open question nor an incomplete tool.
        """
        was = bool(self.question_name or self.tool_fields.incomplete_tool.tool_number)
        if was and self.tool_number:
            self.desk.say(tr(Message("T{number} NOT CHANGED", number=format_edge_suffix(self.tool_number))))
        self.cancel_new_tool()
        return was


def _which_tool() -> str:
    return tr("NO TOOL SELECTED. PRESS T AND TYPE ITS NUMBER")


def _describe_reset_wear(row: ToolOffsetRow | None, name: str, mode: UnitMode) -> str:
    """Return a text about the wear that a touch-off resets to zero, or an empty string without wear.

    The touch-off resets the wear because the new geometry offset includes it.
    """
    if row is None or not getattr(row, name):
        return ""
    return (
        f"   {translate_field_name(name)}  {format_value(name, getattr(row, name), mode)}  →  "
        f"{format_value(name, 0.0, mode)}"
    )
