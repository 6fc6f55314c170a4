"""The tool table of a mill (TOOL.T), with dimensions, oversizes, tool life and touch-off."""

from __future__ import annotations

from collections.abc import Mapping

from app.desk.arithmetic import value_of
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.offsets.cell_table import CellTable
from app.offsets.mill_touch import MillLives, MillTouch
from core.executor.snapshot import Snapshot
from core.message import Message
from core.production.tool_life import LifeState
from core.store.store_rows import LIFE_REACH, MILL_TOOLS, Field, Kind, Sort, Value

USED = "used"  # The column of the cutting time, which is counted and is not part of the row.
_USED = Field("CUR.TIME", 0.0, LIFE_REACH, Sort.MINUTES, name=USED)
_TONES = {LifeState.WARNED: Tone.PAUSE, LifeState.SPENT: Tone.ALARM}


class MillTools(CellTable):
    """The tool table with its selected cell and the text that is entered for it."""

    kind = Kind.MILL_TOOL
    numbers = MILL_TOOLS

    @property
    def lives(self) -> MillLives:
        """The tool life of the tools."""
        return MillLives.of(self.desk)

    @property
    def columns(self) -> tuple[str, ...]:
        """The field names of the columns. The cutting time follows the tool life limit."""
        *fields, stops = super().columns
        return (*fields, USED, stops)

    def field_of(self, name: str) -> Field:
        """Return the field definition of a column."""
        return _USED if name == USED else super().field_of(name)

    def value_at(self, number: int, name: str) -> Value:
        """Return the value of a cell. CUR.TIME is the cutting time in minutes since the tool was new."""
        if name != USED:
            return super().value_at(number, name)
        life = self.lives.lives().get(number)
        return round(life.seconds / 60.0, 1) if life is not None else 0.0

    def tone_at(self, number: int, name: str) -> Tone:
        """Return the tone of a cell. CUR.TIME shows when the tool life is almost or completely used."""
        life = self.lives.lives().get(number) if name == USED else None
        return Tone.OFF if life is None else _TONES.get(life.state, Tone.OFF)

    @property
    def title(self) -> str:
        """The title of the table, with its units."""
        return tr("TOOL TABLE  ·  MM, DEGREES, MINUTES")

    def in_force(self, snapshot: Snapshot) -> int:
        """Return the number of the tool in the spindle."""
        return snapshot.modal.tool

    @property
    def foot(self) -> str:
        """The hint below the table: the keys F2 and Esc, or the meaning of a tool life column."""
        if self.name in {"life", USED}:
            return tr(
                "TIME2: tool life limit in minutes at feed, 0 = no limit        CUR.TIME: minutes "
                "cut so far, 0 for a new tool"
            )
        if self.name == "stops":
            return tr("STOP: no new part starts once TIME2 is reached        Enter: on/off")
        return tr("F2: set L so that the current tip position becomes the typed height        Esc: exit")

    def keep(self, values: Mapping[str, Value], why: str) -> str:
        """Save CUR.TIME in the tool life counter and other fields in the table.

        Return why this was rejected, or an empty text.
        """
        if USED not in values:
            return super().keep(values, why)
        if self.stored is None:
            return tr(
                Message("T{number} IS NOT IN THE TABLE YET: ENTER ITS LENGTH FIRST", number=self.number)
            )
        self.lives.set_used(self.number, 60.0 * float(values[USED]))
        return ""

    def here_barred(self) -> str:
        """Return why the tool length cannot be touched off now. Empty if it can."""
        if self.name != "length":
            return tr("SELECT COLUMN L, THEN PRESS F2 TO TOUCH OFF THE LENGTH")
        nose = MillTouch.of(self.desk).nose_height()
        return nose if isinstance(nose, str) else self.barred(self.desk.snapshot())

    def here(self) -> None:
        """Handle F2: calculate the length of a tool whose tip is at the entered height, or at 0.

        The height is relative to the preset in force.
        """
        nose = MillTouch.of(self.desk).nose_height()
        if isinstance(nose, str) or self.here_barred():
            self.desk.say(self.here_barred())
            return
        reads = self.text.strip() or "0"
        self.save(
            lambda: self.checked(nose - value_of(reads)), tr(Message("touch-off at {value}", value=reads))
        )
