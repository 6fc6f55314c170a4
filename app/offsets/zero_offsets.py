"""Zero offsets, G54 to G59: a cell is chosen, typed over and saved. mm, X a radius, and degrees."""

from __future__ import annotations

from collections.abc import Callable
from math import remainder

from app.desk.arithmetic import CHARACTERS, EntryError, value_of
from app.desk.desk import Desk
from app.desk.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.offset_history import refusal
from app.offsets.offset_table import OffsetTable
from app.offsets.offset_values import out_of_range, signed_zero_offset
from core.executor.snapshot import Snapshot, State
from core.store.store_rows import FIELDS, ZERO_CODES, Kind, ZeroRow

ZERO_FIELDS = tuple(FIELDS[Kind.ZERO])
_KEYS = CHARACTERS | {"Back", "Delete", "Enter", "Tab", "Up", "Down", "Left", "Right"}
_STEPS = {"Tab": (0, 1), "Right": (0, 1), "Left": (0, -1), "Up": (-1, 0), "Down": (1, 0)}


class ZeroOffsets(OffsetTable):
    """The cell that is chosen, and what is typed over it."""

    kind = Kind.ZERO
    clears = "PRESS Y TO CLEAR G54 TO G59, ESC TO KEEP THEM"
    why_cleared = "C: all cleared"

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.row = self.column = 0

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def code(self) -> int:
        """The G code of the chosen row."""
        return ZERO_CODES[self.row]

    @property
    def name(self) -> str:
        """The field of the chosen column: x, z or c."""
        return ZERO_FIELDS[self.column]

    @property
    def question(self) -> str:
        """What is asked for the chosen cell."""
        words = {"x": tr("X RADIUS, MM?"), "z": tr("Z, MM?"), "c": tr("C, DEGREES?")}
        return f"G{self.code}  {words[self.name]}"

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""
        if not self.text.strip():
            return self.history.last_in_words
        old = getattr(self.book.zero.get(self.code, ZeroRow()), self.name)
        try:
            new = value_of(self.text)
        except EntryError:
            return ""  # half a sum is no mistake yet
        return f"G{self.code} {self.name.upper()}   {signed_zero_offset(old)}  →  {signed_zero_offset(new)}"

    @property
    def foot(self) -> str:
        """What F2, C and Esc do here."""
        return tr(
            "F2: where the machine stands reads what is typed        C: clear G54 to G59        Esc: exit"
        )

    def hint(self, _snapshot: Snapshot) -> str:
        """How a value is entered and another cell chosen."""
        return tr("TYPE A VALUE OR A SUM AND PRESS RETURN; ARROWS AND TAB CHOOSE ANOTHER CELL")

    def barred(self, snapshot: Snapshot, *, correction: bool = False) -> str:
        """Nothing here is a correction: part zero changes between cycles only."""
        if snapshot.state in UNDER_WAY - {State.JOG, State.HOME} and not self.book.locked:
            return tr("A PROGRAM IS UNDER WAY: G54 TO G59 CHANGE BETWEEN CYCLES ONLY")
        return self.book.locked or refusal(snapshot, correction=correction)

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Figures and signs are typed, C clears the table."""
        return key in CHARACTERS or key == "C"

    def enter_key(self, key: str) -> bool:
        """Arrows go from cell to cell, Return saves what is typed."""
        if key not in _KEYS:
            return False
        self.desk.clear()
        if key in _STEPS:
            self.move(*_STEPS[key])
        elif key == "Enter":
            self._enter()
        else:
            self.type_text(key)
        return True

    def move(self, rows: int, columns: int) -> None:
        """Another cell; what was typed and not entered is forgotten."""
        wide = len(ZERO_FIELDS)
        at = (self.row * wide + self.column + rows * wide + columns) % (len(ZERO_CODES) * wide)
        self.choose(at // wide, at % wide)

    def choose(self, row: int, column: int) -> None:
        """The cell that a finger touched."""
        self.row, self.column, self.text = row, column, ""

    def take_back(self) -> bool:
        """Forget what is typed; False when nothing was."""
        typed, self.text = bool(self.text), ""
        return typed

    def drop(self) -> None:
        """Forget what is typed."""
        self.text = ""

    def _enter(self) -> None:
        if not self.text.strip():
            self.move(0, 1)
            return
        self._save(lambda: self._checked(value_of(self.text)), self.text.strip())

    def here(self) -> None:
        """F2: the machine stands where the program shall read what was typed, or 0: the offset follows."""
        snapshot = self.desk.snapshot()
        axis = self.name.upper()
        if axis not in snapshot.axes:
            self.desk.say(tr("THIS MACHINE HAS NO AXIS {axis}").format(axis=axis))
            return
        place = snapshot.axes.index(axis)
        if not snapshot.homed[place]:
            self.desk.say(tr("{axis} DOES NOT KNOW ITS POSITION: HOME IT FIRST").format(axis=axis))
            return
        reads = self.text.strip() or "0"
        words = tr("reads {value}").format(value=reads)
        self._save(lambda: self._touched(snapshot.actual[place], value_of(reads)), words)

    def _touched(self, at: float, reads: float) -> float:
        """The offset with which the machine position ``at`` reads so; whole turns of C are left out."""
        return self._checked(remainder(at - reads, 360.0) if self.name == "c" else at - reads)

    def _checked(self, value: float) -> float:
        """The value, where it is one that is kept. Raises EntryError."""
        most = FIELDS[self.kind][self.name].high
        if abs(value) <= most:
            return round(value, 10)
        unit = tr("degrees") if self.name == "c" else tr("mm")
        field = f"G{self.code} {self.name.upper()}"
        raise EntryError(out_of_range(field, signed_zero_offset(value), unit, -most, most))

    def _save(self, value: Callable[[], float], typed: str) -> None:
        """Save the chosen cell, unless something is wrong with it; that is said, and the text stays."""
        if why := self.barred(self.desk.snapshot()):
            self.desk.say(why)
            return
        try:
            new = value()
        except EntryError as error:
            self.desk.say(tr("REFUSED: {why}").format(why=error))
            return
        row = self.book.zero.get(self.code)
        if row is not None and getattr(row, self.name) == new:
            self.desk.say(tr("G{code} IS AS IT WAS").format(code=self.code))
        elif why := self.book.change(self.kind, self.code, {self.name: new}, f"{self.name.upper()} {typed}"):
            self.desk.say(why)
            return
        self.text = ""
