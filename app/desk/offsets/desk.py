"""The models behind F8 and F9: dialogue, clear, undo, history, and what the last change did."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk import prompts
from app.desk.desk import Desk
from app.desk.offsets.book import OffsetBook
from app.desk.offsets.dialogue import KEYS, Dialogue, Mode, Rules, Step
from app.desk.offsets.figures import told, triple
from app.desk.offsets.rules import SecondaryRules, ToolRules
from core.executor.snapshot import Snapshot
from core.store.errors import StoreError
from core.store.rows import Change, Kind

UNDER_WAY = prompts.MOVING | prompts.INTERRUPTED
CLEAR = "Press C to clear all offsets"
LEAVE = "Press Esc to exit offset adjustment screen"
CLEAR_ASKED = "PRESS C ONCE MORE TO CLEAR ALL 32 SECONDARY OFFSETS, ESC TO KEEP THEM"
KEEPS_ITS_OWN = "THE RUNNING JOB KEEPS ITS OFFSETS: A CHANGE COUNTS FROM THE NEXT CYCLE START"
REPEATS = "CYCLE REPEAT GOES ON WITH THE OLD OFFSETS: SWITCH IT OFF, A CHANGE COUNTS AFTER THIS CYCLE"
TOOLS_REFUSED = "A PROGRAM IS UNDER WAY: TOOL OFFSETS CHANGE BETWEEN CYCLES ONLY (F9 TAKES CORRECTIONS)"


@dataclass(slots=True)
class OffsetDesk:
    """One of the two pages. What Esc, C and the undo key do stands here; the page only draws."""

    desk: Desk
    book: OffsetBook
    rules: Rules
    dialogue: Dialogue = field(init=False)
    clearing: bool = False
    last: tuple[Change, ...] = ()
    looking_back: tuple[Change, ...] | None = None  # the history while it is shown
    _seen: int = 0

    def __post_init__(self) -> None:
        self._seen = self.book.changes
        self.dialogue = Dialogue(self.rules, self.book, self.desk.say, self.barred)

    @property
    def kind(self) -> Kind:
        """Which table."""
        return self.rules.kind

    def barred(self) -> str:
        """Why nothing may be changed now; empty when it may."""
        if self.kind is Kind.TOOL and self.desk.snapshot().state in UNDER_WAY:
            return TOOLS_REFUSED
        return self.book.locked

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        if self.book.locked:
            return self.book.locked
        if snapshot.state in UNDER_WAY:
            if self.kind is Kind.TOOL:
                return TOOLS_REFUSED
            return REPEATS if snapshot.cycle_repeat else KEEPS_ITS_OWN
        if self.looking_back is not None:
            return "F5 OR ESC LEAVES THE HISTORY; PAGE UP AND PAGE DOWN LOOK ON"
        return "EVERY VALUE TAKES ARITHMETIC, SUCH AS .5-.002; RETURN ALONE KEEPS THE VALUE"

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: follow the control's unit, and see what has been saved."""
        self.dialogue.follow(Mode(snapshot.modal.metric, snapshot.modal.diameter))
        if self.book.changes != self._seen:
            self._seen = self.book.changes
            self._changed(snapshot)

    def _changed(self, snapshot: Snapshot) -> None:
        """Show old → new; the desk builds the program anew."""
        changes = self._history(200)
        self.last = tuple(change for change in changes if change.step == changes[0].step)
        if self.looking_back is not None:
            self.looking_back = changes
        self.desk.say(self._saved(snapshot))

    def _saved(self, snapshot: Snapshot) -> str:
        if not self.last:
            return "SAVED"
        which = self.told(self.last[0])[1]
        names = which if len(self.last) == 1 else f"{len(self.last)} OFFSETS"
        when = "; IT COUNTS FROM THE NEXT CYCLE START" if snapshot.state in UNDER_WAY else ""
        return f"{names} {'TAKEN BACK' if self.last[0].undoes else 'SAVED'}{when}"

    def told(self, change: Change) -> tuple[str, str, str, str]:
        """When, which, from → to, why; in the unit of the control."""
        mode = self.dialogue.mode
        diameter = mode.diameter and self.kind is Kind.TOOL
        return told(change, self.rules.letter, mode.metric, diameter)

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""
        dialogue, mode = self.dialogue, self.dialogue.mode
        diameter = mode.diameter and self.kind is Kind.TOOL
        if dialogue.step is not Step.NUMBER:
            was, new = (triple(side, mode.metric, diameter) for side in (dialogue.old, dialogue.preview))
            return f"{self.rules.letter}{dialogue.number}   {was}  →  {new}"
        if len(self.last) == 1:
            _at, which, change, _why = self.told(self.last[0])
            return f"{which}   {change}"
        return f"{len(self.last)} offsets changed: F5 shows them" if self.last else ""

    # --- keys ----------------------------------------------------------------------------------------

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if key in {"c", "C"}:
            if self.kind is Kind.TOOL:
                return False
            self._clear()
            return True
        if key not in KEYS:
            return False
        self.clearing = False
        self.desk.clear()
        return self.dialogue.type(key)

    def _clear(self) -> None:
        why = self.barred()
        if why:
            self.desk.say(why)
        elif self.dialogue.step is not Step.NUMBER:
            self.desk.say("C CLEARS ALL OFFSETS ONLY WHILE Offset Number? IS ASKED; PRESS ESC FIRST")
        elif not self.clearing:
            self.clearing = True
            self.desk.say(CLEAR_ASKED)
        else:
            self.clearing = False
            self.desk.clear()
            self._answer(self.book.clear_secondary())

    def undo(self) -> None:
        """Take the last change of this table back."""
        why = self.barred()
        if not why:
            self.dialogue.restart()
            self.desk.clear()
            why = self.book.undo(self.kind)
        self._answer(why)

    def toggle_history(self) -> None:
        """The history instead of the table, or the table again."""
        self.looking_back = None if self.looking_back is not None else self._history(200)

    def escape(self) -> bool:
        """Esc closes the history, keeps the offsets, takes an entry back; False when the page may be left."""
        if self.looking_back is not None:
            self.looking_back = None
        elif self.clearing:
            self.clearing = False
            self.desk.clear()
        elif self.dialogue.step is not Step.NUMBER or self.dialogue.text:
            number = self.dialogue.number
            self.dialogue.restart()
            self.desk.say(f"{self.rules.letter}{number} IS AS IT WAS" if number else "")
        else:
            return False
        return True

    def opened(self) -> None:
        """The page comes up: what was changed elsewhere is no news here."""
        self._seen = self.book.changes
        self.last = ()

    def leave(self) -> None:
        """The page goes: nothing stays half entered."""
        self.clearing = False
        self.desk.clear()
        self.looking_back = None
        self.dialogue.restart()

    def _answer(self, why: str) -> None:
        if why:
            self.desk.say(why)

    def _history(self, limit: int) -> tuple[Change, ...]:
        try:
            return self.book.history(self.kind, limit)
        except StoreError as error:
            self.desk.say(str(error))
            return ()


def seccmp(desk: Desk, book: OffsetBook) -> OffsetDesk:
    """The model of F9."""
    return OffsetDesk(desk, book, SecondaryRules())


def tool_offsets(desk: Desk, book: OffsetBook) -> OffsetDesk:
    """The model of F8."""
    return OffsetDesk(desk, book, ToolRules())
