"""MDI without Qt: a line is typed and completed, proved on a worker, made ready, and started by the palms."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field

from app.desk.pages.code_help import CodeHelp
from app.desk.pages.page_entry import mdi_barred
from app.desk.persistence import Persistence
from app.desk.programs.prepared_line import PreparedLine, ProveLine
from app.desk.status import prompt_line
from app.desk.translation import tr
from core.executor.commands import Command, SpindleStop
from core.executor.snapshot import CYCLE, Snapshot, State
from core.language.code_book import CodeBook, Entry
from core.language.diagnostics import Diagnostic
from core.message import Message
from core.store.store_errors import StoreError

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
            kept = self.persistence.read_setting(KEY)
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


CONTINUED = "~"  # a block of Klartext goes on in the next line


@dataclass(slots=True)
class LineCompletion:
    """The same code help as the editor's, over one line. ``open``: the choices have the arrow keys."""

    typing: MdiLine
    book: Callable[[], CodeBook]
    codes: CodeHelp = field(default_factory=CodeHelp)
    open: bool = False

    def turn(self) -> None:
        """Open the choices for what stands before the cursor, or close them."""
        self.open = not self.open
        if self.open:
            self.codes.follow(self.book(), self.typing.text, self.typing.at + 1)
            self.codes.ask()

    def typed(self, key: str) -> bool:
        """Tab opens the choices; open, arrows look through them, and any other key goes to the line."""
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
        """The marked code into the line, in the place of what has been typed of it."""
        self.open, chosen = False, self.codes.chosen
        if chosen is None:
            return
        text, at = self.typing.text, self.typing.at
        begin = self.codes.begin - 1 if self.codes.begin else at
        written = _in_one_line(chosen, LONGEST - len(text) + at - begin)
        if written:
            self.typing.put(text[:begin] + written + text[at:], begin + len(written))


def _in_one_line(entry: Entry, room: int) -> str:
    """What completion writes, its continued lines in one; the head alone where that is too long.

    Empty where not even the head fits.
    """
    lines = entry.written.splitlines()
    joined = len(lines) == 1 or all(line.rstrip().endswith(CONTINUED) for line in lines[:-1])
    whole = " ".join(" ".join(line.rstrip().removesuffix(CONTINUED).split()) for line in lines)
    fitting = (each for each in ((whole,) if joined else ()) + (entry.head,) if len(each) <= room)
    return next(fitting, "")


@dataclass(slots=True)
class MdiModel:
    """The model behind the MDI page. ``say`` answers on the prompt line, ``book`` has the codes."""

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
        """Whether MDI may be opened now; says why not."""
        if why := mdi_barred(self.snapshot()):
            self.say(why)
        return not why

    def opened(self) -> None:
        """From now on Cycle Start begins lines, and no program."""
        self.open = True
        self.typing.reload()
        self.completion.open = False
        self.line.take_back()

    def leave(self) -> bool:
        """Whether it may be left; the spindle stays on, and Cycle Start begins programs again."""
        if not self.open:
            return True
        if self.snapshot().state in CYCLE:
            self.say(tr("A LINE IS RUNNING. LET IT END, OR STOP IT AND PRESS R"))
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
        """Have the line proved, from the state and the place of now."""
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
        """Complete what is typed, or look up the code at the cursor; again: back to the history."""
        if self.has_keyboard:
            self.clear()
            self.completion.turn()

    def take_code(self) -> None:
        """Write the marked code into the line."""
        self.completion.take()
        self.clear()
        self.line.take_back()

    def recall(self, back: int) -> None:
        """Take up the line that stands so far up the history."""
        self.typing.recall(back)
        self.clear()
        self.line.take_back()

    def escape(self) -> bool:
        """Close the codes, take a ready line back, then what is typed; False when there was neither."""
        under_way = self.snapshot().state in prompt_line.UNDER_WAY
        if self.completion.open:
            self.completion.open = False
            return not under_way  # a list comes not before the hold
        begun = self.line.ready or self.typing.text or self.line.busy
        if under_way or not begun:
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
            return tr("DRIVES ARE OFF. F5: DRIVES ON. YOU CAN STILL TYPE A LINE")
        if snapshot.state is not State.IDLE:
            return ""
        if self.completion.open:
            return tr("ARROWS: SELECT CODE OR CHAPTER   ENTER: INSERT   ESC: BACK")
        return self._of_the_line(start)

    def _of_the_line(self, start: str) -> str:
        """How far the line is."""
        if self.line.busy:
            return tr("CHECKING THE LINE FOR ERRORS")
        if self.line.errors:
            return tr("CORRECT THE LINE. ESC: CLEAR IT")
        if self.line.ready is not None:
            return tr(Message("TO RUN THE LINE: {start}. ESC: CANCEL", start=start))
        return tr("TYPE A LINE   ENTER: PROVE   F1: EXIT, SPINDLE UNCHANGED")

    def barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        if self.snapshot().state is State.IDLE and self.line.ready is None:
            return tr("NO LINE IS READY. TYPE A LINE AND PRESS ENTER")
        return ""

    def _failed(self, why: str) -> None:
        self.say(tr(Message("THE LINE CANNOT BE CHECKED: {why}", why=why)))

    def _refused(self, error: Diagnostic) -> None:
        self.typing.refuse(error.column)
