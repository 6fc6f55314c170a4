"""MDI without Qt: a line is typed, proved on a worker, made ready, and started by the palms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.pages.page_entry import mdi_barred
from app.desk.programs.prepared_line import PreparedLine, ProveLine
from app.desk.status import prompt_line
from app.desk.translation import tr
from app.mdi.line_completion import LineCompletion
from app.mdi.mdi_line import MdiLine
from core.executor.commands import Command, SpindleStop
from core.executor.snapshot import CYCLE, Snapshot, State
from core.language.code_book import CodeBook
from core.language.diagnostics import Diagnostic
from core.message import Message


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
