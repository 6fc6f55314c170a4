"""The prompt line: what the operator can do now, and what the desk answers to the last key.

State, question and answer have three separate places. An answer remains for 4 s or until the next key; the
prompt follows from one snapshot and the loaded program.
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

OF_PROGRAM: frozenset[Code] = frozenset({"program-stop", "optional-stop"})  # stops with a message
NOT_FOUND = "FILE NOT FOUND, PRESS ANY KEY TO CONTINUE"
ASK_FILE = "FILE TO BE PROCESSED"
CHOOSE_FILE = "TYPE A NAME OR SELECT A PROGRAM   ENTER: LOAD   ESC: CLOSE"
NONE_NAMED = "TO EDIT, FIRST TYPE A NAME OR SELECT ONE WITH THE ARROWS"
ONE_PALM = "ONLY ONE PALM BUTTON PRESSED: PRESS BOTH WITHIN 0.5 S"
ONE_HAND = "PRESS BOTH PALM BUTTONS WITHIN 0.5 S. ONE-HAND MODE: F10, 7"
STOP_HELD = "RELEASE THE STOP KEY FIRST"
BOTH_UP = "RELEASE BOTH PALM BUTTONS, THEN PRESS BOTH WITHIN 0.5 S"
CONTROL_SILENT = "CONTROL NOT RESPONDING. PRESS E-STOP. SCREEN IS NOT LIVE"
NOT_HERE = "START CYCLES ON THE AUTOMATIC PAGE: PRESS F1, THEN F2"
RESTORING = "CANNOT START: A BACKUP IS BEING RESTORED"
STALE = "CANNOT START: THE PROGRAM IS BEING RELOADED"
NO_START = "WILL NOT START"  # how the standing prompt begins then
GIVE_UP = "PRESS Y TO CANCEL THE PROGRAM, N TO KEEP IT"
TWIST_OUT = "PRESS Y TO RELEASE THE E-STOP, N TO LEAVE IT PRESSED"
NO_MUSHROOM = "PRESS E-STOP ON THE MACHINE. THIS KEY ONLY STARTED FEED HOLD"
HOW_TO_HOLD = "FEED HOLD: PAUSE, H OR ESC   E-STOP: SCROLL LOCK (STOP)"
KEYBOARD_AWAY = "STOP KEYS DO NOT WORK. TAP THIS WINDOW OR USE THE BUTTONS"
MOVING = frozenset({State.RUN, State.HOLDING, State.WAIT, State.JOG, State.HOME})
INTERRUPTED = frozenset({State.HOLD, State.BLOCK_END, State.PROGRAM_STOP})
UNDER_WAY = MOVING | INTERRUPTED


def prompt(snapshot: Snapshot, loaded: Loaded, start: str, release: str, *, field_open: bool = False) -> str:
    """The standing prompt; ``start`` and ``release`` name what starts a cycle and frees the E-stop here.

    ``field_open``: letters are text.
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
    """What goes before everything else: what will start with the next start; empty when nothing will.

    What the proof has warned of is told where a cycle can be started.
    """
    return tuple(text for text in snapshot.announced if starts_here or not text.startswith(WARNING))


def alarm_of(snapshot: Snapshot, release: str, *, field_open: bool = False) -> str:
    """What goes before anything a page has to say: an alarm, an E-stop; empty when there is none."""
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
    """Below the prompt, on every page: why the machine stands; of a hold also what to do."""
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
    """What is known of this one, and the likeliest cause."""
    likely = alarm.causes[0] if alarm.causes else ""
    cause = cause_of(alarm)
    return (
        cause if likely in {"", alarm.cause} else Message("{cause}; {likely}", cause=cause, likely=tr(likely))
    )


def cause_of(alarm: Alarm) -> str:
    """What is known of this one; of M00 and M01 that is the program's own message."""
    of_program = alarm.code in OF_PROGRAM and alarm.cause not in CATALOGUE[alarm.code].causes
    return data(alarm.cause) if of_program else tr(alarm.cause)


def _idle(snapshot: Snapshot, loaded: Loaded, start: str) -> str:
    if loaded.busy:
        return _progress(loaded)
    asked = interrupted_notice.interrupted_prompt(snapshot, loaded, start)
    return lacking(snapshot, loaded) or asked or Message("TO START: {start}", start=start)


def lacking(snapshot: Snapshot, loaded: Loaded) -> str:
    """Return why the program that was read does not start now; empty when nothing is missing."""
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
    """The tools that the program on the desk asks for and nobody has set."""
    if loaded.proof is None or loaded.job is None:
        return []
    return [edge_name(key) for key in loaded.proof.unset(loaded.job)]


def refusal(loaded: Loaded) -> str:
    """Why the program on the desk will not run: the first error, and how many there are."""
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
    """What to do about a program that will not run, where the prompt line says why; of one that may be
    started, what a check has warned of."""
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


HEARD = 100  # events that wait for the next frame; older ones are in the log


class Sort(StrEnum):
    """What an answer is: each has its colour and its sign."""

    ANSWER = "answer"  # a refusal, or what to do before it can be done
    DONE = "done"
    ASKED = "asked"


YES = "Y"
READ = 0.5  # s: sooner nobody has read a question, and what is pressed is meant for something else


SHOWN = 4.0  # s that an answer remains where no key is pressed


@dataclass(slots=True)
class PromptAnswers:
    """One answer and one question, each in its own place next to the state.

    An answer remains for ``SHOWN`` seconds or until the next key. No change of the machine's state
    removes it. A question belongs to the state in which it was asked: Y does what it asks,
    N and Esc never do anything. What is lost for good is done by a key of its own, and never by the key that
    asked. ``clock`` is monotonic.
    """

    snapshot: Callable[[], Snapshot]
    not_kept: Callable[[], str]  # why events, parts and versions are not being kept; empty while they are
    clock: Callable[[], float]
    answer: str = ""
    question: str = ""
    asked: Callable[[], None] | None = None  # what yes does now
    key: str = YES  # that means yes
    done: bool = False  # the answer reports a success
    lasting: bool = False  # no key removes the answer before its time is over
    _said_at: float = 0.0
    _since: float = 0.0
    _in: State | None = None
    _refused: str = ""
    _not_kept: str = ""
    _heard: deque[Event] = field(default_factory=lambda: deque(maxlen=HEARD))

    @property
    def notice(self) -> str:
        """The answer, or without one the question."""
        return self.answer or self.question

    @property
    def sort(self) -> Sort:
        """What the notice is."""
        if not self.answer and self.asked is not None:
            return Sort.ASKED
        return Sort.DONE if self.done else Sort.ANSWER

    def say(self, text: str, *, done: bool = False, lasting: bool = False) -> None:
        """Show an answer; ``done``: it reports a success. A ``lasting`` one outlives keys, too.

        A lasting answer is replaced by nothing but another lasting one until its time is over.
        """
        if self.lasting and self.answer and not lasting and self.clock() - self._said_at < SHOWN:
            return
        self.answer, self.done, self.lasting, self._said_at = text, done, lasting, self.clock()

    def ask(self, question: str, yes: Callable[[], None], key: str = YES) -> None:
        """Ask a question; asked again it is the same question, and no answer."""
        if self.asked is not None and self.question == question:
            return
        self.take_back()
        self.question, self.asked, self.key, self._since = question, yes, key, self.clock()
        self._in = self.snapshot().state

    def read(self, at: float) -> bool:
        """Whether a question stands, and has stood long enough at this time to have been read."""
        return self.asked is not None and at - self._since >= READ

    def yes(self, at: float) -> None:
        """Yes was pressed ``at`` this time: do what is asked, or take a question back that was not read."""
        asked, read = self.asked, self.read(at)
        self.take_back()
        if asked is not None and read:
            asked()

    def take_back(self) -> None:
        """Remove the question, and the answer unless it is a lasting one."""
        self.question, self.asked = "", None
        if not self.lasting:
            self.answer = ""

    def next_key(self) -> None:
        """Remove the answer to the key before; a question remains."""
        if not self.lasting:
            self.answer = ""

    def expire(self, snapshot: Snapshot) -> None:
        """Remove an answer whose time is over, and a question of another state of the machine."""
        if self.answer and self.clock() - self._said_at >= SHOWN:
            self.answer, self.lasting = "", False
        if self.asked is not None and snapshot.state is not self._in:
            self.question, self.asked = "", None

    def hear(self, event: Event) -> None:
        """What the executor has to say; it may be called from its thread."""
        self._heard.append(event)

    def starting(self) -> None:
        """A start is tried: the same refusal again is worth saying again."""
        self._refused = ""

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: nothing is refused in silence, a start or whatever else the executor would not do."""
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
        """A disk that fails in the middle of a run is told once, not found out the day after."""
        trouble = self.not_kept()
        if trouble != self._not_kept:
            self._not_kept = trouble
            if trouble:
                self.say(Message("NOT SAVED: {error}", error=trouble))
