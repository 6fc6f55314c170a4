"""What a desk is made of, and what it answers with; nothing of it computes or waits."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk import prompts
from app.desk.alarms import StopLog
from app.desk.answers import YES, Answers
from app.desk.changes import FileChanges
from app.desk.hands import StationHands
from app.desk.pulse import Pulse
from app.desk.readout import Readout
from app.desk.rebuilding import Rebuilding
from app.desk.session import Phase, Session
from app.desk.settings import SettingsBook
from app.desk.shelf import Shelf
from app.desk.station import StationPanel
from app.offsets.offset_book import NO_ZEROS_KEPT as NO_ZERO
from app.offsets.offset_book import NONE_KEPT, OffsetBook, ZeroBook
from app.programs.run_record import RunRecord
from app.special.part_count import PartCounter
from core.executor.commands import Command
from core.executor.snapshot import Event, Snapshot, State
from core.store.errors import StoreError

if TYPE_CHECKING:
    from app.desk.mdi.mdi import MdiDesk
    from app.desk.searchto.search import SearchDesk
    from app.editor.editor import Editor
    from app.offsets.effect import Effect
    from app.programs.program_list import FilesDesk
    from app.special.special_functions import SpecialDesk
    from core.machine.model import Machine


def _nothing() -> None:
    """A desk without an executor of its own has nothing to close."""


def _time_of_day() -> str:
    return time.strftime("%H:%M:%S")


@dataclass(slots=True)
class DeskParts:
    """All parts of a desk; ``Desk`` says what keys do with them.

    ``station`` is there with the simulated machine only; ``two_hand`` as the machine file says.
    """

    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    session: Session
    shelf: Shelf
    station: StationPanel | None = None
    two_hand: bool = True
    with_c: bool = True
    machine: str = ""
    lathe: Machine | None = None  # what the machine file says, for moves by hand
    simulated: bool = True
    shut: Callable[[], None] = _nothing
    waiting: Callable[[], str] = str  # what of it waits in memory, in words
    differs: Callable[[], str] = str  # how the file on the disk is not the program on the desk
    unkept: Callable[[], str] = str  # why events, parts and versions are not being kept; empty while they are
    clock: Callable[[], float] = time.monotonic
    time_of_day: Callable[[], str] = _time_of_day
    editor: Editor | None = None
    special: SpecialDesk | None = None
    files: FilesDesk | None = None
    mdi: MdiDesk | None = None
    searchto: SearchDesk | None = None
    settings: SettingsBook = field(default_factory=SettingsBook)
    counter: PartCounter = field(default_factory=PartCounter)
    record: RunRecord = field(default_factory=RunRecord)
    restoring: bool = False  # a backup takes the place of what is kept
    effect: Effect | None = None  # draws what a change of offsets does
    book: OffsetBook = field(default_factory=lambda: OffsetBook(locked=NONE_KEPT))
    zero: ZeroBook = field(default_factory=lambda: ZeroBook(locked=NO_ZERO))
    changes: FileChanges = field(default_factory=FileChanges)  # of the machine file, to be accepted
    stop_held: Callable[[], bool] = bool  # whether a key that stops is held down
    starts_here: bool = True  # whether the page in front is one on which cycles are started
    hands: StationHands = field(init=False)
    log: StopLog = field(init=False)
    answers: Answers = field(init=False)
    rebuilding: Rebuilding = field(init=False)
    _pulse: Pulse = field(default_factory=Pulse)

    def __post_init__(self) -> None:
        self.log = StopLog(self.time_of_day)
        self.answers = Answers(self.snapshot, self._trouble, self._now)
        self.rebuilding = Rebuilding(self.session, self.say)
        starting = self.answers.starting
        self.hands = StationHands(self.station, self.clock, self.say, self.clear, starting, self.barred)

    def _trouble(self) -> str:
        return self.unkept()

    def say(self, text: str) -> None:
        """Put an answer on the prompt line; it stays until the next key or the next state."""
        self.answers.say(text)

    def ask(self, question: str, yes: Callable[[], None], key: str = YES) -> None:
        """Ask before something is lost or moves: ``PRESS Y TO …, ESC TO …``.

        ``key`` means yes, and is never the one that asked; a finger has a target on the prompt line.
        """
        self.answers.ask(question, yes, key)

    @property
    def asked(self) -> str:
        """The key that means yes to the question that stands; empty while none does."""
        return self.answers.key if self.answers.asked is not None else ""

    def _now(self) -> float:
        return self.hands.clock()

    def clear(self) -> None:
        """Take the answer or the question back."""
        self.answers.take_back()

    @property
    def notice(self) -> str:
        """The answer to the last key, empty without one."""
        return self.answers.notice

    @notice.setter
    def notice(self, text: str) -> None:
        self.answers.notice, self.answers.asked = text, None

    @property
    def start_words(self) -> str:
        """How a cycle is started at this machine."""
        if self.station is None:
            return "PRESS BOTH PALM BUTTONS" if self.two_hand else "PRESS CYCLE START"
        return "PRESS BOTH PALM BUTTONS (F11 + F12)" if self.two_hand else "PRESS CYCLE START (F12)"

    @property
    def release_words(self) -> str:
        """How the E-stop is freed at this machine."""
        return "RELEASE THE BUTTON" if self.station is None else "RELEASE THE BUTTON (U)"

    @property
    def readout(self) -> Readout:
        """What the large figures show."""
        return Readout(self.settings.now.readout)

    def choose_setting(self, name: str, value: object) -> None:
        """Take a choice of the screen; where it cannot be kept it counts until the end, and that is said."""
        try:
            self.settings.choose(name, value)
        except StoreError as error:
            self.say(f"NOT KEPT: {error}")

    def next_readout(self) -> None:
        """Position, distance to go, distance from home."""
        self.choose_setting("readout", self.readout.following.value)

    def close(self) -> None:
        """End the loading and whatever drives the machine."""
        self.session.close()
        for part in (self.editor, self.special, self.files, self.mdi, self.searchto, self.effect):
            if part is not None:
                part.close()
        self.shut()

    def hear(self, event: Event) -> None:
        """What the executor has to say; it may be called from its thread."""
        self.answers.hear(event)
        self.log.hear(event)

    def barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        if self.stop_held() or not self.starts_here:
            return prompts.STOP_HELD if self.stop_held() else prompts.NOT_HERE
        for page in (self.mdi, self.searchto):
            if page is not None and page.open:
                return page.barred()
        if self.restoring:
            return prompts.RESTORING
        loaded = self.session.now
        if self.snapshot().state is not State.IDLE:
            return ""
        if loaded.phase is Phase.UNREADABLE:
            return prompts.refusal(loaded)  # the executor still has what was there before
        stale = self.rebuilding.wanted or self.book.busy or self.zero.busy or loaded.phase is Phase.READING
        return prompts.STALE if stale else ""
