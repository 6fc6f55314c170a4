"""The prompt line: what the operator can do now, and the response to the last key.

State, question and message have separate places. A message remains for 4 s or until the next key. The prompt
depends on one snapshot and the loaded program.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum

from app.desk.programs.program_loading import Loaded, Phase
from app.desk.status import interrupted_notice
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import data, tr
from core.alarms import CATALOGUE, Code
from core.executor.job import WARNING
from core.executor.snapshot import Alarm, Event, Snapshot, State
from core.language.diagnostics import Severity
from core.message import Message
from core.tool_edges import edge_name

# Stops with a message of the program.
OF_PROGRAM: frozenset[Code] = frozenset({"program-stop", "optional-stop"})
NOT_FOUND = "FILE NOT FOUND, PRESS ANY KEY TO CONTINUE"
ASK_FILE = "FILE TO BE PROCESSED"
CHOOSE_FILE = "TYPE A NAME OR SELECT A PROGRAM   ENTER: LOAD   ESC: CLOSE"
NONE_NAMED = "TO EDIT, FIRST TYPE A NAME OR SELECT ONE WITH THE ARROWS"
ONE_PALM = "ONLY ONE PALM BUTTON PRESSED: PRESS BOTH WITHIN 0.5 S"
ONE_HAND = "PRESS BOTH PALM BUTTONS WITHIN 0.5 S. ONE-HAND MODE: F10, 7"
STOP_HELD = "RELEASE THE STOP KEY FIRST"
BOTH_UP = "RELEASE BOTH PALM BUTTONS, THEN PRESS BOTH WITHIN 0.5 S"
CONTROL_SILENT = "CONTROL NOT RESPONDING. PRESS E-STOP. SCREEN IS NOT LIVE"
RESTART_CONTROL = "CONTROL NOT RESPONDING. PRESS E-STOP, THEN R TO RESTART IT"
NOT_HERE = "START CYCLES ON THE AUTOMATIC PAGE: PRESS F1, THEN F2"
RESTORING = "CANNOT START: A BACKUP IS BEING RESTORED"
STALE = "CANNOT START: THE PROGRAM IS BEING RELOADED"
NO_START = "WILL NOT START"  # Beginning of a prompt for a program that will not start.
GIVE_UP = "PRESS Y TO CANCEL THE PROGRAM, N TO KEEP IT"
TWIST_OUT = "PRESS Y TO RELEASE THE E-STOP, N TO LEAVE IT PRESSED"
NO_MUSHROOM = "PRESS E-STOP ON THE MACHINE. THIS KEY ONLY STARTED FEED HOLD"
HOW_TO_HOLD = "FEED HOLD: PAUSE, H OR ESC   E-STOP: SCROLL LOCK (STOP)"
KEYBOARD_AWAY = "STOP KEYS DO NOT WORK. TAP THIS WINDOW OR USE THE BUTTONS"
MOVING = frozenset({State.RUN, State.HOLDING, State.WAIT, State.JOG, State.HOME})
INTERRUPTED = frozenset({State.HOLD, State.BLOCK_END, State.PROGRAM_STOP})
UNDER_WAY = MOVING | INTERRUPTED


def prompt(snapshot: Snapshot, loaded: Loaded, start: str, release: str, *, field_open: bool = False) -> str:
    """Return the prompt for the present state.

    ``start`` and ``release`` are the instructions for starting a cycle and for releasing the E-stop.
    ``field_open`` is True if letters are text input.
    """
    go_on = Message("TO CONTINUE: {start}. R: CANCEL THE PROGRAM", start=start)
    standing = {
        State.ESTOP: _estop(release),
        State.DISABLED: "DRIVES ARE OFF: PRESS D FOR DRIVES ON",
        State.FAULT: alarm_of(snapshot, release, field_open=field_open),
        State.RUN: HOW_TO_HOLD,
        State.JOG: HOW_TO_HOLD,
        State.WAIT: HOW_TO_HOLD,
        State.HOLDING: "STOPPING",
        State.HOLD: go_on,
        State.BLOCK_END: go_on,
        State.PROGRAM_STOP: go_on,
        State.HOME: "HOMING THE AXES",
    }
    return standing.get(snapshot.state) or _idle(snapshot, loaded, start)


def announced(snapshot: Snapshot, *, starts_here: bool = True) -> tuple[str, ...]:
    """Return the texts about the next start, which precede all other prompts.

    Warnings of the proof are included only where a cycle can be started.
    """
    return tuple(text for text in snapshot.announced if starts_here or not text.startswith(WARNING))


def alarm_of(snapshot: Snapshot, release: str, *, field_open: bool = False) -> str:
    """Return the prompt for an alarm or an E-stop, which replaces a page's prompt. Empty without either."""
    if snapshot.state is State.FAULT:
        if not snapshot.alarms:
            return "ALARM: CORRECT THE CAUSE, THEN PRESS R TO ACKNOWLEDGE"
        if field_open:
            return Message(
                "WHAT TO DO: {remedy}  ·  F1: LEAVE THE PAGE, THEN R: ACKNOWLEDGE",
                remedy=snapshot.alarms[0].remedy,
            )
        return Message(
            "WHAT TO DO: {remedy}  ·  R: ACKNOWLEDGE   F7: ALARM LIST", remedy=snapshot.alarms[0].remedy
        )
    return _estop(release) if snapshot.state is State.ESTOP else ""


def _estop(release: str) -> str:
    return Message("E-STOP: MAKE THE MACHINE SAFE. {release}. THEN D: DRIVES ON", release=release)


def reason(view: MachineStatus) -> str:
    """Return the text below the prompt: the cause of a stop, and for a feed hold also the remedy."""
    if view.alarms:
        return Message("CAUSE: {stop}", stop=exactly(view.alarms[0]))
    if view.stop is None:
        return ""
    cause = Message("CAUSE: {stop}", stop=exactly(view.stop))
    return (
        cause
        if view.stop.code == "estop"
        else Message("{cause}  ·  WHAT TO DO: {remedy}", cause=cause, remedy=view.stop.remedy)
    )


def exactly(alarm: Alarm) -> str:
    """Return the cause of an alarm, followed by the most likely cause in the catalog if it differs."""
    likely = alarm.causes[0] if alarm.causes else ""
    cause = cause_of(alarm)
    return (
        cause if likely in {"", alarm.cause} else Message("{cause}; {likely}", cause=cause, likely=tr(likely))
    )


def cause_of(alarm: Alarm) -> str:
    """Return the translated cause of an alarm. A program's own message at M00 or M01 is not translated."""
    of_program = alarm.code in OF_PROGRAM and alarm.cause not in CATALOGUE[alarm.code].causes
    return data(alarm.cause) if of_program else tr(alarm.cause)


def _idle(snapshot: Snapshot, loaded: Loaded, start: str) -> str:
    if loaded.busy:
        return _progress(loaded)
    asked = interrupted_notice.interrupted_prompt(snapshot, loaded, start)
    return lacking(snapshot, loaded) or asked or Message("TO START: {start}", start=start)


def lacking(snapshot: Snapshot, loaded: Loaded) -> str:
    """Return why the loaded program cannot start now. Empty if nothing is missing."""
    if loaded.phase in {Phase.UNREADABLE, Phase.REFUSED}:
        return refusal(loaded)
    if not snapshot.program:
        return "PRESS F2 TO CHOOSE A PROGRAM"
    if snapshot.proof_wanted:
        return "THE PROGRAM IS NOT PROVED YET AND WILL NOT START"
    missing = missing_tools(loaded)
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


def missing_tools(loaded: Loaded) -> list[str]:
    """Return the tools that the loaded program uses and that have no measured offset."""
    if loaded.proof is None or loaded.job is None:
        return []
    return [edge_name(key) for key in loaded.proof.unset(loaded.job)]


def refusal(loaded: Loaded) -> str:
    """Return why the loaded program will not run: the first error and the number of further errors."""
    if loaded.phase is Phase.UNREADABLE:
        return Message(
            "{loaded} CANNOT BE LOADED: {problem}. F2: CHOOSE ANOTHER PROGRAM",
            loaded=loaded.name,
            problem=loaded.trouble,
        )
    errors = loaded.errors
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


def remedy(loaded: Loaded, prompt: str) -> str:
    """Return the remedy for a program that will not run, if ``prompt`` shows its error.

    For a program that can start, return the first warning of a check.
    """
    errors = loaded.errors
    if errors:
        return errors[0].hint if prompt == refusal(loaded) else ""
    restart = tr("RESUME AT THIS LINE: {start}. ESC: CANCEL").partition("{start}")[0]
    if "TO START: " not in prompt and restart not in prompt:
        return ""
    warned = (each for each in loaded.diagnostics if each.check and each.severity is Severity.WARNING)
    first = next(warned, None)
    return (
        Message("LINE {line}: {first}  ·  {hint}", line=first.line, first=first.text, hint=first.hint)
        if first is not None
        else ""
    )


def _progress(loaded: Loaded) -> str:
    count = Message(" {reached} BLOCKS", reached=loaded.reached) if loaded.reached else ""
    return Message("{phase} {loaded}{count}", phase=loaded.phase.value, loaded=loaded.name, count=count)


# --- answers and questions ----------------------------------------------------------------------------


HEARD = 100  # Events that wait for the next frame. Older events are in the log.


class Sort(StrEnum):
    """The kind of message. Each kind has its own color and sign."""

    ANSWER = "answer"  # A refusal, or an instruction for what to do first.
    DONE = "done"
    ASKED = "asked"


YES = "Y"
READ = 0.5  # Seconds for reading a question. An earlier key press is not an answer.


SHOWN = 4.0  # Seconds for which a message remains without a key press.


@dataclass(slots=True)
class PromptAnswers:
    """One message and one question of the prompt line.

    A message remains for ``SHOWN`` seconds or until the next key. A change of the machine's state does not
    remove it. A question is valid in the machine state in which it was asked. Y executes the action, and N
    and Esc only remove the question. An action that loses data has its own key, which differs from the key
    that asked. ``clock`` returns monotonic time in seconds.
    """

    snapshot: Callable[[], Snapshot]
    # Returns why events, parts and versions are not being saved; empty if they are.
    not_kept: Callable[[], str]
    clock: Callable[[], float]
    answer: str = ""
    question: str = ""
    asked: Callable[[], None] | None = None  # Action of the answer yes.
    key: str = YES  # Key that means yes.
    done: bool = False  # The message reports a success.
    lasting: bool = False  # No key removes the message before its time is over.
    _said_at: float = 0.0
    _since: float = 0.0
    _in: State | None = None
    _refused: str = ""
    _not_kept: str = ""
    _heard: deque[Event] = field(default_factory=lambda: deque(maxlen=HEARD))

    @property
    def notice(self) -> str:
        """The message, or else the question."""
        return self.answer or self.question

    @property
    def sort(self) -> Sort:
        """The kind of the notice."""
        if not self.answer and self.asked is not None:
            return Sort.ASKED
        return Sort.DONE if self.done else Sort.ANSWER

    def say(self, text: str, *, done: bool = False, lasting: bool = False) -> None:
        """Show a message. ``done`` marks a success. No key removes a ``lasting`` message.

        Until the time of a lasting message is over, only another lasting message replaces it.
        """
        if self.lasting and self.answer and not lasting and self.clock() - self._said_at < SHOWN:
            return
        self.answer, self.done, self.lasting, self._said_at = text, done, lasting, self.clock()

    def ask(self, question: str, yes: Callable[[], None], key: str = YES) -> None:
        """Ask a question. Asking the same question again does not count as an answer."""
        if self.asked is not None and self.question == question:
            return
        self.take_back()
        self.question, self.asked, self.key, self._since = question, yes, key, self.clock()
        self._in = self.snapshot().state

    def read(self, at: float) -> bool:
        """Return whether a question is open and was shown long enough before ``at`` to have been read."""
        return self.asked is not None and at - self._since >= READ

    def yes(self, at: float) -> None:
        """Execute the action of the question if the question was shown long enough. Remove the question.

        ``at`` is the time of the key press.
        """
        asked, read = self.asked, self.read(at)
        self.take_back()
        if asked is not None and read:
            asked()

    def take_back(self) -> None:
        """Remove the question, and also the message unless it is lasting."""
        self.question, self.asked = "", None
        if not self.lasting:
            self.answer = ""

    def next_key(self) -> None:
        """Remove the message for the previous key. A question remains."""
        if not self.lasting:
            self.answer = ""

    def expire(self, snapshot: Snapshot) -> None:
        """Remove a message whose time is over, and a question if the machine's state has changed."""
        if self.answer and self.clock() - self._said_at >= SHOWN:
            self.answer, self.lasting = "", False
        if self.asked is not None and snapshot.state is not self._in:
            self.question, self.asked = "", None

    def hear(self, event: Event) -> None:
        """Queue an event of the executor. This method may be called from the executor's thread."""
        self._heard.append(event)

    def starting(self) -> None:
        """Note that a start is attempted, so that the same refusal is shown again."""
        self._refused = ""

    def look(self, snapshot: Snapshot) -> None:
        """Show refusals and other events of the executor; called once a frame."""
        while self._heard:
            event = self._heard.popleft()
            if event.kind == "refused" and event.text != snapshot.start_refused:
                self.say(Message("REJECTED: {why}", why=event.text))
            elif event.kind in {"disturbed", "shared"}:
                self.say(event.text)
            elif event.kind == "uncounted":
                self.say(Message("NOT COUNTED AS A PART: {event}", event=event.text))
        if snapshot.start_refused != self._refused:
            self._refused = snapshot.start_refused
            if self._refused:
                self.say(Message("CANNOT START: {refused}", refused=self._refused))
        self._tell_not_kept()

    def _tell_not_kept(self) -> None:
        """Show a new storage error once, so that the operator does not find it a day later."""
        trouble = self.not_kept()
        if trouble != self._not_kept:
            self._not_kept = trouble
            if trouble:
                self.say(Message("NOT SAVED: {error}", error=trouble))
