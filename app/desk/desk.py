"""The desk: what an operator can do on the Automatic page, and what the control answers. No Qt, never waits.

Every method that a key or finger calls returns at once. What it cannot do it says on the prompt line
(``notice``); what it does it posts, and the next snapshot tells whether it happened.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from app.desk import prompts
from app.desk.alarms import AlarmLog
from app.desk.files.record import RunRecord
from app.desk.hands import OVERRIDE_MOST, StationHands, stepped
from app.desk.offsets.book import NONE_KEPT, OffsetBook
from app.desk.offsets.force import use_offsets
from app.desk.pulse import Pulse
from app.desk.session import Loaded, Phase, Session
from app.desk.settings import SettingsBook
from app.desk.shelf import Shelf
from app.desk.special.counter import PartCounter
from app.desk.station import StationPanel
from app.desk.view import Readout, Tone, View, view_of
from app.desk.zero_offsets.book import NONE_KEPT as NO_ZERO
from app.desk.zero_offsets.book import ZeroBook
from core.executor.commands import (
    Command,
    CycleStart,
    EnableDrives,
    FeedHold,
    FeedOverride,
    Reset,
    SetSwitch,
)
from core.executor.job import outdated
from core.executor.snapshot import Event, Snapshot, Starts, State
from core.store.errors import StoreError

if TYPE_CHECKING:
    from app.desk.editing.editor import Editor
    from app.desk.files.files import FilesDesk
    from app.desk.mdi.mdi import MdiDesk
    from app.desk.offsets.effect import Effect
    from app.desk.searchto.search import SearchDesk
    from app.desk.special.special import SpecialDesk
    from core.machine.model import Machine

SWITCHES = frozenset({"single_block", "optional_stop", "cycle_repeat"})
SILENT = "CONTROL SILENT"
HEARD = 100  # events that wait for the next frame; older ones are in the log
UNDER_WAY = prompts.MOVING | prompts.INTERRUPTED


def _nothing() -> None:
    """A desk without an executor of its own has nothing to close."""


def _time_of_day() -> str:
    return time.strftime("%H:%M:%S")


@dataclass(slots=True)
class Desk:
    """The model behind the Automatic page.

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
    notice: str = ""
    effect: Effect | None = None  # draws what a change of offsets does
    book: OffsetBook = field(default_factory=lambda: OffsetBook(locked=NONE_KEPT))
    zero: ZeroBook = field(default_factory=lambda: ZeroBook(locked=NO_ZERO))
    starts_here: bool = True  # whether the page in front is one on which cycles are started
    hands: StationHands = field(init=False)
    log: AlarmLog = field(init=False)
    _giving_up: bool = False
    _rebuild: bool = False
    _changes: int = 0  # of the book, as far as they were seen
    _refused: str = ""
    _unkept: str = ""
    _noticed_in: State | None = None
    _pulse: Pulse = field(default_factory=Pulse)
    _heard: deque[Event] = field(default_factory=lambda: deque(maxlen=HEARD))

    def __post_init__(self) -> None:
        self.log = AlarmLog(self.time_of_day)
        self.hands = StationHands(
            self.station, self.clock, self.say, self.clear, self._starting, self._barred
        )

    def look(self) -> tuple[Snapshot, View, Loaded]:
        """One snapshot, and what the page shows of it; called once a frame."""
        self.hands.turn_knobs()
        snapshot = self.snapshot()
        self.log.see(snapshot.alarms)
        self._answer(snapshot)
        self._tell_unkept()
        self._build_anew(snapshot)
        loaded = self.session.now
        if snapshot.starts is not Starts.LINE:  # a line of MDI is no run of the program
            self.counter.see(snapshot, self.post, self.say)
            self.record.see(snapshot, loaded)
        view = view_of(snapshot, self.readout, self.with_c, self.settings.units)
        if self._pulse.silent(snapshot.t, self.hands.clock()):
            view = replace(view, state=SILENT, tone=Tone.ALARM)
        return snapshot, view, loaded

    def prompt(self, snapshot: Snapshot, loaded: Loaded, page: str = "") -> str:
        """The prompt line: the answer to the last key, or else what can be done now.

        ``page`` is what the page in front would say there; an alarm and an E-stop go before it.
        """
        if self._pulse.is_silent:
            return prompts.CONTROL_SILENT
        if self.notice and snapshot.state is not self._noticed_in:
            self.clear()
        if self.notice:
            return self.notice
        if page:
            return prompts.alarm_of(snapshot) or page
        return prompts.prompt(snapshot, loaded, self.start_words, self.release_words)

    def time_left(self, snapshot: Snapshot, loaded: Loaded) -> float:
        """Seconds to the end of the cycle at the present override; infinite while it stands still."""
        picture = loaded.picture
        if picture is None or loaded.proof is None:
            return float("inf")
        to_go = math.dist(snapshot.block_end[:2], snapshot.actual[:2])
        left = picture.time_left(snapshot.block, to_go)
        return left / snapshot.feed_override if snapshot.feed_override > 0 else float("inf")

    @property
    def start_words(self) -> str:
        """How a cycle is started at this machine."""
        if self.station is None:
            return "PRESS BOTH PALM BUTTONS" if self.two_hand else "PRESS CYCLE START"
        return "PRESS BOTH PALM BUTTONS (F11 + F12)" if self.two_hand else "PRESS CYCLE START (F12)"

    @property
    def release_words(self) -> str:
        """How the E-stop is freed at this machine."""
        return "RELEASE THE BUTTON" if self.station is None else "RELEASE THE BUTTON (SHIFT+E)"

    def say(self, text: str) -> None:
        """Put an answer on the prompt line; it stays until the next key or the next state."""
        self.notice = text
        self._noticed_in = self.snapshot().state

    def clear(self) -> None:
        """Take the answer back."""
        self.notice = ""
        self._giving_up = False

    # --- program -------------------------------------------------------------------------------------

    def may_choose(self) -> bool:
        """Whether a program can be chosen now; says why not."""
        if self.snapshot().state in UNDER_WAY:
            self.say("A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE CHOOSING ANOTHER")
            return False
        return True

    def choose(self, typed: str) -> bool:
        """Load the program that was typed or picked; False when there is none of that name."""
        path = self.shelf.find(typed)
        if path is None:
            return False
        self.clear()
        self.session.load(path, self.session.now.block_delete)
        return True

    def _build_anew(self, snapshot: Snapshot) -> None:
        """When offsets were changed the program is read and proved anew, as soon as none is under way."""
        trouble, before = self.book.poll() or self.zero.poll(), self._changes
        self._changes = self.book.changes + self.zero.changes
        if trouble:
            self.say(f"REFUSED: {trouble}")
        if self._changes != before or self._outdated(snapshot):
            self._rebuild = True
        if self._rebuild and snapshot.state not in UNDER_WAY and not (self.book.busy or self.zero.busy):
            self._rebuild = False
            self.post(use_offsets(self.book.tools, self.book.secondary))  # at once, for the loaded tool
            now = self.session.now
            if now.path is not None:
                self.session.load(now.path, now.block_delete)

    def _outdated(self, snapshot: Snapshot) -> bool:
        """The job before has left another unit than this program was proved with, and it names none."""
        now = self.session.now
        at_rest = snapshot.state is State.IDLE and not now.busy and now.phase is not Phase.UNREADABLE
        return at_rest and now.job is not None and bool(outdated(now.job, snapshot.modal))

    # --- keys ----------------------------------------------------------------------------------------

    def switch(self, name: str) -> None:
        """Turn ``single_block``, ``optional_stop`` or ``cycle_repeat`` over."""
        if name not in SWITCHES:
            raise ValueError(f"there is no switch called {name!r}")
        self.clear()
        self.post(SetSwitch(name, not getattr(self.snapshot(), name)))

    def block_delete(self) -> None:
        """Turn Block Delete over. It is part of the job that was proved, so the program is loaded anew."""
        loaded = self.session.now
        if loaded.path is None:
            self.say("CHOOSE A PROGRAM FIRST: BLOCK DELETE BELONGS TO THE PROGRAM THAT IS PROVED")
        elif self.snapshot().state in UNDER_WAY:
            self.say("BLOCK DELETE CHANGES WHAT WAS PROVED: ONLY BETWEEN TWO CYCLES")
        else:
            self.clear()
            self.session.load(loaded.path, not loaded.block_delete)

    def feed_hold(self) -> None:
        """Feed hold, whatever else is going on."""
        self.post(FeedHold())
        self.clear()

    def reset(self) -> None:
        """Acknowledge an alarm; give up an interrupted program, after asking once."""
        state = self.snapshot().state
        if state in prompts.MOVING:
            self.say("THE MACHINE IS MOVING: PRESS H FOR FEED HOLD FIRST")
        elif state in prompts.INTERRUPTED and not self._giving_up:
            self.say(prompts.GIVE_UP)
            self._giving_up = True
        else:
            self.clear()
            self.post(Reset())

    def enable(self) -> None:
        """Switch the drives on, after E-stop or power-up."""
        state = self.snapshot().state
        if state is State.DISABLED:
            self.clear()
            self.post(EnableDrives())
        elif state is State.ESTOP:
            self.say(f"THE E-STOP IS STILL PRESSED: {self.release_words} FIRST")
        elif state is State.FAULT:
            self.say("AN ALARM STANDS: PRESS R TO ACKNOWLEDGE IT FIRST")
        else:
            self.say("THE DRIVES ARE ON")

    def escape(self) -> None:
        """Esc takes a question back; while something moves it holds, because it is what a hand hits first."""
        if self.notice:
            self.clear()
        elif self.snapshot().state in prompts.MOVING:
            self.feed_hold()

    def next_readout(self) -> None:
        """Position, distance to go, distance from home."""
        self.choose_setting("readout", self.readout.following.value)

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

    # --- station -------------------------------------------------------------------------------------

    def start_button(self) -> None:
        """Cycle start of a machine with one button."""
        if self._barred():
            self.say(self._barred())
        elif not self.two_hand:
            self.clear()
            self.post(CycleStart())

    def turn_spindle_switch(self) -> None:
        """The spindle switch to its other side."""
        self.hands.set_spindle_auto(not self.snapshot().spindle_auto)

    def override(self, steps: int) -> None:
        """Change the feed override by so many steps of ten percent.

        Where there is a station its pot is turned, so that knob and value never differ.
        """
        if self.station is not None:
            self.hands.set_feed_pot(stepped(self.hands.feed_pot, steps))
            return
        wanted = stepped(self.snapshot().feed_override, steps)
        self.post(FeedOverride(max(0.0, min(OVERRIDE_MOST, wanted))))

    def _barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        if not self.starts_here:
            return prompts.NOT_HERE
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
        stale = self._rebuild or self.book.busy or self.zero.busy or loaded.phase is Phase.READING
        return prompts.STALE if stale else ""

    def _starting(self) -> None:
        """A start is tried: the same refusal again is worth saying again."""
        self._refused = ""

    def close(self) -> None:
        """End the loading and whatever drives the machine."""
        self.session.close()
        for part in (self.editor, self.special, self.files, self.mdi, self.searchto, self.effect):
            if part is not None:
                part.close()
        self.shut()

    def hear(self, event: Event) -> None:
        """What the executor has to say; it may be called from its thread."""
        self._heard.append(event)

    def _tell_unkept(self) -> None:
        """A disk that fails in the middle of a run is told once, not found out the day after."""
        trouble = self.unkept()
        if trouble != self._unkept:
            self._unkept = trouble
            if trouble:
                self.say(f"NOT KEPT: {trouble}")

    def _answer(self, snapshot: Snapshot) -> None:
        """Nothing is refused in silence: a refused start, and whatever else the executor would not do."""
        while self._heard:
            event = self._heard.popleft()
            if event.kind == "refused" and event.text != snapshot.start_refused:
                self.say(f"REFUSED: {event.text}")
        if snapshot.start_refused != self._refused:
            self._refused = snapshot.start_refused
            if self._refused:
                self.say(f"NO START: {self._refused}")
