"""Model of the secondary offsets (F9 SECCMP), which asks for a number and then for X, Z and R.

The prompts are those of the original control. Half of an entered X, a diameter correction, is added to the
stored X. An entered Z is added. An entered R replaces the value. Enter alone keeps the value.
"""

from __future__ import annotations

from enum import IntEnum

from app.desk.arithmetic import EXPRESSION_CHARACTERS, InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import refused
from app.desk.status.formats import format_length
from app.desk.translation import tr
from app.offsets.offset_changes import describe_effective_time
from app.offsets.offset_table import OffsetTable, ProposedOffsets
from app.offsets.offset_values import (
    UnitMode,
    add_correction,
    convert_to_mm,
    describe_range_error,
    format_offset,
)
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_rows import (
    MAX_NOSE_RADIUS_MM,
    OFFSET_NUMBERS,
    SECONDARY_OFFSET_LIMIT_MM,
    OffsetKind,
    SecondaryOffsetRow,
)

_ENTRY_KEYS = EXPRESSION_CHARACTERS | {"Back", "Delete", "Enter"}


class SecondaryOffsetStep(IntEnum):
    """Steps of the dialog that edits a secondary offset, in order."""

    NUMBER = 0
    X = 1
    Z = 2
    R = 3


def apply_correction(
    step: SecondaryOffsetStep, old_value: float, entered_value: float, mode: UnitMode
) -> float:
    """Return the new offset value in mm after an entry by the operator.

    For X, half of the entry is added. For Z, the entry is added. For R, it replaces the value.
    """
    if step is SecondaryOffsetStep.R:
        return convert_to_mm(entered_value, mode.is_metric)
    return add_correction(
        old_value, entered_value / 2 if step is SecondaryOffsetStep.X else entered_value, mode.is_metric
    )


class SecondaryOffsetEntry(OffsetTable):
    """Dialog that edits one secondary offset, with its current step and the previous answers."""

    kind = OffsetKind.SECONDARY
    page_key = "C"
    clear_table_question = "PRESS Y TO CLEAR ALL 32 SECONDARY OFFSETS, N TO KEEP THEM"
    clear_table_reason = "all offsets cleared with the C key"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.entry_step, self.offset_number = SecondaryOffsetStep.NUMBER, 0
        self._answers: list[float] = []  # New values of the previous steps in mm.
        self._typed: list[str] = []

    # --- display -------------------------------------------------------------------------------------

    @property
    def heading(self) -> str:
        """Return the number of the offset that is being entered."""
        which = tr("Secondary offset number:")
        return f"{which} {self.offset_number}" if self.offset_number else which

    @property
    def question_text(self) -> str:
        """Return the prompt of the current dialog step.

        All prompts except the one for R are those of the original control.
        """
        words = (tr("Offset Number?"), tr("X DIAMETER CORRECTION?"), tr("Z CORRECTION?"), tr("R?"))
        return words[self.entry_step]

    @property
    def stored_row(self) -> SecondaryOffsetRow | None:
        """Return the saved values of the offset that is being edited, or None if it has no values."""
        return self.offset_book.secondary_offsets.get(self.offset_number) if self.offset_number else None

    @property
    def selected_row_number(self) -> int | None:
        """Return the entered number, or None if no number has been entered.

        With None, undo applies to the last change of the whole table.
        """
        return self.offset_number or None

    @property
    def preview_row(self) -> SecondaryOffsetRow | None:
        """Return the offset with the current entry applied, or None if no offset is selected."""
        if not self.offset_number:
            return None
        old = self.stored_row or SecondaryOffsetRow()
        new = [*self._answers, *old[len(self._answers) :]]
        if self.text.strip() and self.entry_step is not SecondaryOffsetStep.NUMBER:
            try:
                at = self.entry_step - 1
                new[at] = apply_correction(
                    self.entry_step, old[at], evaluate_expression(self.text), self.unit_mode
                )
            except InvalidEntryError:
                pass  # An incomplete expression is not an error yet.
        return SecondaryOffsetRow(*new)

    @property
    def change_description(self) -> str:
        """Return the text of the change being entered, or of the last change if nothing is entered."""
        if self.entry_step is SecondaryOffsetStep.NUMBER:
            return self.offset_history.last_change_text
        was, new = (format_offset(side, self.unit_mode) for side in (self.stored_row, self.preview_row))
        return f"D{self.offset_number}   {was}  →  {new}"

    @property
    def selected_field_name(self) -> str:
        """Return the name of the field that the current prompt asks for, or an empty string."""
        is_field = self.entry_step is not SecondaryOffsetStep.NUMBER
        return self.entry_step.name.lower() if is_field else ""

    @property
    def footer_text(self) -> str:
        """Return the hint on how to exit and how to clear the table, worded as on the original control."""
        leave = tr("Press Esc to exit offset adjustment screen")
        return f"{leave}        {tr('Press C to clear all offsets')}"

    def make_hint(self, snapshot: Snapshot) -> str:
        """Return how to answer the current prompt, or when a correction takes effect."""
        if self.entry_step is SecondaryOffsetStep.NUMBER and not describe_effective_time(snapshot):
            return tr("TYPE AN OFFSET NUMBER AND PRESS ENTER")
        return describe_effective_time(snapshot) or tr(
            "TYPE A VALUE OR EXPRESSION (.5-.002). ENTER ALONE: NO CHANGE"
        )

    def make_proposed_offsets(self) -> ProposedOffsets:
        """Return all offsets with the current entry applied."""
        tools, secondary = super().make_proposed_offsets()
        preview = self.preview_row
        return tools, {**secondary, **({self.offset_number: preview} if preview else {})}

    def update(self, snapshot: Snapshot) -> None:
        """Read the current length unit of the control, and discard the entry if the unit has changed.

        This is called once a frame. X is always entered as a diameter correction. A change of the diameter
        mode therefore does not discard the entry.
        """
        before = self.unit_mode
        super().update(snapshot)
        if self.unit_mode.is_metric != before.is_metric and self.entry_step is not SecondaryOffsetStep.NUMBER:
            self.discard_entry()
            self.desk.say(tr("CONTROL CHANGED UNITS. NOTHING SAVED. ENTER THE VALUE AGAIN"))

    # --- keys ----------------------------------------------------------------------------------------

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered.

        Number characters are accepted, and also C, which clears the table.
        """
        return key in EXPRESSION_CHARACTERS or key == "C"

    def handle_entry_key(self, key: str) -> bool:
        """Handle a key: edit the text, or answer the question with Enter."""
        if key not in _ENTRY_KEYS:
            return False
        self.desk.clear_prompt_line()
        if key == "Enter":
            self._enter()
        else:
            self.edit_entry(key)
        return True

    def select_offset(self, number: int) -> None:
        """Select an offset by touch.

        The selection is rejected while another offset is being entered.
        """
        if self.entry_step is SecondaryOffsetStep.NUMBER:
            self.text = str(number)
            self._enter()
        else:
            self.desk.say(
                tr(Message("FINISH ENTERING D{number} FIRST, OR PRESS ESC", number=self.offset_number))
            )

    def clear_table(self) -> None:
        """Handle the C key: clear the table, unless an offset is being edited."""
        whole = self.find_change_refusal(self.desk.read_snapshot(), is_correction=False)
        if not whole and self.entry_step is not SecondaryOffsetStep.NUMBER:
            self.desk.say(tr("C CLEARS ALL OFFSETS ONLY AT THE PROMPT Offset Number? PRESS ESC FIRST"))
        else:
            super().clear_table()

    def handle_undo(self) -> None:
        """Ask whether to undo the last change of the entered offset number.

        This is possible only before a value is entered.
        """
        if self.entry_step is not SecondaryOffsetStep.X or self.text or self.find_undo_refusal():
            super().handle_undo()
            return
        number = self.offset_number
        self.discard_entry()
        self.offset_history.show_refusal(self.confirmed_changes.ask_to_undo_change(self.kind, number))

    def cancel_entry(self) -> bool:
        """Discard the entry, and show that it was discarded.

        Return False if nothing was entered.
        """
        if self.entry_step is SecondaryOffsetStep.NUMBER and not self.text:
            return False
        number = self.offset_number
        self.discard_entry()
        self.desk.say(tr(Message("D{number} NOT CHANGED", number=number)) if number else "")
        return True

    def discard_entry(self) -> None:
        """Return to the first step, and discard all answers."""
        self.entry_step, self.offset_number, self.text = SecondaryOffsetStep.NUMBER, 0, ""
        self._answers, self._typed = [], []

    def _enter(self) -> None:
        if why := self.find_change_refusal(self.desk.read_snapshot(), is_correction=True):
            self.desk.say(why)
            return
        try:
            self._take_number() if self.entry_step is SecondaryOffsetStep.NUMBER else self._take_value()
        except InvalidEntryError as error:
            self.text = refused(self.text)
            self.desk.say(tr(Message("REJECTED: {why}", why=error)))

    def _take_number(self) -> None:
        value = evaluate_expression(self.text)
        if value not in OFFSET_NUMBERS:
            raise InvalidEntryError(
                tr(Message("D{number:g} does not exist; offsets are D1…32", number=value))
            )
        self.offset_number, self.entry_step, self.text = int(value), SecondaryOffsetStep.X, ""

    def _take_value(self) -> None:
        at, text = self.entry_step - 1, self.text.strip()
        new = old = (self.stored_row or SecondaryOffsetRow())[at]
        if text:
            new = apply_correction(self.entry_step, old, evaluate_expression(text), self.unit_mode)
            self._check_range(new)
        typed = f"{self.entry_step.name} {text}" if text else ""
        if self.entry_step is not SecondaryOffsetStep.R:
            self._answers.append(new)
            self._typed.append(typed)
            self.entry_step, self.text = SecondaryOffsetStep(self.entry_step + 1), ""
        else:
            self._save(SecondaryOffsetRow(self._answers[0], self._answers[1], new), [*self._typed, typed])

    def _check_range(self, mm: float) -> None:
        """Raise InvalidEntryError if a value is out of range."""
        low, high = (
            (0.0, MAX_NOSE_RADIUS_MM)
            if self.entry_step is SecondaryOffsetStep.R
            else (-SECONDARY_OFFSET_LIMIT_MM, SECONDARY_OFFSET_LIMIT_MM)
        )
        if not low <= mm <= high:
            unit, name = self.unit_mode.unit_length_mm, f"D{self.offset_number} {self.entry_step.name}"
            figure = format_length(mm, self.unit_mode.is_metric)
            raise InvalidEntryError(
                describe_range_error(name, figure, self.unit_mode.name, low / unit, high / unit)
            )

    def _save(self, new: SecondaryOffsetRow, typed: list[str]) -> None:
        if new == self.stored_row:
            self.desk.say(tr(Message("D{number} NOT CHANGED", number=self.offset_number)))
            self.discard_entry()
            return
        reason = ("MM " if self.unit_mode.is_metric else "") + " ".join(filter(None, typed))
        why = self.confirmed_changes.change_fields(self.kind, self.offset_number, new._asdict(), reason)
        if why:
            self.desk.say(why)
        else:
            self.discard_entry()
