"""The model of the page of G54 to G59: a cell is chosen, typed over and saved; undo, clear, history."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk import prompts
from app.desk.arithmetic import LONGEST, EntryError, value_of
from app.desk.desk import Desk
from app.desk.offsets.dialogue import CHARACTERS
from app.desk.words import tr
from app.desk.zero_offsets.book import ZeroBook
from app.desk.zero_offsets.figures import entered, shown, told
from core.executor.snapshot import Snapshot, State
from core.store.errors import StoreError
from core.store.zero import CODES, FIELDS, ZeroChange, ZeroRow

KEYS = CHARACTERS | {"Back", "Delete", "Enter", "Tab", "Up", "Down", "Left", "Right"}
_STEPS = {"Tab": (0, 1), "Right": (0, 1), "Left": (0, -1), "Up": (-1, 0), "Down": (1, 0)}
_LOOKED_AT = 200  # changes


@dataclass(slots=True)
class ZeroDesk:
    """What the keys do stands here; the page only draws. Values are mm, X a radius, and degrees."""

    desk: Desk
    row: int = 0  # of the cell that is typed over
    column: int = 0
    text: str = ""
    clearing: bool = False
    last: tuple[ZeroChange, ...] = ()
    looking_back: tuple[ZeroChange, ...] | None = None  # the history while it is shown
    _seen: int = 0

    def __post_init__(self) -> None:
        self._seen = self.book.changes

    @property
    def book(self) -> ZeroBook:
        """The offsets as they are saved."""
        return self.desk.zero

    @property
    def code(self) -> int:
        """The G code of the chosen row."""
        return CODES[self.row]

    @property
    def name(self) -> str:
        """The field of the chosen column: x, z or c."""
        return FIELDS[self.column]

    def barred(self, snapshot: Snapshot) -> str:
        """Why nothing may be changed now; empty when it may."""
        if self.book.locked:
            return self.book.locked
        if snapshot.state in {State.JOG, State.HOME}:
            return tr("THE SLIDES ARE MOVING: OFFSETS CHANGE AT REST")
        if snapshot.state in prompts.MOVING | prompts.INTERRUPTED | {State.PROGRAM_STOP}:
            return tr("A PROGRAM IS UNDER WAY: G54 TO G59 CHANGE BETWEEN CYCLES ONLY")
        return ""

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        why = self.barred(snapshot)
        if why:
            return why
        if self.looking_back is not None:
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
            return f"G{self.code} {self.name.upper()}   {shown(old)}  →  {shown(new)}"
        if len(self.last) == 1:
            _at, which, change, _why = told(self.last[0])
            return f"{which}   {change}"
        return tr("{count} offsets changed: F5 shows them").format(count=len(self.last)) if self.last else ""

    def look(self) -> None:
        """Once a frame: see what has been saved, and say it."""
        if self.book.changes == self._seen:
            return
        self._seen = self.book.changes
        changes = self._history()
        self.last = tuple(change for change in changes if change.step == changes[0].step)
        if self.looking_back is not None:
            self.looking_back = changes
        names = " ".join(f"G{change.code}" for change in reversed(self.last))
        back = bool(self.last) and self.last[0].undoes is not None
        self.desk.say((tr("{names} TAKEN BACK") if back else tr("{names} SAVED")).format(names=names))

    # --- keys ----------------------------------------------------------------------------------------

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if key in {"c", "C"}:
            self._clear()
            return True
        if key not in KEYS:
            return False
        self.clearing = False
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
        at = self.row * len(FIELDS) + self.column + rows * len(FIELDS) + columns
        at %= len(CODES) * len(FIELDS)
        self.row, self.column, self.text = at // len(FIELDS), at % len(FIELDS), ""

    def choose(self, row: int, column: int) -> None:
        """The cell that a finger touched."""
        self.row, self.column, self.text = row, column, ""

    def _enter(self) -> None:
        if not self.text.strip():
            self.move(0, 1)
            return
        why = self.barred(self.desk.snapshot())
        if why:
            self.desk.say(why)
            return
        try:
            value = entered(self.code, self.name, self.text)
        except EntryError as error:
            self.desk.say(tr("REFUSED: {why}").format(why=error))
            return
        row = self.book.rows.get(self.code)
        if row is not None and getattr(row, self.name) == value:
            self.desk.say(tr("G{code} IS AS IT WAS").format(code=self.code))
            self.text = ""
            return
        why = self.book.change(self.code, {self.name: value}, f"{self.name.upper()} {self.text.strip()}")
        if why:
            self.desk.say(why)
        else:
            self.text = ""

    def _clear(self) -> None:
        why = self.barred(self.desk.snapshot())
        if why:
            self.desk.say(why)
        elif not self.clearing:
            self.clearing = True
            self.desk.say(tr("PRESS C ONCE MORE TO CLEAR G54 TO G59, ESC TO KEEP THEM"))
        else:
            self.clearing = False
            self.desk.clear()
            self._answer(self.book.clear("C: all cleared"))

    def undo(self) -> None:
        """Take the last change back."""
        self.text = ""
        self.desk.clear()
        self._answer(self.barred(self.desk.snapshot()) or self.book.undo())

    def toggle_history(self) -> None:
        """The history instead of the table, or the table again."""
        self.looking_back = None if self.looking_back is not None else self._history()

    def escape(self) -> bool:
        """Esc closes the history, keeps the offsets, takes an entry back; False when the page may be left."""
        if self.looking_back is not None:
            self.looking_back = None
        elif self.clearing:
            self.clearing = False
            self.desk.clear()
        elif self.text:
            self.text = ""
        else:
            return False
        return True

    def opened(self) -> None:
        """The page comes up: what was changed elsewhere is no news here."""
        self._seen, self.last = self.book.changes, ()

    def leave(self) -> None:
        """The page goes: nothing stays half entered."""
        self.clearing, self.text, self.looking_back = False, "", None
        self.desk.clear()

    def _answer(self, why: str) -> None:
        if why:
            self.desk.say(why)

    def _history(self) -> tuple[ZeroChange, ...]:
        try:
            return self.book.history(_LOOKED_AT)
        except StoreError as error:
            self.desk.say(str(error))
            return ()
