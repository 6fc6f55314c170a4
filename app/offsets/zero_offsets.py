"""The model of the page of G54 to G59: a cell is chosen, typed over and saved; undo, clear, history."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk import prompt_line
from app.desk.arithmetic import LONGEST, EntryError, value_of
from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.offset_book import ZeroBook
from app.offsets.offset_history import ZeroLedger
from app.offsets.offset_values import shown_zero, zero_touched, zero_typed
from app.offsets.secondary_dialogue import CHARACTERS
from core.executor.snapshot import Snapshot, State
from core.store.zero_offset_table import ZERO_CODES, ZERO_FIELDS, ZeroRow

KEYS = CHARACTERS | {"Back", "Delete", "Enter", "Tab", "Up", "Down", "Left", "Right"}
_STEPS = {"Tab": (0, 1), "Right": (0, 1), "Left": (0, -1), "Up": (-1, 0), "Down": (1, 0)}


@dataclass(slots=True)
class ZeroDesk:
    """What the keys do stands here; the page only draws. Values are mm, X a radius, and degrees."""

    desk: Desk
    row: int = 0  # of the cell that is typed over
    column: int = 0
    text: str = ""
    ledger: ZeroLedger = field(init=False)

    def __post_init__(self) -> None:
        self.ledger = ZeroLedger(self.desk)

    @property
    def book(self) -> ZeroBook:
        """The offsets as they are saved."""
        return self.desk.zero

    @property
    def code(self) -> int:
        """The G code of the chosen row."""
        return ZERO_CODES[self.row]

    @property
    def name(self) -> str:
        """The field of the chosen column: x, z or c."""
        return ZERO_FIELDS[self.column]

    def barred(self, snapshot: Snapshot) -> str:
        """Why nothing may be changed now; empty when it may."""
        if self.book.locked:
            return self.book.locked
        if snapshot.state in {State.JOG, State.HOME}:
            return tr("THE SLIDES ARE MOVING: OFFSETS CHANGE AT REST")
        if snapshot.state in prompt_line.MOVING | prompt_line.INTERRUPTED | {State.PROGRAM_STOP}:
            return tr("A PROGRAM IS UNDER WAY: G54 TO G59 CHANGE BETWEEN CYCLES ONLY")
        return ""

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        why = self.barred(snapshot)
        if why:
            return why
        if self.ledger.looking_back is not None:
            return tr("F5 OR ESC LEAVES THE HISTORY; PAGE UP AND PAGE DOWN LOOK ON")
        return tr("TYPE A VALUE OR A SUM AND PRESS RETURN; ARROWS AND TAB CHOOSE ANOTHER CELL")

    @property
    def question(self) -> str:
        """What is asked for the chosen cell."""
        words = {"x": tr("X RADIUS, MM?"), "z": tr("Z, MM?"), "c": tr("C, DEGREES?")}
        return f"G{self.code}  {words[self.name]}"

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""
        if self.text.strip():
            old = getattr(self.book.rows.get(self.code, ZeroRow()), self.name)
            try:
                new = value_of(self.text)
            except EntryError:
                return ""  # half a sum is no mistake yet
            return f"G{self.code} {self.name.upper()}   {shown_zero(old)}  →  {shown_zero(new)}"
        return self.ledger.last_told

    # --- keys ----------------------------------------------------------------------------------------

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if key in {"c", "C"}:
            self._clear()
            return True
        if key not in KEYS:
            return False
        self.desk.clear()
        if key in _STEPS:
            self.move(*_STEPS[key])
        elif key == "Enter":
            self._enter()
        elif key in {"Back", "Delete"}:
            self.text = self.text[:-1] if key == "Back" else ""
        elif len(self.text) < LONGEST:
            self.text += key
        return True

    def move(self, rows: int, columns: int) -> None:
        """Another cell; what was typed and not entered is forgotten."""
        at = self.row * len(ZERO_FIELDS) + self.column + rows * len(ZERO_FIELDS) + columns
        at %= len(ZERO_CODES) * len(ZERO_FIELDS)
        self.row, self.column, self.text = at // len(ZERO_FIELDS), at % len(ZERO_FIELDS), ""

    def choose(self, row: int, column: int) -> None:
        """The cell that a finger touched."""
        self.row, self.column, self.text = row, column, ""

    def _enter(self) -> None:
        if not self.text.strip():
            self.move(0, 1)
            return
        self._save(lambda: zero_typed(self.code, self.name, self.text), self.text.strip())

    def here(self) -> None:
        """The machine stands where the program shall read what was typed, or 0: the offset follows."""
        snapshot = self.desk.snapshot()
        axis = self.name.upper()
        if axis not in snapshot.axes:
            self.desk.say(tr("THIS MACHINE HAS NO AXIS {axis}").format(axis=axis))
            return
        place = snapshot.axes.index(axis)
        if not snapshot.homed[place]:
            self.desk.say(tr("{axis} DOES NOT KNOW ITS POSITION: HOME IT FIRST").format(axis=axis))
            return
        at, read = snapshot.actual[place], self.text.strip() or "0"
        self._save(
            lambda: zero_touched(self.code, self.name, at, self.text), tr("reads {value}").format(value=read)
        )

    def _save(self, value: Callable[[], float], typed: str) -> None:
        """Save the chosen cell, unless something is wrong with it; that is said, and the text stays."""
        why = self.barred(self.desk.snapshot())
        if why:
            self.desk.say(why)
            return
        try:
            new = value()
        except EntryError as error:
            self.desk.say(tr("REFUSED: {why}").format(why=error))
            return
        row = self.book.rows.get(self.code)
        if row is not None and getattr(row, self.name) == new:
            self.desk.say(tr("G{code} IS AS IT WAS").format(code=self.code))
        elif why := self.book.change(self.code, {self.name: new}, f"{self.name.upper()} {typed}"):
            self.desk.say(why)
            return
        self.text = ""

    def _clear(self) -> None:
        why = self.barred(self.desk.snapshot())
        if why:
            self.desk.say(why)
        else:
            self.desk.ask(tr("PRESS Y TO CLEAR G54 TO G59, ESC TO KEEP THEM"), self._clear_all)

    def _clear_all(self) -> None:
        self._answer(self.barred(self.desk.snapshot()) or self.book.clear("C: all cleared"))

    def undo(self) -> None:
        """Take the last change back."""
        self.text = ""
        self.desk.clear()
        self._answer(self.barred(self.desk.snapshot()) or self.book.undo())

    def escape(self) -> bool:
        """Esc closes the history, keeps the offsets, takes an entry back; False when the page may be left."""
        if self.ledger.looking_back is not None:
            self.ledger.looking_back = None
        elif self.desk.asked:
            self.desk.clear()
        elif self.text:
            self.text = ""
        else:
            return False
        return True

    def leave(self) -> None:
        """The page goes: nothing stays half entered."""
        self.text, self.ledger.looking_back = "", None
        self.desk.clear()

    def _answer(self, why: str) -> None:
        if why:
            self.desk.say(why)
