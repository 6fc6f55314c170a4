"""The model of F9: dialogue, clear, undo, history, and what the last change did."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets import offset_changes
from app.offsets.effect_shown import Rows
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_history import Ledger
from app.offsets.offset_values import Mode, in_words
from app.offsets.secondary_dialogue import KEYS, Dialogue, Step
from core.executor.snapshot import Snapshot
from core.store.store_rows import Kind


@dataclass(slots=True)
class SeccmpDesk:
    """What Esc, C and the undo key do stands here; the page only draws."""

    desk: Desk
    book: OffsetBook
    ledger: Ledger = field(init=False)
    dialogue: Dialogue = field(init=False)

    def __post_init__(self) -> None:
        self.ledger = Ledger(self.desk, self.book, Kind.SECONDARY)
        self.dialogue = Dialogue(self.book, self.desk.say, self.barred)

    def barred(self) -> str:
        """Why nothing may be changed now; empty when it may."""
        return self.book.locked or offset_changes.refusal(self.desk.snapshot(), correction=True)

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        why = self.book.locked or offset_changes.refusal(snapshot, correction=True)
        if why:
            return why
        if self.ledger.looking_back is not None:
            return tr("F5 OR ESC LEAVES THE HISTORY; PAGE UP AND PAGE DOWN LOOK ON")
        standing = offset_changes.standing(snapshot)
        return standing or tr("EVERY VALUE TAKES ARITHMETIC, SUCH AS .5-.002; RETURN ALONE KEEPS THE VALUE")

    @property
    def foot(self) -> str:
        """What can be done beside answering, in the control's words."""
        leave = tr("Press Esc to exit offset adjustment screen")
        return f"{leave}        {tr('Press C to clear all offsets')}"

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: follow the control's unit, and see what has been saved."""
        self.dialogue.follow(Mode(snapshot.modal.metric, snapshot.modal.diameter))
        self.ledger.look(snapshot)

    @property
    def old_to_new(self) -> str:
        """The change that is being entered, or else the last one."""
        dialogue = self.dialogue
        if dialogue.step is Step.NUMBER:
            return self.ledger.last_told
        was, new = (in_words(side, dialogue.mode) for side in (dialogue.old, dialogue.preview))
        return f"D{dialogue.number}   {was}  →  {new}"

    def proposed(self) -> Rows:
        """The tables as they would be with what is being entered."""
        preview = self.dialogue.preview
        typed = {self.dialogue.number: preview} if preview else {}
        return self.book.tools, {**self.book.secondary, **typed}

    # --- keys ----------------------------------------------------------------------------------------

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if key in {"c", "C"}:
            self._clear()
            return True
        if key not in KEYS:
            return False
        self.desk.clear()
        return self.dialogue.type(key)

    def _clear(self) -> None:
        why = self.book.locked or offset_changes.refusal(self.desk.snapshot(), correction=False)
        if why:
            self.desk.say(why)
        elif self.dialogue.step is not Step.NUMBER:
            self.desk.say(tr("C CLEARS ALL OFFSETS ONLY WHILE Offset Number? IS ASKED; PRESS ESC FIRST"))
        else:
            question = tr("PRESS Y TO CLEAR ALL 32 SECONDARY OFFSETS, ESC TO KEEP THEM")
            self.desk.ask(question, self._clear_all)

    def _clear_all(self) -> None:
        why = self.book.locked or offset_changes.refusal(self.desk.snapshot(), correction=False)
        self.ledger.answer(why or self.book.clear_secondary())

    def undo(self) -> None:
        """Take the last change of this table back."""
        why = self.barred()
        if not why:
            self.dialogue.restart()
        self.ledger.undo(why)

    def escape(self) -> bool:
        """Esc closes the history, keeps the offsets, takes an entry back; False when the page may be left."""
        if self.ledger.looking_back is not None:
            self.ledger.looking_back = None
        elif self.desk.asked:
            self.desk.clear()
        elif self.dialogue.step is not Step.NUMBER or self.dialogue.text:
            number = self.dialogue.number
            self.dialogue.restart()
            self.desk.say(tr("D{number} IS AS IT WAS").format(number=number) if number else "")
        else:
            return False
        return True

    def leave(self) -> None:
        """The page goes: nothing stays half entered."""
        self.desk.clear()
        self.ledger.looking_back = None
        self.dialogue.restart()
