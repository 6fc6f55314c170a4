"""Model of the Automatic page and of the running TurnDesk. It does not use Qt and never blocks.

Every method that a key or a touch calls returns immediately. If the action is not possible, the prompt line
shows the reason (``prompt_notice``). Otherwise the method posts a command, and a later snapshot shows the
result.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

from app.desk.access import UserAccess
from app.desk.late_presses import BlockedLateAction, LatePressFilter
from app.desk.pages.attached_parts import ClosingSequence
from app.desk.pages.page_registry import PageRegistry
from app.desk.persistence import Persistence
from app.desk.posted_values import PostedValues
from app.desk.programs.program_choice import LAST_PROGRAM_SETTING, ProgramChoice
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase, ProgramLoader
from app.desk.programs.program_renewal import ProgramRenewal
from app.desk.programs.recent_programs import RecentPrograms
from app.desk.programs.start_watch import FirstMoveWatch
from app.desk.screen_settings import SettingsStore
from app.desk.state.desk_clock import DeskClock
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.desk.state.program_runs import ProgramRuns
from app.desk.state.station_keys import StationKeys
from app.desk.state.storage_state import StorageState
from app.desk.state.window_state import WindowState
from app.desk.station_controls import StationControls
from app.desk.status import prompt_line
from app.desk.status.alarm_log import AlarmLog
from app.desk.status.machine_file_changes import MachineFileChanges
from app.desk.status.machine_status import MachineStatus, StatusTone, make_machine_status
from app.desk.status.prompt_line import ONE_HAND_HINT, ONE_PALM_PRESSED, YES_KEY, PromptLine
from app.desk.status.readouts import ReadoutKind
from app.desk.stop_keys.stop_records import SOURCE_ESC, SOURCE_SCREEN
from app.desk.translation import tr
from app.offsets.offset_book import OFFSETS_NOT_STORED, OffsetBook
from core.access.access_table import ProtectedChange
from core.closing_steps import ClosingStep
from core.executor.commands import (
    Command,
    ConfirmStart,
    EnableDrives,
    FeedHold,
    Reset,
    SetSwitch,
)
from core.executor.snapshot import MDI_ACTIONS, LogEvent, MachineState, Snapshot, StartAction
from core.message import Message
from core.store.store_errors import StoreError

RUN_SWITCHES = frozenset({"single_block", "optional_stop", "cycle_repeat", "no_count"})
CONTROL_SILENT_TITLE = "CONTROL SILENT"
_NO_MACHINE = DeskMachine()


class Desk:
    """Model of the Automatic page, with the objects that all pages share.

    ``persistence`` stores settings, access levels, counts and runs. Without it, these data are lost when
    TurnDesk closes. ``start_watch`` checks the first move of the next start before that start, if the
    machine supports this check.
    """

    def __init__(
        self,
        control: DeskControl,
        program_loader: ProgramLoader,
        folders: ProgramFolders,
        *,
        machine: DeskMachine = _NO_MACHINE,
        persistence: Persistence | None = None,
        offset_book: OffsetBook | None = None,
        file_changes: MachineFileChanges | None = None,
        start_watch: FirstMoveWatch | None = None,
        clock: DeskClock | None = None,
        closing_sequence: ClosingSequence | None = None,
    ) -> None:
        persistence = persistence or Persistence()
        self.program_loader: Final = program_loader
        self.machine: Final = machine
        self.start_watch: Final = start_watch
        self.clock: Final = clock or DeskClock()
        # Changes of the machine file that the operator must accept.
        self.changes: Final = file_changes or MachineFileChanges()
        self.offset_book: Final = offset_book or OffsetBook(lock_reason=OFFSETS_NOT_STORED)
        self.window_state: Final = WindowState(LatePressFilter(self.read_snapshot, self.clock.read_seconds))
        self.desk_control: Final = replace(
            control, post=self.window_state.late_presses.guard_post_command(control.post)
        )
        self.storage_state: Final = StorageState()
        self.page_registry: Final = PageRegistry()
        if start_watch is not None:
            self.page_registry.attach_model(start_watch)
        self._closing_sequence: Final = closing_sequence or ClosingSequence()
        self.settings_store: Final = SettingsStore(persistence)
        self.program_runs: Final = ProgramRuns(persistence)
        self.alarm_log: Final = AlarmLog(self.clock.format_local_time)
        self.prompt_line: Final = PromptLine(
            self.read_snapshot, self.storage_state.read_storage_problem, self._now
        )
        self.user_access: Final = UserAccess(persistence, self.say, self.clock.read_seconds)
        self.offset_book.user_access = self.user_access
        self.renewal: Final = ProgramRenewal(program_loader, self.show_warning)
        self.recent_programs: Final = RecentPrograms(persistence, self.try_save)
        self.program_choice: Final = ProgramChoice(
            folders, program_loader, self.read_snapshot, self.prompt_line, self._save_path
        )
        self.station_controls: Final = StationControls(
            control.station_panel,
            self.clock.read_seconds,
            self.say,
            self.clear_prompt_line,
            self.prompt_line.record_start_attempt,
            self.barred,
            self.window_state.find_press_age_s,
            one_palm_message=ONE_HAND_HINT if machine.allows_one_hand_start else ONE_PALM_PRESSED,
        )
        self.station_controls.set_late_press_filter(self.window_state.late_presses)
        self.station_keys: Final = StationKeys(
            self.desk_control,
            self.station_controls,
            self.prompt_line,
            self.barred,
            lambda press: self.start_feed_hold(press=press),
            machine.has_two_hand_start,
            PostedValues(self.clock.read_seconds),
        )

    def _now(self) -> float:
        return self.station_controls.clock()

    def _save_path(self, path: str) -> None:
        self.try_save(partial(self.settings_store.persistence.save_setting, LAST_PROGRAM_SETTING, path))
        self.recent_programs.add(path)

    def post(self, command: Command) -> None:
        """Send a command to the control. Later snapshots show its effect."""
        self.desk_control.post(command)

    def read_snapshot(self) -> Snapshot:
        """Return the newest snapshot of the control."""
        return self.desk_control.read_snapshot()

    def say(self, text: str) -> None:
        """Show a message on the prompt line for 4 s or until the next key press."""
        self.prompt_line.say(text)

    def show_warning(self, text: str) -> None:
        """Show a warning on the prompt line for 4 s, for example about dropped input.

        Key presses do not remove it.
        """
        self.prompt_line.say(text, is_lasting=True)

    def show_success(self, text: str) -> None:
        """Show a message that an action has succeeded. Its style differs from that of a refusal."""
        self.prompt_line.say(text, is_success=True)

    def show_refusal(self, reason: str) -> None:
        """Show a message that an action was rejected, with the reason."""
        self.say(Message("REJECTED: {why}", why=reason))

    def ask_operator(self, question: str, on_confirmed: Callable[[], None], key: str = YES_KEY) -> None:
        """Ask the operator to confirm an action that loses data or moves the machine.

        The question has the form ``PRESS Y TO …, N TO …``. Esc means N. ``key`` is the key that means yes.
        It must differ from the key that opened the question. On a touch screen, the prompt line has a
        button for the reply.
        """
        self.prompt_line.ask_question(question, on_confirmed, key)

    @property
    def confirmation_key(self) -> str:
        """Return the key that means yes to the open question, or an empty string if no question is open."""
        return self.prompt_line.key if self.prompt_line.on_confirmed is not None else ""

    def clear_prompt_line(self) -> None:
        """Remove the message or the question from the prompt line."""
        self.prompt_line.withdraw_question()

    @property
    def prompt_notice(self) -> str:
        """Return the open question or the message for the last key, or an empty string if neither exists."""
        return self.prompt_line.shown_message

    @property
    def start_instruction(self) -> str:
        """Return the instruction for starting a cycle at this machine."""
        if self.desk_control.station_panel is None:
            return "PRESS BOTH PALM BUTTONS" if self.machine.has_two_hand_start else "PRESS CYCLE START"
        if (
            self.machine.has_two_hand_start
            and self.machine.allows_one_hand_start
            and self.settings_store.current_settings.latched
        ):
            return "PRESS ONE PALM BUTTON, THEN THE OTHER (F11, F12)"
        return (
            "PRESS BOTH PALM BUTTONS (F11 + F12)"
            if self.machine.has_two_hand_start
            else "PRESS CYCLE START (F12)"
        )

    @property
    def release_instruction(self) -> str:
        """Return the instruction for releasing the E-stop at this machine."""
        if self.window_state.has_text_field():
            by_hand = "F1, THEN U: RELEASE E-STOP"
            return (
                by_hand
                if self.desk_control.station_panel is not None
                else "RELEASE THE E-STOP (F1: LEAVE THE PAGE)"
            )
        return "RELEASE THE E-STOP" if self.desk_control.station_panel is None else "RELEASE THE E-STOP (U)"

    @property
    def readout_kind(self) -> ReadoutKind:
        """Return the kind of value that the large position display shows."""
        return ReadoutKind(self.settings_store.current_settings.readout)

    def is_refused(self, change: ProtectedChange) -> bool:
        """Return whether the access level is too low for this change, and if so, show the reason."""
        why = self.user_access.find_refusal_reason(change)
        if why:
            self.say(why)
        return bool(why)

    def apply_setting(self, name: str, value: object) -> None:
        """Apply a screen setting.

        If the setting cannot be saved, a message is shown, and the setting applies until TurnDesk closes.
        """
        if not self.is_refused(ProtectedChange.SCREEN):
            self.try_save(partial(self.settings_store.choose, name, value))

    def close_card(self) -> None:
        """Close the card that guides the operator: the card of a feature, otherwise that of the first job."""
        if not self.page_registry.close_guidance_card():
            self.apply_setting("first_job", False)

    def try_save(self, save: Callable[[], None]) -> None:
        """Call ``save``, and show a message if saving fails."""
        try:
            save()
        except StoreError as error:
            self.say(Message("NOT SAVED: {error}", error=error))

    def select_next_readout(self) -> None:
        """Switch the large position display to the next kind of readout.

        The kinds are position, distance to go, and distance from home.
        """
        self.apply_setting("readout", self.readout_kind.next_kind.value)

    def close(self) -> None:
        """Stop the machine, close its drivers, end the workers, and close all attached models."""
        own = [
            ClosingStep("loading", self.program_loader.close),
            ClosingStep("levels", self.user_access.close),
        ]
        self._closing_sequence.close([*own, *self.page_registry.make_closing_steps()])

    def hear(self, event: LogEvent) -> None:
        """Process an event of the executor. The executor's thread may call this method."""
        self.prompt_line.hear(event)
        self.alarm_log.hear(event)

    def barred(self) -> str:
        """Return the reason why the start buttons are disabled, or an empty string if they are enabled."""
        if self.window_state.is_stop_key_held() or not self.window_state.can_start_here:
            return (
                prompt_line.RELEASE_STOP_KEY
                if self.window_state.is_stop_key_held()
                else prompt_line.START_ON_AUTOMATIC
            )
        if self.storage_state.is_restoring:
            return prompt_line.RESTORE_IN_PROGRESS
        if (page := self.page_registry.active_start_handler) is not None:
            return page.barred()
        loaded = self.program_loader.loaded_program
        if self.read_snapshot().state is not MachineState.IDLE:
            return ""
        if loaded.phase is LoadingPhase.UNREADABLE:
            return prompt_line.make_refusal_text(loaded)  # The executor still has the previous program.
        stale = (
            self.renewal.is_requested or self.offset_book.is_saving or loaded.phase is LoadingPhase.READING
        )
        return prompt_line.RELOAD_IN_PROGRESS if stale else ""

    # --- every frame ---------------------------------------------------------------------------------

    def update(self) -> tuple[Snapshot, MachineStatus, LoadedProgram]:
        """Update the models, and return the snapshot, the machine status and the loaded program.

        This method is called once per frame.
        """
        self.station_controls.advance_pots()
        snapshot = self.read_snapshot()
        self.user_access.update(snapshot)
        self.prompt_line.update(snapshot)
        self.renewal.update(snapshot, self.offset_book, self.post)
        loaded = self.program_loader.loaded_program
        if self.start_watch is not None:
            self.start_watch.update(snapshot, loaded)
        self._see_runs(snapshot, loaded)
        machine, settings = self.machine, self.settings_store
        view = make_machine_status(
            snapshot,
            self.readout_kind,
            machine.has_c_axis,
            settings.display_units,
            machine.program_language,
            machine.third_axis_name,
            machine.is_table_rotary,
        )
        if self.desk_control.silence_watch.check_silence(snapshot.t, self.station_controls.clock()):
            view = replace(view, state_text=CONTROL_SILENT_TITLE, state_tone=StatusTone.ALARM)
        return snapshot, view, loaded

    def _see_runs(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        if snapshot.starts not in MDI_ACTIONS:  # An MDI line does not count as a run of the program.
            self.program_runs.record_frame(snapshot, loaded, self.post, self.say)
            self.page_registry.notify_run_watchers(snapshot, loaded)
        self.page_registry.notify_frame_watchers(snapshot)
        if caution := self.program_runs.pop_part_warning(snapshot, loaded):
            self.say(tr(Message("CAUTION: {what}. PAUSE KEY: FEED HOLD", what=caution)))
        if self.settings_store.current_settings.first_job:
            self.try_save(partial(self.program_runs.update_first_job, snapshot, loaded))

    def find_first_move_refusal(self, snapshot: Snapshot) -> str:
        """Return the reason why the program's first move must not start, or an empty string if it may."""
        if self.start_watch is None or snapshot.state is not MachineState.IDLE:
            return ""
        return self.start_watch.start_refusal if snapshot.starts is StartAction.PROGRAM else ""

    # --- keys ----------------------------------------------------------------------------------------

    def toggle_switch(self, name: str) -> None:
        """Toggle ``single_block``, ``optional_stop``, ``cycle_repeat`` or ``no_count``.

        Raises ValueError for any other name.
        """
        if name not in RUN_SWITCHES:
            raise ValueError(f"there is no switch called {name!r}")
        self.clear_prompt_line()
        self.post(
            SetSwitch(
                name, self.station_keys.posted_values.toggle_value(name, getattr(self.read_snapshot(), name))
            )
        )

    def can_close(self, close: Callable[[], None]) -> bool:
        """Return whether TurnDesk can close without losing unsaved work.

        If work would be lost, this method asks the operator, and the reply Y calls ``close``.
        """
        waiting = self.storage_state.read_unsaved_text()
        if waiting:
            words = tr("UNSAVED WORK WILL BE LOST: {what}. Y: CLOSE   N: STAY")
            self.ask_operator(tr(Message(words, what=waiting)), close)
        return not waiting

    def start_feed_hold(self, source: str = SOURCE_SCREEN, press: int = 0) -> None:
        """Start feed hold in any state of the machine.

        ``press`` is the number of the key press, or 0 if unknown.
        """
        self.post(FeedHold(source, press))
        self.clear_prompt_line()

    def reset_control(self) -> None:
        """Acknowledge an alarm, or cancel an interrupted program after the operator confirms.

        If the control does not respond, the method starts a new control where possible.
        """
        state = self.read_snapshot().state
        if self.desk_control.silence_watch.is_silent and self.desk_control.restart_control is not None:
            self.clear_prompt_line()
            self.desk_control.restart_control()
        elif state in prompt_line.MOVING_STATES:
            self.say("THE MACHINE IS MOVING. FIRST PRESS PAUSE (FEED HOLD)")
        elif state in prompt_line.INTERRUPTED_STATES:
            self.ask_operator(prompt_line.CONFIRM_CANCEL, self._give_up)
        else:
            self._give_up()

    def _give_up(self) -> None:
        self.clear_prompt_line()
        self.post(Reset())

    def confirm_question(self) -> None:
        """Handle the key Y, which confirms the open question.

        Without a question, Y confirms that an interrupted job starts again at line 1.
        """
        snapshot = self.read_snapshot()
        found, here = snapshot.interrupted, self.window_state.can_start_here
        if self.confirmation_key:
            self.confirm_question_if_unchanged()
        elif found is None or not snapshot.interrupted_line:
            self.clear_prompt_line()
        elif (
            snapshot.state is not MachineState.IDLE or snapshot.starts is not StartAction.PROGRAM or not here
        ):
            self.say(tr("Y: AUTOMATIC PAGE ONLY, DRIVES ON"))
        elif refusal := self.find_first_move_refusal(snapshot):
            self.say(Message("{no_start}: {refusal}", no_start=prompt_line.WILL_NOT_START, refusal=refusal))
        else:
            self.clear_prompt_line()
            self.post(ConfirmStart(found.at))

    def reject_question(self) -> None:
        """Handle the key N, which rejects the open question or cancels a confirmed start at line 1."""
        self.clear_prompt_line()
        if self.read_snapshot().confirmed:
            self.post(ConfirmStart(""))

    def enable_drives(self) -> None:
        """Switch the drives on after an E-stop or power-up, or show the reason if this is not possible."""
        state = self.read_snapshot().state
        if state is MachineState.DISABLED:
            self.clear_prompt_line()
            self.post(EnableDrives())
        elif state is MachineState.ESTOP:
            self.say(Message("E-STOP STILL PRESSED. {release_words}", release_words=self.release_instruction))
        elif state is MachineState.FAULT:
            self.say("ALARM ACTIVE: PRESS R TO ACKNOWLEDGE IT FIRST")
        else:
            self.show_success("THE DRIVES ARE ALREADY ON")

    def handle_escape(self) -> bool:
        """Handle the Esc key, and return False if it has no effect.

        Esc cancels an open question or a confirmed start at line 1. While the machine moves, Esc starts
        feed hold. A message on the prompt line does not delay the feed hold.
        """
        shot = self.read_snapshot()
        moves = shot.state in prompt_line.MOVING_STATES
        if self.confirmation_key or (self.prompt_notice and not moves):
            self.clear_prompt_line()
        elif shot.confirmed:
            self.post(ConfirmStart(""))
        elif moves:
            self.clear_prompt_line()
            self.start_feed_hold(SOURCE_ESC)
        else:
            return False
        return True

    def confirm_question_if_unchanged(self) -> None:
        """Confirm the open question if the state of the machine has not changed since it was asked."""
        if self.window_state.late_presses.refuse_late_press(BlockedLateAction.YES):
            return
        self.prompt_line.remove_expired_texts(self.read_snapshot())
        self.prompt_line.confirm_question(self.station_controls.at())

    @property
    def was_question_read(self) -> bool:
        """Return whether the operator had enough time to read the open question.

        This is the time from the display of the question to the current key press.
        """
        return self.prompt_line.was_question_read(self.station_controls.at())
