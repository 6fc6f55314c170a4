"""Prompt line, which shows the currently possible actions and the response to the last key.

The state, the question and the message have separate places on the screen. A message remains for 4 s or
until the next key press. The prompt depends on one snapshot and the loaded program.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum

from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.desk.status import interrupted_notice
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import mark_untranslated, tr
from core.alarms import CATALOG, AlarmCode
from core.executor.job import WARNING_PREFIX
from core.executor.snapshot import Alarm, LogEvent, MachineState, Snapshot
from core.language.diagnostics import Severity
from core.message import Message
from core.tool_edges import format_edge_name

# Stops with a message of the program.
PROGRAM_STOP_CODES: frozenset[AlarmCode] = frozenset({"program-stop", "optional-stop"})
FILE_NOT_FOUND_TEXT = "FILE NOT FOUND, PRESS ANY KEY TO CONTINUE"
FILE_QUESTION = "FILE TO BE PROCESSED"
CHOOSE_FILE_TEXT = "TYPE A NAME OR SELECT A PROGRAM   ENTER: LOAD   ESC: CLOSE"
NO_NAME_TYPED = "TO EDIT, FIRST TYPE A NAME OR SELECT ONE WITH THE ARROWS"
ONE_PALM_PRESSED = "ONLY ONE PALM BUTTON PRESSED: PRESS BOTH WITHIN 0.5 S"
ONE_HAND_HINT = "PRESS BOTH PALM BUTTONS WITHIN 0.5 S. ONE-HAND MODE: F10, 7"
RELEASE_STOP_KEY = "RELEASE THE STOP KEY FIRST"
RELEASE_BOTH_PALMS = "RELEASE BOTH PALM BUTTONS, THEN PRESS BOTH WITHIN 0.5 S"
CONTROL_SILENT = "CONTROL NOT RESPONDING. PRESS E-STOP. SCREEN IS NOT LIVE"
RESTART_CONTROL = "CONTROL NOT RESPONDING. PRESS E-STOP, THEN R TO RESTART IT"
START_ON_AUTOMATIC = "START CYCLES ON THE AUTOMATIC PAGE: PRESS F1, THEN F2"
RESTORE_IN_PROGRESS = "CANNOT START: A BACKUP IS BEING RESTORED"
RELOAD_IN_PROGRESS = "CANNOT START: THE PROGRAM IS BEING RELOADED"
WILL_NOT_START = "WILL NOT START"  # Beginning of a prompt for a program that will not start.
CONFIRM_CANCEL = "PRESS Y TO CANCEL THE PROGRAM, N TO KEEP IT"
CONFIRM_ESTOP_RELEASE = "PRESS Y TO RELEASE THE E-STOP, N TO LEAVE IT PRESSED"
NO_ESTOP_BUTTON = "PRESS E-STOP ON THE MACHINE. THIS KEY ONLY STARTED FEED HOLD"
HOLD_HINT = "FEED HOLD: PAUSE, H OR ESC   E-STOP: SCROLL LOCK (STOP)"
STOP_KEYS_INACTIVE = "STOP KEYS DO NOT WORK. TAP THIS WINDOW OR USE THE BUTTONS"
MOVING_STATES = frozenset(
    {MachineState.RUN, MachineState.STOPPING, MachineState.WAIT, MachineState.JOG, MachineState.HOMING}
)
INTERRUPTED_STATES = frozenset({MachineState.HOLD, MachineState.SINGLE_BLOCK_STOP, MachineState.PROGRAM_STOP})
ACTIVE_STATES = MOVING_STATES | INTERRUPTED_STATES


def make_prompt(
    snapshot: Snapshot,
    loaded: LoadedProgram,
    start_instruction: str,
    release_instruction: str,
    *,
    is_field_open: bool = False,
) -> str:
    """Return the prompt for the current state.

    ``start_instruction`` and ``release_instruction`` are the instructions for starting a cycle and for
    releasing the E-stop. ``is_field_open`` is True if letters are text input.
    """
    go_on = Message("TO CONTINUE: {start}. R: CANCEL THE PROGRAM", start=start_instruction)
    standing = {
        MachineState.ESTOP: _estop(release_instruction),
        MachineState.DISABLED: "DRIVES ARE OFF: PRESS D FOR DRIVES ON",
        MachineState.FAULT: make_alarm_prompt(snapshot, release_instruction, is_field_open=is_field_open),
        MachineState.RUN: HOLD_HINT,
        MachineState.JOG: HOLD_HINT,
        MachineState.WAIT: HOLD_HINT,
        MachineState.STOPPING: "STOPPING",
        MachineState.HOLD: go_on,
        MachineState.SINGLE_BLOCK_STOP: go_on,
        MachineState.PROGRAM_STOP: go_on,
        MachineState.HOMING: "HOMING THE AXES",
    }
    return standing.get(snapshot.state) or _idle(snapshot, loaded, start_instruction)


def find_announcements(snapshot: Snapshot, *, can_start_here: bool = True) -> tuple[str, ...]:
    """Return the messages about the next start, which take precedence over all other prompts.

    Warnings of the proof are included only on a page where a cycle can be started.
    """
    return tuple(text for text in snapshot.announced if can_start_here or not text.startswith(WARNING_PREFIX))


def make_alarm_prompt(snapshot: Snapshot, release_instruction: str, *, is_field_open: bool = False) -> str:
    """Return the prompt for an alarm or an E-stop. It replaces the prompt of the current page.

    The prompt is empty if there is neither an alarm nor an E-stop.
    """
    if snapshot.state is MachineState.FAULT:
        if not snapshot.alarms:
            return "ALARM: CORRECT THE CAUSE, THEN PRESS R TO ACKNOWLEDGE"
        if is_field_open:
            return Message(
                "WHAT TO DO: {remedy}  ·  F1: LEAVE THE PAGE, THEN R: ACKNOWLEDGE",
                remedy=snapshot.alarms[0].remedy,
            )
        return Message(
            "WHAT TO DO: {remedy}  ·  R: ACKNOWLEDGE   F7: ALARM LIST", remedy=snapshot.alarms[0].remedy
        )
    return _estop(release_instruction) if snapshot.state is MachineState.ESTOP else ""


def _estop(release: str) -> str:
    return Message("E-STOP: MAKE THE MACHINE SAFE. {release}. THEN D: DRIVES ON", release=release)


def reason(status: MachineStatus) -> str:
    """Return the text below the prompt, which states the cause of a stop.

    For a feed hold, the text also states the remedy.
    """
    if status.alarms:
        return Message("CAUSE: {stop}", stop=describe_cause(status.alarms[0]))
    if status.stop_cause is None:
        return ""
    cause = Message("CAUSE: {stop}", stop=describe_cause(status.stop_cause))
    return (
        cause
        if status.stop_cause.code == "estop"
        else Message("{cause}  ·  WHAT TO DO: {remedy}", cause=cause, remedy=status.stop_cause.remedy)
    )


def describe_cause(alarm: Alarm) -> str:
    """Return the cause of an alarm.

    If the alarm catalog gives a different most likely cause, the text also contains that cause.
    """
    likely = alarm.causes[0] if alarm.causes else ""
    cause = translate_cause(alarm)
    return (
        cause if likely in {"", alarm.cause} else Message("{cause}; {likely}", cause=cause, likely=tr(likely))
    )


def translate_cause(alarm: Alarm) -> str:
    """Return the translated cause of an alarm, but leave a program's text at M00 or M01 untranslated."""
    of_program = alarm.code in PROGRAM_STOP_CODES and alarm.cause not in CATALOG[alarm.code].causes
    return mark_untranslated(alarm.cause) if of_program else tr(alarm.cause)


def _idle(snapshot: Snapshot, loaded: LoadedProgram, start: str) -> str:
    if loaded.is_busy:
        return _progress(loaded)
    asked = interrupted_notice.make_interrupted_prompt(snapshot, loaded, start)
    return find_start_obstacle(snapshot, loaded) or asked or Message("TO START: {start}", start=start)


def find_start_obstacle(snapshot: Snapshot, loaded: LoadedProgram) -> str:
    """Return the reason why the loaded program cannot start now, or an empty string if it can start."""
    if loaded.phase in {LoadingPhase.UNREADABLE, LoadingPhase.REFUSED}:
        return make_refusal_text(loaded)
    if not snapshot.program:
        return "PRESS F2 TO CHOOSE A PROGRAM"
    if snapshot.needs_proof:
        return "THE PROGRAM IS NOT PROVED YET AND WILL NOT START"
    missing = find_unmeasured_tools(loaded)
    if missing and "Y" in snapshot.axes:
        return Message("WILL NOT START: {missing} NOT IN THE TOOL TABLE (F8)", missing=", ".join(missing))
    if missing:
        return Message(
            "WILL NOT START: NO OFFSET SET FOR {missing}. SET IT WITH F8", missing=", ".join(missing)
        )
    return (
        Message("WILL NOT START: {next_barred}", next_barred=snapshot.next_barred)
        if snapshot.next_barred
        else ""
    )


def find_unmeasured_tools(loaded: LoadedProgram) -> list[str]:
    """Return the tools of the loaded program that do not have a measured offset."""
    if loaded.proof is None or loaded.job is None:
        return []
    return [format_edge_name(key) for key in loaded.proof.unset(loaded.job)]


def make_refusal_text(loaded: LoadedProgram) -> str:
    """Return the message that the loaded program will not run.

    The message contains the program's first error and the number of further errors.
    """
    if loaded.phase is LoadingPhase.UNREADABLE:
        return Message(
            "{loaded} CANNOT BE LOADED: {problem}. F2: CHOOSE ANOTHER PROGRAM",
            loaded=loaded.name,
            problem=loaded.error_text,
        )
    errors = loaded.blocking_errors
    if not errors:
        first = (
            loaded.proof.errors[0] if loaded.proof and loaded.proof.errors else ("ERRORS FOUND WHEN PROVING")
        )
        return Message("WILL NOT RUN: {text}", text=first)
    first_error = errors[0]
    more = len(errors) - 1
    said = (
        Message("{first_error} ({more} MORE)", first_error=first_error.message, more=more)
        if more
        else first_error.message
    )
    return (
        Message("WILL NOT RUN: LINE {line}: {text}", line=first_error.line, text=said)
        if first_error.line
        else Message("WILL NOT RUN: {text}", text=said)
    )


def find_remedy(loaded: LoadedProgram, prompt: str) -> str:
    """Return the remedy for the program error that ``prompt`` shows.

    If the program has no error and the prompt offers a start, return the first warning of a check.
    Otherwise the result is an empty string.
    """
    errors = loaded.blocking_errors
    if errors:
        return errors[0].hint if prompt == make_refusal_text(loaded) else ""
    restart = tr("RESUME AT THIS LINE: {start}. ESC: CANCEL").partition("{start}")[0]
    if "TO START: " not in prompt and restart not in prompt:
        return ""
    warned = (each for each in loaded.diagnostics if each.check_name and each.severity is Severity.WARNING)
    first = next(warned, None)
    return (
        Message("LINE {line}: {first}  ·  {hint}", line=first.line, first=first.text, hint=first.hint)
        if first is not None
        else ""
    )


def _progress(loaded: LoadedProgram) -> str:
    count = Message(" {reached} BLOCKS", reached=loaded.progress_count) if loaded.progress_count else ""
    return Message("{phase} {loaded}{count}", phase=loaded.phase.value, loaded=loaded.name, count=count)


# --- answers and questions ----------------------------------------------------------------------------


MAX_PENDING_EVENTS = 100  # Events that wait for the next frame. Older events are in the log.


class MessageKind(StrEnum):
    """Kind of a message. Each kind has a different color and symbol."""

    REFUSAL = "answer"  # A refusal, or an instruction for what to do first.
    SUCCESS = "done"
    QUESTION = "asked"


YES_KEY = "Y"
READING_TIME_S = 0.5  # Seconds for reading a question. An earlier key press is not an answer.


MESSAGE_TIME_S = 4.0  # Seconds for which a message remains without a key press.


@dataclass(slots=True)
class PromptLine:
    """The message and the question on the prompt line.

    A message remains for ``MESSAGE_TIME_S`` seconds or until the next key press, even if the machine's
    state changes. A question is valid only in the machine state in which it was asked. Y executes its
    action. N and Esc only remove the question. An action that loses data is confirmed by a separate key,
    which differs from the key that opened the question. ``read_time_s`` returns monotonic time in seconds.
    """

    read_snapshot: Callable[[], Snapshot]
    # Returns why events, parts and versions are not being saved; empty if they are.
    read_storage_problem: Callable[[], str]
    read_time_s: Callable[[], float]
    message: str = ""
    question_text: str = ""
    on_confirmed: Callable[[], None] | None = None  # Action of the answer yes.
    key: str = YES_KEY  # Key that means yes.
    is_success_message: bool = False  # The message reports a success.
    is_lasting_message: bool = False  # No key removes the message before its time is over.
    _waiting: tuple[str, bool] = ("", False)  # Text that waits for a lasting message; whether a success.
    _said_at: float = 0.0
    _since: float = 0.0
    _in: MachineState | None = None
    _refused: str = ""
    _not_kept: str = ""
    _heard: deque[LogEvent] = field(default_factory=lambda: deque(maxlen=MAX_PENDING_EVENTS))

    @property
    def shown_message(self) -> str:
        """Return the message, or the open question if there is no message."""
        return self.message or self.question_text

    @property
    def notice_kind(self) -> MessageKind:
        """Return the kind of the message or question that is displayed."""
        if not self.message and self.on_confirmed is not None:
            return MessageKind.QUESTION
        return MessageKind.SUCCESS if self.is_success_message else MessageKind.REFUSAL

    def say(self, text: str, *, is_success: bool = False, is_lasting: bool = False) -> None:
        """Show a message. ``is_success`` marks it as a success message.

        A key press does not remove a message with ``is_lasting``. Until its time ends, only another lasting
        message replaces it, and the latest other message waits.
        """
        if (
            self.is_lasting_message
            and self.message
            and not is_lasting
            and self.read_time_s() - self._said_at < MESSAGE_TIME_S
        ):
            self._waiting = (text, is_success)
            return
        self._waiting = ("", False)
        self.message, self.is_success_message, self.is_lasting_message, self._said_at = (
            text,
            is_success,
            is_lasting,
            self.read_time_s(),
        )

    def ask_question(self, question: str, on_confirmed: Callable[[], None], key: str = YES_KEY) -> None:
        """Ask a question. Repeating the open question does not count as a reply."""
        if self.on_confirmed is not None and self.question_text == question:
            return
        self.withdraw_question()
        self.question_text, self.on_confirmed, self.key, self._since = (
            question,
            on_confirmed,
            key,
            self.read_time_s(),
        )
        self._in = self.read_snapshot().state

    def was_question_read(self, time_s: float) -> bool:
        """Return whether the operator had enough time before ``time_s`` to read the open question.

        The result is False if no question is open.
        """
        return self.on_confirmed is not None and time_s - self._since >= READING_TIME_S

    def confirm_question(self, time_s: float) -> None:
        """Remove the question, and execute its action if the question was shown long enough.

        ``time_s`` is the time of the key press.
        """
        asked, read = self.on_confirmed, self.was_question_read(time_s)
        self.withdraw_question()
        if asked is not None and read:
            asked()

    def withdraw_question(self) -> None:
        """Remove the question. Also remove the message, unless it is a lasting message."""
        self.question_text, self.on_confirmed = "", None
        if not self.is_lasting_message:
            self.message = ""

    def clear_message(self) -> None:
        """Remove the message for the previous key, but keep an open question."""
        self._waiting = ("", False)
        if not self.is_lasting_message:
            self.message = ""

    def remove_expired_texts(self, snapshot: Snapshot) -> None:
        """Remove an expired message, and a question that was asked in a different machine state."""
        if self.message and self.read_time_s() - self._said_at >= MESSAGE_TIME_S:
            text, is_success = self._waiting
            self.is_lasting_message = False
            self.say(text, is_success=is_success)
        if self.on_confirmed is not None and snapshot.state is not self._in:
            self.question_text, self.on_confirmed = "", None

    def hear(self, event: LogEvent) -> None:
        """Queue an event of the executor. The executor's thread may call this method."""
        self._heard.append(event)

    def record_start_attempt(self) -> None:
        """Record an attempt to start, so that a repeated refusal with the same reason is shown again."""
        self._refused = ""

    def update(self, snapshot: Snapshot) -> None:
        """Show refusals and other events of the executor. The screen calls this method once per frame."""
        while self._heard:
            event = self._heard.popleft()
            if event.kind == "refused" and event.text != snapshot.start_refusal_reason:
                self.say(Message("REJECTED: {why}", why=event.text))
            elif event.kind in {"disturbed", "shared"}:
                self.say(event.text)
            elif event.kind == "uncounted":
                self.say(Message("NOT COUNTED AS A PART: {event}", event=event.text))
        if snapshot.start_refusal_reason != self._refused:
            self._refused = snapshot.start_refusal_reason
            if self._refused:
                self.say(Message("CANNOT START: {refused}", refused=self._refused))
        self._report_unsaved()

    def _report_unsaved(self) -> None:
        """Show a new storage error once, so that the operator learns about it immediately."""
        storage_problem = self.read_storage_problem()
        if storage_problem != self._not_kept:
            self._not_kept = storage_problem
            if storage_problem:
                self.say(Message("NOT SAVED: {error}", error=storage_problem))
