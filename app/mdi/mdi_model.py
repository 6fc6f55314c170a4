"""The model of the MDI page: entry, completion, proof and preparation of one line, without Qt."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.pages.code_help import CodeHelp
from app.desk.pages.page_entry import mdi_barred
from app.desk.persistence import Persistence
from app.desk.programs.prepared_line import PreparedLine, ProveLine
from app.desk.status import prompt_line
from app.desk.translation import tr
from core.executor.commands import Command, SpindleStop
from core.executor.snapshot import CYCLE, Snapshot, State
from core.language.diagnostics import Diagnostic
from core.message import Message
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from core.language.code_book import CodeBook, Entry

KEY = "mdi"
LONGEST = 120  # Maximum characters of a line.
KEPT = 100  # Number of lines.


@dataclass(slots=True)
class MdiLine:
    """The input line with a cursor and a history. Up and Down recall lines, as in a shell."""

    persistence: Persistence = field(default_factory=Persistence)
    text: str = ""
    at: int = 0  # The cursor is before this character.
    history: list[str] = field(default_factory=list)  # Oldest line first.
    refused: dict[str, int] = field(
        default_factory=dict
    )  # Rejected lines with the column of the error, counted from 1; 0: the whole line.
    # Position of the recalled line in the history, counted from the newest; 0: the line is being typed.
    back: int = 0
    _draft: str = ""

    def __post_init__(self) -> None:
        self.reload()

    def reload(self) -> None:
        """Read the stored history. Invalid entries are ignored."""
        try:
            kept = self.persistence.read_setting(KEY)
        except StoreError:
            kept = None
        lines = kept if isinstance(kept, list) else []
        self.history = [line for line in lines if isinstance(line, str)][-KEPT:]

    def type(self, key: str) -> bool:
        """Handle a character or an editing key. Return False if the key has no meaning here."""
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
        """Set the text, and the cursor to ``at`` or to the end."""
        self.text = text
        self.at = len(text) if at is None else at

    def recall(self, back: int) -> None:
        """Recall a line of the history, counted from the newest. 0 restores the typed text."""
        if not 0 <= back <= len(self.history):
            return
        if not self.back:
            self._draft = self.text
        self.back = back
        self.put(self.history[-back] if back else self._draft)

    def done(self) -> None:
        """Add the started line to the history, and begin an empty line."""
        self.refused.pop(self.text, None)
        self._remember()
        self.put("")
        self.back, self._draft = 0, ""

    def refuse(self, column: int) -> None:
        """Add a rejected line to the history with the column of its error. The text remains."""
        self._remember()
        self.refused[self.text] = column
        self.refused = {line: at for line, at in self.refused.items() if line in self.history}
        self.back = 0

    def _remember(self) -> None:
        if self.text.strip() and (not self.history or self.history[-1] != self.text):
            self.history = [*self.history, self.text][-KEPT:]
            with suppress(StoreError):  # TurnDesk shows the storage error elsewhere.
                self.persistence.save_setting(KEY, self.history)

    def _cut(self, index: int) -> None:
        if 0 <= index < len(self.text):
            self.put(self.text[:index] + self.text[index + 1 :], index)


CONTINUED = "~"  # A block of Klartext continues in the next line.


@dataclass(slots=True)
class LineCompletion:
    """Code help and completion for the input line. ``open`` is True while the choices use the arrow keys."""

    typing: MdiLine
    book: Callable[[], CodeBook]
    codes: CodeHelp = field(default_factory=CodeHelp)
    open: bool = False

    def turn(self) -> None:
        """Open the choices for the text before the cursor, or close them."""
        self.open = not self.open
        if self.open:
            self.codes.follow(self.book(), self.typing.text, self.typing.at + 1)
            self.codes.ask()

    def typed(self, key: str) -> bool:
        """Handle a key. Tab opens the choices. While they are open, arrow keys select a choice.

        Return False to leave the key to the input line. Any other key closes the choices.
        """
        if not self.open:
            if key == "Tab":
                self.turn()
            return self.open
        match key:
            case "Up" | "Down":
                self.codes.mark(self.codes.marked + (1 if key == "Down" else -1))
            case "Left" | "Right":
                self.codes.turn(1 if key == "Right" else -1)
            case "Enter" | "Tab":
                self.take()
            case _:
                self.open = False
        return self.open or key in ("Enter", "Tab")

    def take(self) -> None:
        """Insert the selected code in place of the typed part of the code."""
        self.open, chosen = False, self.codes.chosen
        if chosen is None:
            return
        text, at = self.typing.text, self.typing.at
        begin = self.codes.begin - 1 if self.codes.begin else at
        written = _in_one_line(chosen, LONGEST - len(text) + at - begin)
        if written:
            self.typing.put(text[:begin] + written + text[at:], begin + len(written))


def _in_one_line(entry: Entry, room: int) -> str:
    """Return the text that completion inserts, with continuation lines joined into one line.

    If this text is longer than ``room``, return only the code, or an empty text if the code is too long as
    well.
    """
    lines = entry.written.splitlines()
    joined = len(lines) == 1 or all(line.rstrip().endswith(CONTINUED) for line in lines[:-1])
    whole = " ".join(" ".join(line.rstrip().removesuffix(CONTINUED).split()) for line in lines)
    fitting = (each for each in ((whole,) if joined else ()) + (entry.head,) if len(each) <= room)
    return next(fitting, "")


@dataclass(slots=True)
class MdiModel:
    """The model of the MDI page. ``say`` shows a message, and ``book`` returns the codes."""

    prove: ProveLine
    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    say: Callable[[str], None]
    clear: Callable[[], None]
    book: Callable[[], CodeBook]
    typing: MdiLine = field(default_factory=MdiLine)
    open: bool = False
    line: PreparedLine = field(init=False)
    completion: LineCompletion = field(init=False)

    def __post_init__(self) -> None:
        self.completion = LineCompletion(self.typing, self.book)
        self.line = PreparedLine(self.prove, self.post, refused=self._refused)

    # --- page ----------------------------------------------------------------------------------------

    def opens(self) -> bool:
        """Return whether MDI can be opened now. If not, show the reason."""
        if why := mdi_barred(self.snapshot()):
            self.say(why)
        return not why

    def opened(self) -> None:
        """Prepare for the open page: Cycle Start runs lines and no program."""
        self.open = True
        self.typing.reload()
        self.completion.open = False
        self.line.take_back()

    def leave(self) -> bool:
        """Return whether the page can close. The spindle remains on, and Cycle Start runs programs again."""
        if not self.open:
            return True
        if self.snapshot().state in CYCLE:
            self.say(tr("A LINE IS RUNNING. LET IT END, OR STOP IT AND PRESS R"))
            return False
        self.open = False
        self.line.leave()
        return True

    def close(self) -> None:
        """End the worker that proves lines."""
        self.line.close()

    # --- keys ----------------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Return whether this character is text input now."""
        return len(key) == 1 and self.has_keyboard

    @property
    def has_keyboard(self) -> bool:
        """Whether the line accepts input. It does so while the drives are off, but not while a line runs."""
        return self.snapshot().state in {State.IDLE, State.DISABLED, State.ESTOP, State.FAULT}

    def typed(self, key: str) -> bool:
        """Handle a key. Return False to leave the key to the window."""
        if not self.has_keyboard:
            return False
        before = self.typing.text
        taken = self.completion.typed(key)
        if key == "Enter" and not taken:
            self.enter()
            return True
        taken = taken or self.typing.type(key)
        if self.typing.text != before:
            self.clear()
            self.line.take_back()
        return taken

    def enter(self) -> None:
        """Prove the line from the present machine state, or show why this is not possible."""
        snapshot = self.snapshot()
        self.clear()
        if snapshot.state is not State.IDLE:
            self.say(tr("DRIVES MUST BE ON TO PROVE A LINE. F5: DRIVES ON   F6: RESET"))
            return
        if not self.typing.text.strip():
            self.say(tr("TYPE A LINE FIRST. UP ARROW: EARLIER LINES"))
            return
        self.line.ask(self.typing.text, snapshot, self._failed)

    def complete(self) -> None:
        """Toggle the choices for the typed text or the code at the cursor."""
        if self.has_keyboard:
            self.clear()
            self.completion.turn()

    def take_code(self) -> None:
        """Insert the selected code in the line."""
        self.completion.take()
        self.clear()
        self.line.take_back()

    def recall(self, back: int) -> None:
        """Recall a line of the history, counted from the newest."""
        self.typing.recall(back)
        self.clear()
        self.line.take_back()

    def escape(self) -> bool:
        """Close the choices, cancel a prepared line, or clear the text.

        Return False if there was nothing to do.
        """
        under_way = self.snapshot().state in prompt_line.UNDER_WAY
        if self.completion.open:
            self.completion.open = False
            return not under_way  # Closing the list does not delay feed hold.
        begun = self.line.ready or self.typing.text or self.line.busy
        if under_way or not begun:
            return False
        if self.line.ready is None and not self.line.busy:
            self.typing.put("")
        self.line.take_back()
        return True

    def stop_spindle(self) -> None:
        """Stop the spindle, which a line may have left on."""
        self.clear()
        self.post(SpindleStop())

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Accept the proof of the line; called once a frame. A started line is added to the history."""
        if self.open:
            self.line.keep(snapshot)
        if self.line.look(snapshot):
            self.typing.done()

    def prompt(self, snapshot: Snapshot, start: str) -> str:
        """Return the prompt. ``start`` is the instruction for starting a cycle."""
        if snapshot.state is State.DISABLED:
            return tr("DRIVES ARE OFF. F5: DRIVES ON. YOU CAN STILL TYPE A LINE")
        if snapshot.state is not State.IDLE:
            return ""
        if self.completion.open:
            return tr("ARROWS: SELECT CODE OR CHAPTER   ENTER: INSERT   ESC: BACK")
        return self._of_the_line(start)

    def _of_the_line(self, start: str) -> str:
        """Return the prompt for the present state of the line."""
        if self.line.busy:
            return tr("CHECKING THE LINE FOR ERRORS")
        if self.line.errors:
            return tr("CORRECT THE LINE. ESC: CLEAR IT")
        if self.line.ready is not None:
            return tr(Message("TO RUN THE LINE: {start}. ESC: CANCEL", start=start))
        return tr("TYPE A LINE   ENTER: PROVE   F1: EXIT, SPINDLE UNCHANGED")

    def barred(self) -> str:
        """Return why the start buttons have no effect now. Empty if they can start a line."""
        if self.snapshot().state is State.IDLE and self.line.ready is None:
            return tr("NO LINE IS READY. TYPE A LINE AND PRESS ENTER")
        return ""

    def _failed(self, why: str) -> None:
        self.say(tr(Message("THE LINE CANNOT BE CHECKED: {why}", why=why)))

    def _refused(self, error: Diagnostic) -> None:
        self.typing.refuse(error.column)
