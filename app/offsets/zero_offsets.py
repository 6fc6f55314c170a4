"""Zero offsets, G54 to G59: a cell is chosen, typed over and saved. mm, X a radius, and degrees."""

from __future__ import annotations

from math import remainder

from app.desk.arithmetic import value_of
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.cell_table import CellTable
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.store_rows import ZERO_CODES, Kind


class ZeroOffsets(CellTable):
    """The cell that is chosen, and what is typed over it."""

    kind = Kind.ZERO
    own_key = "C"
    numbers = ZERO_CODES
    clears = "PRESS Y TO CLEAR G54 TO G59, N TO KEEP THEM"
    why_cleared = "all zero offsets cleared with the C key"

    @property
    def title(self) -> str:
        """What the table is, and its units."""
        return tr("SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES")

    @property
    def words(self) -> tuple[str, ...]:
        """What stands over the columns: the axes."""
        return tuple(name.upper() for name in self.columns)

    def in_force(self, snapshot: Snapshot) -> int:
        """The settable offset of the program."""
        return snapshot.modal.settable

    @property
    def code(self) -> int:
        """The G code of the chosen row."""
        return self.number

    @property
    def question(self) -> str:
        """What is asked for the chosen cell."""
        words = {"x": tr("X RADIUS, MM?"), "z": tr("Z, MM?"), "c": tr("C, DEGREES?")}
        return f"G{self.code}  {words[self.name]}"

    @property
    def foot(self) -> str:
        """What F2, C and Esc do here."""
        return tr(
            "F2: set the current position to the typed value        C: clear G54 to G59        Esc: exit"
        )

    def barred(self, snapshot: Snapshot, *, correction: bool = False) -> str:
        """Nothing here is a correction: part zero changes between cycles only."""
        if snapshot.state in UNDER_WAY - {State.JOG, State.HOME} and not self.book.locked:
            return tr("PROGRAM RUNNING. CHANGE G54 TO G59 ONLY BETWEEN CYCLES")
        return super().barred(snapshot, correction=correction)

    def here_barred(self) -> str:
        """Return why the position of the machine is not taken now; empty when it is."""
        snapshot, axis = self.desk.snapshot(), self.name.upper()
        if axis not in snapshot.axes:
            return tr(Message("THIS MACHINE HAS NO {axis} AXIS", axis=axis))
        if not snapshot.homed[snapshot.axes.index(axis)]:
            return tr(Message("{axis} IS NOT HOMED. HOME IT FIRST", axis=axis))
        return self.barred(snapshot)

    def here(self) -> None:
        """F2: the machine stands where the program shall read what was typed, or 0: the offset follows."""
        if why := self.here_barred():
            self.desk.say(why)
            return
        snapshot = self.desk.snapshot()
        place = snapshot.axes.index(self.name.upper())
        reads = self.text.strip() or "0"
        words = tr(Message("position set to {value}", value=reads))
        self.save(lambda: self._touched(snapshot.actual[place], value_of(reads)), words)

    def _touched(self, at: float, reads: float) -> float:
        """The offset with which the machine position ``at`` reads so; whole turns of C are left out."""
        return self.checked(remainder(at - reads, 360.0) if self.name == "c" else at - reads)
