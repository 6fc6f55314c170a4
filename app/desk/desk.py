"""The model of the Automatic page and of the running TurnDesk, without Qt and without waiting.

Every method that a key or a touch calls returns at once. If the action is not possible, the prompt line shows
why (``notice``). Otherwise the method posts a command, and a later snapshot shows the result.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

from app.desk.access import Access
from app.desk.late_presses import LatePresses, Starting
from app.desk.pages.desk_parts import Closing
from app.desk.pages.page_registry import PageRegistry
from app.desk.persistence import Persistence
from app.desk.posted_values import PostedValues
from app.desk.programs.program_choice import LAST_PROGRAM, ProgramChoice
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import Loaded, Phase, ProgramLoader
from app.desk.programs.program_renewal import ProgramRenewal
from app.desk.programs.start_watch import StartWatch
from app.desk.screen_settings import SettingsBook
from app.desk.state.desk_clock import DeskClock
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.desk.state.program_runs import ProgramRuns
from app.desk.state.station_keys import StationKeys
from app.desk.state.storage_state import StorageState
from app.desk.state.window_state import WindowState
from app.desk.station_hands import StationHands
from app.desk.status import prompt_line
from app.desk.status.alarm_log import AlarmLog
from app.desk.status.machine_file_changes import FileChanges
from app.desk.status.machine_status import MachineStatus, Tone, status_of
from app.desk.status.prompt_line import ONE_HAND, ONE_PALM, YES, PromptAnswers
from app.desk.status.readouts import Readout
from app.desk.stop_keys.stop_records import BY_ESC, BY_SCREEN
from app.desk.translation import tr
from app.offsets.offset_book import NONE_KEPT, OffsetBook
from core.access.access_table import Act
from core.closing import ClosingStep
from core.executor.commands import (
    Command,
    ConfirmStart,
    EnableDrives,
    FeedHold,
    Reset,
    SetSwitch,
)
from core.executor.snapshot import LINES, Event, Snapshot, Starts, State
from core.message import Message
from core.store.store_errors import StoreError

SWITCHES = frozenset({"single_block", "optional_stop", "cycle_repeat", "no_count"})
SILENT = "CONTROL SILENT"
_NO_MACHINE = DeskMachine()


class Desk:
    """The model of the Automatic page, and the objects that all pages share.

    ``persistence`` stores settings, levels, counts and runs. Without it, they are lost when TurnDesk closes.
    ``first_move`` checks the first move of a start, if the machine supports this check.
    """

    def __init__(
        self,
        control: DeskControl,
        session: ProgramLoader,
        folders: ProgramFolders,
        *,
        machine: DeskMachine = _NO_MACHINE,
        persistence: Persistence | None = None,
        book: OffsetBook | None = None,
        changes: FileChanges | None = None,
        first_move: StartWatch | None = None,
        clock: DeskClock | None = None,
    ) -> None:
        persistence = persistence or Persistence()
        self.session: Final = session
        self.machine: Final = machine
        self.first_move: Final = first_move
        self.clock: Final = clock or DeskClock()
        # Changes of the machine file that the operator must accept.
        self.changes: Final = changes or FileChanges()
        self.book: Final = book or OffsetBook(locked=NONE_KEPT)
        self.window: Final = WindowState(LatePresses(self.snapshot, self.clock.seconds))
        self.control: Final = replace(control, post=self.window.late.guard(control.post))
        self.storage: Final = StorageState()
        self.pages: Final = PageRegistry()
        if first_move is not None:
            self.pages.attach(first_move)
        self.closing: Final = Closing()
        self.settings: Final = SettingsBook(persistence)
        self.runs: Final = ProgramRuns(persistence)
        self.log: Final = AlarmLog(self.clock.time_of_day)
        self.answers: Final = PromptAnswers(self.snapshot, self.storage.problem, self._now)
        self.access: Final = Access(persistence, self.say, self.clock.seconds)
        self.book.access = self.access
        self.rebuilding: Final = ProgramRenewal(session, self.warn)
        self.programs: Final = ProgramChoice(folders, session, self.snapshot, self.answers, self._save_path)
        self.hands: Final = StationHands(
            control.panel,
            self.clock.seconds,
            self.say,
            self.clear,
            self.answers.starting,
            self.barred,
            self.window.press_age,
            one_palm=ONE_HAND if machine.one_hand else ONE_PALM,
        )
        self.hands.refuse_late(self.window.late)
        self.station: Final = StationKeys(
            self.control,
            self.hands,
            self.answers,
            self.barred,
            lambda press: self.feed_hold(press=press),
            machine.two_hand,
            PostedValues(self.clock.seconds),
        )

    def _now(self) -> float:
        return self.hands.clock()

    def _save_path(self, path: str) -> None:
        self.keep(partial(self.settings.persistence.save_setting, LAST_PROGRAM, path))

    def post(self, command: Command) -> None:
        """Send a command to the control. Later snapshots show its effect."""
        self.control.post(command)

    def snapshot(self) -> Snapshot:
        """Return the newest snapshot of the control."""
        return self.control.snapshot()

    def say(self, text: str) -> None:
        """Show a message for 4 s or until the next key."""
        self.answers.say(text)

    def warn(self, text: str) -> None:
        """Show a message for 4 s, even if a key is pressed, for example because input was dropped."""
        self.answers.say(text, lasting=True)

    def done(self, text: str) -> None:
        """Show a success message, which is drawn differently from a refusal."""
        self.answers.say(text, done=True)

    def refuse(self, why: str) -> None:
        """Show that an action was rejected, with the reason."""
        self.say(Message("REJECTED: {why}", why=why))

    def ask(self, question: str, yes: Callable[[], None], key: str = YES) -> None:
        """Ask the operator to confirm an action that loses data or moves the machine.

        The question has the form ``PRESS Y TO …, N TO …``. Esc means N. ``key`` means yes, and differs from
        the key that caused the question. On a touch screen, the prompt line has a button for the answer.
        """
        self.answers.ask(question, yes, key)

    @property
    def asked(self) -> str:
        """The key that means yes to the open question. Empty if no question is open."""
        return self.answers.key if self.answers.asked is not None else ""

    def clear(self) -> None:
        """Remove the message or the question from the prompt line."""
        self.answers.take_back()

    @property
    def notice(self) -> str:
        """The message for the last key, or else the open question. Empty if there is neither."""
        return self.answers.notice

    @property
    def start_words(self) -> str:
        """The instruction for starting a cycle at this machine."""
        if self.control.panel is None:
            return "PRESS BOTH PALM BUTTONS" if self.machine.two_hand else "PRESS CYCLE START"
        if self.machine.two_hand and self.machine.one_hand and self.settings.now.latched:
            return "PRESS ONE PALM BUTTON, THEN THE OTHER (F11, F12)"
        return "PRESS BOTH PALM BUTTONS (F11 + F12)" if self.machine.two_hand else "PRESS CYCLE START (F12)"

    @property
    def release_words(self) -> str:
        """The instruction for releasing the E-stop at this machine."""
        if self.window.has_field():
            by_hand = "F1, THEN U: RELEASE E-STOP"
            return by_hand if self.control.panel is not None else "RELEASE THE E-STOP (F1: LEAVE THE PAGE)"
        return "RELEASE THE E-STOP" if self.control.panel is None else "RELEASE THE E-STOP (U)"

    @property
    def readout(self) -> Readout:
        """The kind of value that the large position display shows."""
        return Readout(self.settings.now.readout)

    def refused(self, act: Act) -> bool:
        """Return whether the access level is too low for this act, and show the reason if it is."""
        why = self.access.refusal(act)
        if why:
            self.say(why)
        return bool(why)

    def choose_setting(self, name: str, value: object) -> None:
        """Apply a screen setting.

        If it cannot be saved, a message is shown and the setting lasts until TurnDesk closes.
        """
        if not self.refused(Act.SCREEN):
            self.keep(partial(self.settings.choose, name, value))

    def keep(self, change: Callable[[], None]) -> None:
        """Call a function that saves data, and show a message if saving fails."""
        try:
            change()
        except StoreError as error:
            self.say(Message("NOT SAVED: {error}", error=error))

    def next_readout(self) -> None:
        """Switch the large position display to position, distance to go or distance from home in turn."""
        self.choose_setting("readout", self.readout.following.value)

    def close(self) -> None:
        """Stop the machine and close its drivers, then end the workers and close all attached models."""
        own = [ClosingStep("loading", self.session.close), ClosingStep("levels", self.access.close)]
        self.closing.close([*own, *self.pages.closing_steps()])

    def hear(self, event: Event) -> None:
        """Accept an event of the executor. This method may be called from the executor's thread."""
        self.answers.hear(event)
        self.log.hear(event)

    def barred(self) -> str:
        """Return why the start buttons have no effect now. Empty if they can start a cycle."""
        if self.window.is_stop_held() or not self.window.starts_here:
            return prompt_line.STOP_HELD if self.window.is_stop_held() else prompt_line.NOT_HERE
        if self.storage.restoring:
            return prompt_line.RESTORING
        if (page := self.pages.open_start) is not None:
            return page.barred()
        loaded = self.session.now
        if self.snapshot().state is not State.IDLE:
            return ""
        if loaded.phase is Phase.UNREADABLE:
            return prompt_line.refusal(loaded)  # The executor still has the previous program.
        stale = self.rebuilding.wanted or self.book.busy or loaded.phase is Phase.READING
        return prompt_line.STALE if stale else ""

    # --- every frame ---------------------------------------------------------------------------------

    def look(self) -> tuple[Snapshot, MachineStatus, Loaded]:
        """Update the models once a frame. Return the snapshot, the machine status and the loaded program."""
        self.hands.turn_knobs()
        snapshot = self.snapshot()
        self.access.look(snapshot)
        self.answers.look(snapshot)
        self.rebuilding.look(snapshot, self.book, self.post)
        loaded = self.session.now
        if self.first_move is not None:
            self.first_move.see(snapshot, loaded)
        self._see_runs(snapshot, loaded)
        machine, settings = self.machine, self.settings
        view = status_of(
            snapshot,
            self.readout,
            machine.with_c,
            settings.units,
            machine.language,
            machine.third_axis,
            machine.table_turns,
        )
        if self.control.silence.silent(snapshot.t, self.hands.clock()):
            view = replace(view, state=SILENT, tone=Tone.ALARM)
        return snapshot, view, loaded

    def _see_runs(self, snapshot: Snapshot, loaded: Loaded) -> None:
        if snapshot.starts not in LINES:  # An MDI line does not count as a run of the program.
            self.runs.see(snapshot, loaded, self.post, self.say)
            self.pages.see_run(snapshot, loaded)
        self.pages.see_frame(snapshot)
        if caution := self.runs.new_caution(snapshot, loaded):
            self.say(tr(Message("CAUTION: {what}. PAUSE KEY: FEED HOLD", what=caution)))
        if self.settings.now.first_job:
            self.keep(partial(self.runs.follow_first_job, snapshot, loaded))

    def first_move_refusal(self, snapshot: Snapshot) -> str:
        """Return why the first move prevents a start of the program. Empty if the first move is clear."""
        if self.first_move is None or snapshot.state is not State.IDLE:
            return ""
        return self.first_move.refusal if snapshot.starts is Starts.PROGRAM else ""

    # --- keys ----------------------------------------------------------------------------------------

    def switch(self, name: str) -> None:
        """Toggle ``single_block``, ``optional_stop``, ``cycle_repeat`` or ``no_count``.

        Raises ValueError for another name.
        """
        if name not in SWITCHES:
            raise ValueError(f"there is no switch called {name!r}")
        self.clear()
        self.post(SetSwitch(name, self.station.posted.toggled(name, getattr(self.snapshot(), name))))

    def may_close(self, close: Callable[[], None]) -> bool:
        """Return whether TurnDesk can close without losing unsaved work.

        If work would be lost, ask first; Y then calls ``close``.
        """
        waiting = self.storage.waiting()
        if waiting:
            words = tr("UNSAVED WORK WILL BE LOST: {what}. Y: CLOSE   N: STAY")
            self.ask(tr(Message(words, what=waiting)), close)
        return not waiting

    def feed_hold(self, by: str = BY_SCREEN, press: int = 0) -> None:
        """Start feed hold in any state of the machine.

        ``press`` is the number of the key press, 0 if unknown.
        """
        self.post(FeedHold(by, press))
        self.clear()

    def reset(self) -> None:
        """Acknowledge an alarm, or cancel an interrupted program after the operator confirms.

        If the control is silent, start another one where this is possible.
        """
        state = self.snapshot().state
        if self.control.silence.is_silent and self.control.restart is not None:
            self.clear()
            self.control.restart()
        elif state in prompt_line.MOVING:
            self.say("THE MACHINE IS MOVING. FIRST PRESS PAUSE (FEED HOLD)")
        elif state in prompt_line.INTERRUPTED:
            self.ask(prompt_line.GIVE_UP, self._give_up)
        else:
            self._give_up()

    def _give_up(self) -> None:
        self.clear()
        self.post(Reset())

    def yes(self) -> None:
        """Handle the key Y.

        Y confirms the open question. Without a question, Y confirms that an interrupted job starts again at
        line 1.
        """
        snapshot = self.snapshot()
        found, here = snapshot.interrupted, self.window.starts_here
        if self.asked:
            self.answer()
        elif found is None or not snapshot.interrupted_line:
            self.clear()
        elif snapshot.state is not State.IDLE or snapshot.starts is not Starts.PROGRAM or not here:
            self.say(tr("Y: AUTOMATIC PAGE ONLY, DRIVES ON"))
        elif refusal := self.first_move_refusal(snapshot):
            self.say(Message("{no_start}: {refusal}", no_start=prompt_line.NO_START, refusal=refusal))
        else:
            self.clear()
            self.post(ConfirmStart(found.at))

    def no(self) -> None:
        """Handle the key N: reject the open question, or cancel the confirmed start at line 1."""
        self.clear()
        if self.snapshot().confirmed:
            self.post(ConfirmStart(""))

    def enable(self) -> None:
        """Switch the drives on after an E-stop or after power-up, or show why this is not possible."""
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
        """Handle the Esc key; return False if there was nothing to do.

        Esc cancels an open question, or a confirmed start at line 1. While the machine moves, Esc starts feed
        hold. A message without a question does not delay the feed hold.
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
        """Confirm the open question if the machine is still in the state in which the question was asked."""
        if self.window.late.refuses(Starting.YES):
            return
        self.answers.expire(self.snapshot())
        self.answers.yes(self.hands.at())

    @property
    def read(self) -> bool:
        """Whether the open question was shown long enough before the present key press to have been read."""
        return self.answers.read(self.hands.at())
