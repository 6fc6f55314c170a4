"""MDI without Qt: a line is typed, proved on a worker, made ready, and started by the palms."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field

from app.desk import prompt_line
from app.desk.persistence import Persistence
from app.desk.prepared_line import PreparedLine, ProveLine
from app.desk.translation import tr
from core.executor.commands import Command, SpindleStop
from core.executor.snapshot import CYCLE, Snapshot, State
from core.language.diagnostics import Diagnostic
from core.store.store_errors import StoreError

# --- the line and its history -------------------------------------------------------------------------


KEY = "mdi"
LONGEST = 120  # characters of a line
KEPT = 100  # lines


@dataclass(slots=True)
class MdiLine:
    """One line with a cursor; arrows up and down go through the history, as in every shell."""

    persistence: Persistence = field(default_factory=Persistence)
    text: str = ""
    at: int = 0  # the cursor stands before this character
    history: list[str] = field(default_factory=list)  # oldest first
    refused: dict[str, int] = field(
        default_factory=dict
    )  # lines of it that do not run: column, from 1; 0: whole
    back: int = 0  # how far up the history the text comes from, 0: it is being typed
    _draft: str = ""

    def __post_init__(self) -> None:
        self.reload()

    def reload(self) -> None:
        """Read the history that is kept; what is no list of lines is forgotten."""
        try:
            kept = self.persistence.setting(KEY)
        except StoreError:
            kept = None
        lines = kept if isinstance(kept, list) else []
        self.history = [line for line in lines if isinstance(line, str)][-KEPT:]

    def type(self, key: str) -> bool:
        """A character or an editing key; False when it means nothing here."""
        match key:
            case "Back":
                self._cut(self.at - 1)
            case "Delete":
                self._cut(self.at)
            case "Left" | "Right":
                self.at = max(0, min(len(self.text), self.at + (1 if key == "Right" else -1)))
            case "Up" | "Down":
                self.recall(self.back + (1 if key == "Up" else -1))
            case _ if len(key) == 1 and key.isprintable():
                if len(self.text) < LONGEST:
                    self.put(self.text[: self.at] + key + self.text[self.at :], self.at + 1)
            case _:
                return False
        return True

    def put(self, text: str, at: int | None = None) -> None:
        """Another text, the cursor there or at its end."""
        self.text = text
        self.at = len(text) if at is None else at

    def recall(self, back: int) -> None:
        """Take up the line that stands so far up the history; 0: what was being typed."""
        if not 0 <= back <= len(self.history):
            return
        if not self.back:
            self._draft = self.text
        self.back = back
        self.put(self.history[-back] if back else self._draft)

    def done(self) -> None:
        """The line has been started: it goes into the history, and an empty one begins."""
        self.refused.pop(self.text, None)
        self._remember()
        self.put("")
        self.back, self._draft = 0, ""

    def refuse(self, column: int) -> None:
        """The line does not run: it stays to be mended, and stands in the history with its word marked."""
        self._remember()
        self.refused[self.text] = column
        self.refused = {line: at for line, at in self.refused.items() if line in self.history}
        self.back = 0

    def _remember(self) -> None:
        if self.text.strip() and (not self.history or self.history[-1] != self.text):
            self.history = [*self.history, self.text][-KEPT:]
            with suppress(StoreError):  # the desk says by itself that nothing is kept
                self.persistence.save_setting(KEY, self.history)

    def _cut(self, index: int) -> None:
        if 0 <= index < len(self.text):
            self.put(self.text[:index] + self.text[index + 1 :], index)


@dataclass(slots=True)
class MdiModel:
    """The model behind the MDI page. ``say`` answers on the prompt line."""

    prove: ProveLine
    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    say: Callable[[str], None]
    clear: Callable[[], None]
    typing: MdiLine = field(default_factory=MdiLine)
    open: bool = False
    line: PreparedLine = field(init=False)

    def __post_init__(self) -> None:
        self.line = PreparedLine(self.prove, self.post, refused=self._refused)

    # --- page ----------------------------------------------------------------------------------------

    def opens(self) -> bool:
        """Whether MDI may be opened now; says why not."""
        if self.snapshot().state in CYCLE:
            self.say(tr("A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE MDI"))
            return False
        return True

    def opened(self) -> None:
        """From now on Cycle Start begins lines, and no program."""
        self.open = True
        self.typing.reload()
        self.line.take_back()

    def leave(self) -> bool:
        """Whether it may be left; the spindle stays on, and Cycle Start begins programs again."""
        if not self.open:
            return True
        if self.snapshot().state in CYCLE:
            self.say(tr("A LINE IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R"))
            return False
        self.open = False
        self.line.leave()
        return True

    def close(self) -> None:
        """End the thread that proves."""
        self.line.close()

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Whether a character is text now: the line has the whole keyboard, or none of it."""
        return len(key) == 1 and self.has_keyboard

    @property
    def has_keyboard(self) -> bool:
        """Whether the line takes what is typed: also with the drives off, but not while one is under way."""
        return self.snapshot().state in {State.IDLE, State.DISABLED, State.ESTOP, State.FAULT}

    def typed(self, key: str) -> bool:
        """A key that was pressed; False leaves it to the window."""
        if not self.has_keyboard:
            return False
        if key == "Enter":
            self.enter()
            return True
        before = self.typing.text
        taken = self.typing.type(key)
        if self.typing.text != before:
            self.clear()
            self.line.take_back()
        return taken

    def enter(self) -> None:
        """Have the line proved, from the state and the place of now."""
        snapshot = self.snapshot()
        self.clear()
        if snapshot.state is not State.IDLE:
            self.say(tr("THE LINE IS PROVED AND RUN WITH THE DRIVES ON: F5 SWITCHES THEM ON, F6 IS RESET"))
            return
        if not self.typing.text.strip():
            self.say(tr("TYPE A LINE FIRST; ARROW UP BRINGS EARLIER ONES BACK"))
            return
        self.line.ask(self.typing.text, snapshot, self._failed)

    def recall(self, back: int) -> None:
        """Take up the line that stands so far up the history."""
        self.typing.recall(back)
        self.clear()
        self.line.take_back()

    def escape(self) -> bool:
        """Take a ready line back, then what is typed; False when there was neither."""
        begun = self.line.ready or self.typing.text or self.line.busy
        if self.snapshot().state in prompt_line.UNDER_WAY or not begun:
            return False
        if self.line.ready is None and not self.line.busy:
            self.typing.put("")
        self.line.take_back()
        return True

    def stop_spindle(self) -> None:
        """Stop the spindle that an M03 has left on."""
        self.clear()
        self.post(SpindleStop())

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Take up what the worker has found; a line that was started goes into the history."""
        if self.open:
            self.line.keep(snapshot)
        if self.line.look(snapshot):
            self.typing.done()

    def prompt(self, snapshot: Snapshot, start: str) -> str:
        """What can be done now; ``start`` names what starts a cycle here."""
        if snapshot.state is State.DISABLED:
            return tr("DRIVES ARE OFF: PRESS F5 FOR DRIVES ON; A LINE CAN BE TYPED MEANWHILE")
        if snapshot.state is not State.IDLE:
            return ""
        if self.line.busy:
            return tr("PROVING THE LINE")
        if self.line.errors:
            return tr("THE LINE DOES NOT RUN: MEND IT, OR ESC TO CLEAR IT")
        if self.line.ready is not None:
            return tr("TO RUN THE LINE {start}; ESC TAKES IT BACK").format(start=start)
        return tr("TYPE A LINE, ENTER PROVES IT; F1 LEAVES, THE SPINDLE STAYS AS IT IS")

    def barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        if self.snapshot().state is State.IDLE and self.line.ready is None:
            return tr("NO LINE IS READY: TYPE ONE AND PRESS ENTER")
        return ""

    def _failed(self, why: str) -> None:
        self.say(tr("THE LINE CANNOT BE PROVED: {why}").format(why=why))

    def _refused(self, error: Diagnostic) -> None:
        self.typing.refuse(error.column)
