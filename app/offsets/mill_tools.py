"""Tool table of a mill (TOOL.T), with dimensions, oversizes, tool life and touch-off."""

from __future__ import annotations

from collections.abc import Mapping

from app.desk.arithmetic import evaluate_expression
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.offsets.cell_table import CellTable
from app.offsets.mill_touch import MillToolLives, MillTouchCalculator
from core.executor.snapshot import Snapshot
from core.message import Message
from core.production.tool_life import ToolLifeState
from core.store.store_rows import (
    MAX_TOOL_LIFE_MINUTES,
    MILL_TOOL_NUMBERS,
    FieldType,
    FieldValue,
    OffsetKind,
    RowField,
)

CUTTING_TIME_FIELD = "used"  # The column of the cutting time, which is counted and is not part of the row.
_USED_FIELD = RowField("CUR.TIME", 0.0, MAX_TOOL_LIFE_MINUTES, FieldType.MINUTES, name=CUTTING_TIME_FIELD)
_LIFE_TONES = {ToolLifeState.WARNING: StatusTone.PAUSE, ToolLifeState.USED_UP: StatusTone.ALARM}


class MillToolTable(CellTable):
    """Tool table of a mill, with the selected cell and the text that is being entered in this cell."""

    kind = OffsetKind.MILL_TOOL
    numbers = MILL_TOOL_NUMBERS

    @property
    def mill_tool_lives(self) -> MillToolLives:
        """Return the tool life counters of the mill's tools."""
        return MillToolLives.get_for_desk(self.desk)

    @property
    def columns(self) -> tuple[str, ...]:
        """Return the field names of the columns. The cutting time comes after the tool life limit."""
        *fields, stops = super().columns
        return (*fields, CUTTING_TIME_FIELD, stops)

    def field_of(self, name: str) -> RowField:
        """Return the field definition of a column."""
        return _USED_FIELD if name == CUTTING_TIME_FIELD else super().field_of(name)

    def value_at(self, number: int, name: str) -> FieldValue:
        """Return the value of a cell.

        CUR.TIME is the cutting time of the tool since it was new, in minutes.
        """
        if name != CUTTING_TIME_FIELD:
            return super().value_at(number, name)
        life = self.mill_tool_lives.read_lives().get(number)
        return round(life.seconds / 60.0, 1) if life is not None else 0.0

    def tone_at(self, number: int, name: str) -> StatusTone:
        """Return the color tone of a cell.

        The tone of CUR.TIME shows when the tool life is almost or completely used up.
        """
        life = self.mill_tool_lives.read_lives().get(number) if name == CUTTING_TIME_FIELD else None
        return StatusTone.OFF if life is None else _LIFE_TONES.get(life.state, StatusTone.OFF)

    @property
    def title(self) -> str:
        """Return the title of the table, with its units."""
        return tr("TOOL TABLE  ·  MM, DEGREES, MINUTES")

    def find_active_row(self, snapshot: Snapshot) -> int:
        """Return the number of the tool in the spindle."""
        return snapshot.modal.tool

    @property
    def footer_text(self) -> str:
        """Return the hint below the table.

        The hint explains the keys F2 and Esc, or the tool life column if such a column is selected.
        """
        if self.name in {"life", CUTTING_TIME_FIELD}:
            return tr(
                "TIME2: tool life limit in minutes at feed, 0 = no limit        CUR.TIME: minutes "
                "cut so far, 0 for a new tool"
            )
        if self.name == "stops":
            return tr("STOP: no new part starts once TIME2 is reached        Enter: on/off")
        return tr("F2: set L so that the current tip position becomes the typed height        Esc: exit")

    def save_fields(self, values: Mapping[str, FieldValue], reason: str) -> str:
        """Save CUR.TIME in the tool life counter, or other fields in the tool table.

        Returns an empty string on success, or the reason if the change is rejected.
        """
        if CUTTING_TIME_FIELD not in values:
            return super().save_fields(values, reason)
        if self.stored_row is None:
            return tr(
                Message("T{number} IS NOT IN THE TABLE YET: ENTER ITS LENGTH FIRST", number=self.number)
            )
        self.mill_tool_lives.set_cutting_time(self.number, 60.0 * float(values[CUTTING_TIME_FIELD]))
        return ""

    def find_position_refusal(self) -> str:
        """Return the reason why the tool length cannot be touched off now, or an empty string if it can."""
        if self.name != "length":
            return tr("SELECT COLUMN L, THEN PRESS F2 TO TOUCH OFF THE LENGTH")
        nose = MillTouchCalculator.get_for_desk(self.desk).find_spindle_nose_height()
        return nose if isinstance(nose, str) else self.find_change_refusal(self.desk.read_snapshot())

    def set_value_from_position(self) -> None:
        """Set the tool length by touch-off, so that the tip is at the entered height (F2).

        The height is relative to the active preset. Without an entry, it is 0.
        """
        nose = MillTouchCalculator.get_for_desk(self.desk).find_spindle_nose_height()
        if isinstance(nose, str) or self.find_position_refusal():
            self.desk.say(self.find_position_refusal())
            return
        reads = self.text.strip() or "0"
        self.save_cell(
            lambda: self.check_range(nose - evaluate_expression(reads)),
            tr(Message("touch-off at {value}", value=reads)),
        )
