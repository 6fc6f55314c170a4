"""The desk: what an operator can do on the Automatic page, and what the control answers. No Qt, never waits.

Every method that a key or finger calls returns at once. What it cannot do it says on the prompt line
(``notice``); what it does it posts, and the next snapshot tells whether it happened.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from app.desk.access import Access
from app.desk.late_presses import LatePresses, Starting
from app.desk.page_description import ProgramKey
from app.desk.pages.desk_parts import Attached, Closing, OwnStart, Watcher
from app.desk.pages.first_job import FirstJob
from app.desk.pages.page_entry import program_barred
from app.desk.posted_values import PostedValues
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import Loaded, PartProved, Phase, ProgramLoader
from app.desk.programs.program_renewal import ProgramRenewal
from app.desk.programs.start_watch import StartWatch
from app.desk.screen_settings import SettingsBook
from app.desk.station_hands import StationHands, StationPanel, override_of
from app.desk.status import interrupted_notice, prompt_line
from app.desk.status.alarm_log import AlarmLog
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.machine_file_changes import FileChanges
from app.desk.status.machine_status import MachineStatus, SilenceWatch, Tone, status_of
from app.desk.status.prompt_line import ONE_HAND, UNDER_WAY, YES, PromptAnswers
from app.desk.status.readouts import Readout
from app.desk.stop_keys.stop_records import BY_ESC, BY_SCREEN
from app.desk.stop_keys.watched_keys import OpenLine
from app.desk.translation import tr
from app.offsets.offset_book import NONE_KEPT, OffsetBook
from app.programs.run_history import PartCounter, RunHistory
from core.access.access_table import Act
from core.closing import ClosingStep
from core.executor.commands import (
    Command,
    ConfirmStart,
    CycleStart,
    EnableDrives,
    FeedHold,
    FeedOverride,
    Reset,
    SetSwitch,
)
from core.executor.snapshot import LINES, Event, Snapshot, Starts, State
from core.message import Message
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from core.machine.machine_model import Machine
    from core.records.recordings import Recordings

SWITCHES = frozenset({"single_block", "optional_stop", "cycle_repeat", "no_count"})
SILENT = "CONTROL SILENT"
LAST_PROGRAM = "last_program"  # setting: the path of the program that was loaded last
A = TypeVar("A", bound=Attached)


@dataclass(slots=True)
class Desk:
    """The model behind the Automatic page, and what every page shares.

    ``station`` is there with the simulated machine only; ``two_hand`` as the machine file says.
    """

    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    session: ProgramLoader
    program_folders: ProgramFolders
    station: StationPanel | None = None
    two_hand: bool = True
    with_c: bool = True
    machine: str = ""
    lathe: Machine | None = None  # what the machine file says, for moves by hand
    one_hand: bool = False  # nothing real moves: palms may be pressed one after the other
    set_input: Callable[[str, bool], None] | None = None  # of a simulated machine
    closing: Closing = field(default_factory=Closing)
    waiting: Callable[[], str] = str  # what of it waits in memory, in words
    differs: Callable[[], str] = str  # how the file on the disk is not the program on the desk
    saved_here: Callable[[], None] = lambda: None  # called when the editor has written a program file
    not_kept: Callable[[], str] = str  # why events, parts and versions are not being kept
    clock: Callable[[], float] = time.monotonic
    time_of_day: Callable[[], str] = field(default=partial(time.strftime, "%H:%M:%S"))
    settings: SettingsBook = field(default_factory=SettingsBook)
    access: Access = field(default_factory=Access)  # who works here, and what he may change
    counter: PartCounter = field(default_factory=PartCounter)
    record: RunHistory = field(default_factory=RunHistory)
    open_record: Callable[[str], None] = field(default=lambda _name: None)  # of an alarm, in the scope
    recorder: Recordings | None = None  # of the scope: the last minutes of samples
    restoring: bool = False  # a backup takes the place of what is kept
    book: OffsetBook = field(default_factory=lambda: OffsetBook(locked=NONE_KEPT))
    changes: FileChanges = field(default_factory=FileChanges)  # of the machine file, to be accepted
    stirs: Callable[[], None] = lambda: None  # called from any thread when a machine at rest has changed
    open_stop_line: OpenLine = lambda: None  # to the control, past the screen
    stop_held: Callable[[], bool] = bool  # whether a key that stops is held down
    starts_here: bool = True  # whether the page in front is one on which cycles are started
    field_open: Callable[[], bool] = bool  # whether a field of that page has the letters
    keyboard_away: bool = False  # another window has the keyboard: no key comes here
    late: LatePresses = field(init=False)
    hands: StationHands = field(init=False)
    log: AlarmLog = field(init=False)
    answers: PromptAnswers = field(init=False)
    rebuilding: ProgramRenewal = field(init=False)
    first_job: FirstJob = field(default_factory=FirstJob)
    own_starts: list[OwnStart] = field(default_factory=list)
    frame_watchers: list[Callable[[Snapshot], None]] = field(default_factory=list)  # called once a frame
    offered: Callable[[Snapshot], NoticeRow | None] = lambda _snapshot: None  # between cycles: the next job
    first_move: StartWatch | None = None  # what is known of it
    program_keys: dict[str, ProgramKey] = field(default_factory=dict)  # keys of features in the program list
    watches: list[Watcher] = field(default_factory=list)  # what else looks at every frame
    silence: SilenceWatch = field(default_factory=SilenceWatch)
    _attached: dict[type[Attached], Attached] = field(default_factory=dict)
    _made_later: dict[str, Callable[[], Attached]] = field(default_factory=dict)  # by names of classes
    _part_told: PartProved | None = None
    _posted: PostedValues = field(init=False)

    def __post_init__(self) -> None:
        self.late = LatePresses(self.snapshot, self.clock)
        self.post = self.late.guard(self.post)
        self._posted = PostedValues(self.clock)
        self.log = AlarmLog(self.time_of_day)
        self.answers = PromptAnswers(self.snapshot, lambda: self.not_kept(), lambda: self.hands.clock())  # noqa: PLW0108
        self.rebuilding = ProgramRenewal(self.session, self.warn)
        starting = self.answers.starting
        self.hands = StationHands(self.station, self.clock, self.say, self.clear, starting, self.barred)
        self.hands.refuse_late(self.late)
        if self.one_hand:
            self.hands.one_palm = ONE_HAND

    def say(self, text: str) -> None:
        """Show an answer; it remains for 4 s or until the next key."""
        self.answers.say(text)

    def warn(self, text: str) -> None:
        """Show an answer that no key removes before its 4 s are over: input was dropped, for example."""
        self.answers.say(text, lasting=True)

    def done(self, text: str) -> None:
        """Say that it was done: a success looks different from a refusal."""
        self.answers.say(text, done=True)

    def refuse(self, why: str) -> None:
        """Say that it was not done, and why."""
        self.say(Message("REJECTED: {why}", why=why))

    def ask(self, question: str, yes: Callable[[], None], key: str = YES) -> None:
        """Ask before something is lost or moves: ``PRESS Y TO …, N TO …``. Esc is N.

        ``key`` means yes, and is never the one that asked; a finger has a target on the prompt line.
        """
        self.answers.ask(question, yes, key)

    @property
    def asked(self) -> str:
        """The key that means yes to the question that stands; empty while none does."""
        return self.answers.key if self.answers.asked is not None else ""

    def clear(self) -> None:
        """Take the answer or the question back."""
        self.answers.take_back()

    @property
    def notice(self) -> str:
        """The answer to the last key, or without one the question; empty without either."""
        return self.answers.notice

    @property
    def start_words(self) -> str:
        """How a cycle is started at this machine."""
        if self.station is None:
            return "PRESS BOTH PALM BUTTONS" if self.two_hand else "PRESS CYCLE START"
        if self.two_hand and self.one_hand and self.settings.now.latched:
            return "PRESS ONE PALM BUTTON, THEN THE OTHER (F11, F12)"
        return "PRESS BOTH PALM BUTTONS (F11 + F12)" if self.two_hand else "PRESS CYCLE START (F12)"

    @property
    def release_words(self) -> str:
        """How the E-stop is freed at this machine."""
        if self.field_open():
            by_hand = "F1, THEN U: RELEASE E-STOP"
            return by_hand if self.station is not None else "RELEASE THE E-STOP (F1: LEAVE THE PAGE)"
        return "RELEASE THE E-STOP" if self.station is None else "RELEASE THE E-STOP (U)"

    @property
    def language(self) -> str:
        """The machine's own language, in which MDI is typed."""
        return self.lathe.language if self.lathe is not None else "omniturn"

    @property
    def readout(self) -> Readout:
        """What the large figures show."""
        return Readout(self.settings.now.readout)

    def refused(self, act: Act) -> bool:
        """Whether the level in force is too low to change this; it is said then, with how to get it."""
        why = self.access.refusal(act)
        if why:
            self.say(why)
        return bool(why)

    def choose_setting(self, name: str, value: object) -> None:
        """Take a choice of the screen; where it cannot be kept it counts until the end, and that is said."""
        if not self.refused(Act.SCREEN):
            self.keep(partial(self.settings.choose, name, value))

    def keep(self, change: Callable[[], None]) -> None:
        """Do what is to be kept; that it is not is said."""
        try:
            change()
        except StoreError as error:
            self.say(Message("NOT SAVED: {error}", error=error))

    def next_readout(self) -> None:
        """Position, distance to go, distance from home."""
        self.choose_setting("readout", self.readout.following.value)

    def close(self) -> None:
        """Stop the machine and close its drivers; then end the workers and all that is attached."""
        own = [ClosingStep("loading", self.session.close), ClosingStep("levels", self.access.close)]
        attached = [ClosingStep(kind.__name__, part.close) for kind, part in self._attached.items()]
        self.closing.close([*own, *attached])

    def attach(self, part: Attached) -> None:
        """Have the model of a page with the desk: it is found by its class, and ends with the desk."""
        self._attached[type(part)] = part

    def attach_later(self, kind: str, make: Callable[[], Attached]) -> None:
        """The same with one that is made, and whose class is loaded, when somebody first asks for it.

        ``kind`` is its class with the module, as ``app.editor.editor.Editor``.
        """
        self._made_later[kind] = make

    def attached(self, kind: type[A]) -> A | None:
        """What is attached of this class; None: the desk was put together without."""
        make = self._made_later.pop(f"{kind.__module__}.{kind.__qualname__}", None)
        if make is not None:
            self.attach(make())
        part = self._attached.get(kind)
        return part if isinstance(part, kind) else None

    def hear(self, event: Event) -> None:
        """What the executor has to say; it may be called from its thread."""
        self.answers.hear(event)
        self.log.hear(event)

    def barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        if self.stop_held() or not self.starts_here:
            return prompt_line.STOP_HELD if self.stop_held() else prompt_line.NOT_HERE
        if self.restoring:
            return prompt_line.RESTORING
        for page in self.own_starts:
            if page.open:
                return page.barred()
        loaded = self.session.now
        if self.snapshot().state is not State.IDLE:
            return ""
        if loaded.phase is Phase.UNREADABLE:
            return prompt_line.refusal(loaded)  # the executor still has what was there before
        stale = self.rebuilding.wanted or self.book.busy or loaded.phase is Phase.READING
        return prompt_line.STALE if stale else ""

    # --- every frame ---------------------------------------------------------------------------------

    def look(self) -> tuple[Snapshot, MachineStatus, Loaded]:
        """One snapshot, and what the page shows of it; called once a frame."""
        self.hands.turn_knobs()
        snapshot = self.snapshot()
        self.access.look(snapshot)
        self.answers.look(snapshot)
        self.rebuilding.look(snapshot, self.book, self.post)
        loaded = self.session.now
        if self.first_move is not None:
            self.first_move.see(snapshot, loaded)
        if snapshot.starts not in LINES:  # a line of MDI is no run of the program
            text = loaded.job.text_digest if loaded.job is not None else self.counter.text
            self.counter.see(snapshot, self.post, self.say, text)
            self.record.see(snapshot, loaded)
            for watcher in self.watches:
                watcher.see(snapshot, loaded)
        for watch in self.frame_watchers:
            watch(snapshot)
        self._tell_part(snapshot, loaded)
        if self.settings.now.first_job:
            self.first_job.see(snapshot, loaded, self.counter.count)
            self.keep(partial(self.first_job.save, self.settings.persistence))
        third = self.lathe.third_axis if self.lathe is not None else "C"
        table = self.lathe is None or self.lathe.table_turns
        view = status_of(
            snapshot, self.readout, self.with_c, self.settings.units, self.language, third, table
        )
        if self.silence.silent(snapshot.t, self.hands.clock()):
            view = replace(view, state=SILENT, tone=Tone.ALARM)
        return snapshot, view, loaded

    def first_move_refusal(self, snapshot: Snapshot) -> str:
        """Why Cycle Start does not begin the program from here; empty when its first move is clear."""
        if self.first_move is None or snapshot.state is not State.IDLE:
            return ""
        return self.first_move.refusal if snapshot.starts is Starts.PROGRAM else ""

    def _tell_part(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """What the part of a program was warned of after it was started is told at once."""
        part, told = loaded.part, self._part_told
        self._part_told = part
        if part is not None and part is not told and part.warned and snapshot.state in UNDER_WAY:
            self.say(tr(Message("CAUTION: {what}. PAUSE KEY: FEED HOLD", what=part.warned[0])))

    # --- program -------------------------------------------------------------------------------------

    def may_choose(self) -> bool:
        """Whether a program can be chosen now; says why not."""
        if why := program_barred(self.snapshot()):
            self.say(why)
        return not why

    def choose(self, typed: str) -> bool:
        """Load the program that was typed or picked; False when there is none of that name."""
        path = self.program_folders.find(typed)
        if path is None:
            return False
        self.put_on_desk(path)
        return True

    def put_on_desk(self, path: Path) -> None:
        """Load it; where it would take the place of an interrupted job that is asked first."""
        found = self.snapshot().interrupted
        self.clear()
        if found is not None and found.program != path.name:
            self.ask(interrupted_notice.instead(found, path.name), partial(self._load, path))
        else:
            self._load(path)

    def _load(self, path: Path) -> None:
        if self.may_choose():
            self.session.load(path, self.session.now.block_delete)
            self.keep(partial(self.settings.persistence.save_setting, LAST_PROGRAM, str(path)))

    # --- keys ----------------------------------------------------------------------------------------

    def switch(self, name: str) -> None:
        """Turn ``single_block``, ``optional_stop``, ``cycle_repeat`` or ``no_count`` over."""
        if name not in SWITCHES:
            raise ValueError(f"there is no switch called {name!r}")
        self.clear()
        self.post(SetSwitch(name, self._posted.toggled(name, getattr(self.snapshot(), name))))

    def block_delete(self) -> None:
        """Turn Block Delete over. It is part of the job that was proved, so the program is loaded anew."""
        loaded = self.session.now
        if loaded.path is None:
            self.say("F2: CHOOSE A PROGRAM BEFORE CHANGING BLOCK DELETE")
        elif self.snapshot().state in UNDER_WAY:
            self.say("CHANGE BLOCK DELETE ONLY BETWEEN CYCLES")
        else:
            self.clear()
            self.session.load(loaded.path, not loaded.block_delete)

    def may_close(self, close: Callable[[], None]) -> bool:
        """Whether the control may be left; where something would be lost by it Y does ``close``."""
        waiting = self.waiting()
        if waiting:
            words = tr("UNSAVED WORK WILL BE LOST: {what}. Y: CLOSE   N: STAY")
            self.ask(tr(Message(words, what=waiting)), close)
        return not waiting

    def feed_hold(self, by: str = BY_SCREEN, press: int = 0) -> None:
        """Feed hold, whatever else is going on; ``press`` is the number of the press of a key."""
        self.post(FeedHold(by, press))
        self.clear()

    def reset(self) -> None:
        """Acknowledge an alarm; give up an interrupted program, after asking once."""
        state = self.snapshot().state
        if state in prompt_line.MOVING:
            self.say("THE MACHINE IS MOVING. FIRST PRESS PAUSE (FEED HOLD)")
        elif state in prompt_line.INTERRUPTED:
            self.ask(prompt_line.GIVE_UP, self._give_up)
        else:
            self._give_up()

    def _give_up(self) -> None:
        self.clear()
        self.post(Reset())

    def yes(self) -> None:
        """Y: yes to the question that stands, or else to what is asked about an interrupted job."""
        snapshot = self.snapshot()
        found = snapshot.interrupted
        if self.asked:
            self.answer()
        elif found is None or not snapshot.interrupted_line:
            self.clear()
        elif (
            snapshot.state is not State.IDLE or not self.starts_here or snapshot.starts is not Starts.PROGRAM
        ):
            self.say(tr("Y: AUTOMATIC PAGE ONLY, DRIVES ON"))
        elif refusal := self.first_move_refusal(snapshot):
            self.say(Message("{no_start}: {refusal}", no_start=prompt_line.NO_START, refusal=refusal))
        else:
            self.clear()
            self.post(ConfirmStart(found.at))

    def no(self) -> None:
        """N: no to the question that is asked, or to the start at line 1 that was confirmed; never more."""
        self.clear()
        if self.snapshot().confirmed:
            self.post(ConfirmStart(""))

    def enable(self) -> None:
        """Switch the drives on, after E-stop or power-up."""
        state = self.snapshot().state
        if state is State.DISABLED:
            self.clear()
            self.post(EnableDrives())
        elif state is State.ESTOP:
            self.say(Message("E-STOP STILL PRESSED. {release_words}", release_words=self.release_words))
        elif state is State.FAULT:
            self.say("ALARM ACTIVE: PRESS R TO ACKNOWLEDGE IT FIRST")
        else:
            self.done("THE DRIVES ARE ALREADY ON")

    def escape(self) -> bool:
        """Esc takes a question back; while something moves it holds, because it is what a hand hits first.

        What is only told, asked for or not, comes not before the hold. False when there was nothing to do.
        """
        shot = self.snapshot()
        moves = shot.state in prompt_line.MOVING
        if self.asked or (self.notice and not moves):
            self.clear()
        elif shot.confirmed:
            self.post(ConfirmStart(""))
        elif moves:
            self.clear()
            self.feed_hold(BY_ESC)
        else:
            return False
        return True

    def answer(self) -> None:
        """Yes to what is asked, as long as the machine is in the state in which it was asked."""
        if self.late.refuses(Starting.YES):
            return
        self.answers.expire(self.snapshot())
        self.answers.yes(self.hands.at())

    @property
    def read(self) -> bool:
        """Whether the question that stands can have been read when what is handled now was pressed."""
        return self.answers.read(self.hands.at())

    # --- station -------------------------------------------------------------------------------------

    def estop(self, press: int = 0) -> None:
        """The mushroom of the simulated station. A real one is no key: this holds the feed, and says so."""
        if self.station is None:
            self.feed_hold(press=press)
            self.say(prompt_line.NO_MUSHROOM)
        else:
            self.hands.estop(pressed=True)

    def twist_out(self) -> None:
        """Free the E-stop of the simulated station, after asking."""
        if self.station is None:
            self.say(prompt_line.NO_MUSHROOM)
        elif not self.hands.estop_pressed:
            self.say("THE E-STOP IS NOT PRESSED")
        else:
            self.ask(prompt_line.TWIST_OUT, partial(self.hands.estop, pressed=False))

    def start_button(self) -> None:
        """Cycle start of a machine with one button."""
        if self.barred():
            self.say(self.barred())
        elif not self.two_hand:
            self.clear()
            self.post(CycleStart())

    def turn_spindle_switch(self) -> None:
        """The spindle switch to its other side."""
        self.hands.set_spindle_auto(not self.snapshot().spindle_auto)

    def override(self, steps: int) -> None:
        """Change the feed override by so many steps of ten percent, at the pot where there is a station."""
        if self.station is not None:
            self.hands.turn_feed_pot(steps)
            return
        shown = self.snapshot().feed_override
        self.post(FeedOverride(self._posted.changed("feed", shown, lambda now: override_of(now, steps))))
