"""The conversation with one controller: lines out, questions for reports, and a watch for silence.

``pump`` is called by whoever looks at the machine, at least once a tick of the executor; nothing waits.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable

from core.faults import code_of
from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_config import GrblConfig
from drivers.grblhal.grblhal_report import Report, read_report
from drivers.grblhal.grblhal_reported import ReportedState
from drivers.grblhal.grblhal_wire import Ask, Runner, Script, Stream, Wire, WireLostError
from drivers.waiting import Opening

_LINE = 1024  # bytes; the controller sends no longer line
_RUNNING, _RESTING, _ASKING = 0.1, 0.2, 0.05  # s between two questions for a report
_SILENT = 1.0  # s with a report owed in which nothing is heard
_ASKED_AGAIN = 0.5  # s, where a question may have been lost
_INDEX = 8.0  # s in which a thread may wait for its index: no report, no answer
_UNANSWERED = 2.0  # s for the answer to a line while the controller does nothing
_GARBAGE, _WITHIN = 3, 10.0  # unknown lines within s, while nothing is under way
_SETTING = re.compile(r"\$\d+=.*")
_ANSWER = re.compile(r"error:(\d+)")
_ALARM = re.compile(r"ALARM:(\d+)")
_IDLERS = frozenset(("Check", "Sleep", "Tool"))  # states in which it runs no program of ours
_HURRIED = 0.02  # s, while a tool is touched off
_COALESCED = 0.5  # s; two questions so far apart are never answered by one report
_LISTENING = 0.1  # s; of a longer pause of this computer no more counts as the controller's silence


class Controller(ReportedState):
    """One wire, what is asked of its other end, and what that has told."""

    def __init__(self, config: GrblConfig, wire: Wire, clock: Clock) -> None:
        super().__init__(config, clock)
        self.stream = Stream(self._write)
        self.banners = 0  # how many resets have been told
        self.fault: Fault | str = ""
        self.lost = False  # the wire is gone, and nothing is said any more
        self.mute = True  # nothing is heard: what has been told is of before, not of now
        self.alarm = 0
        self.trusted = True  # the position
        self.ready = False  # modes verified, nothing wrong
        self.index_wait = False  # a thread pass is under way: no report may come for seconds
        self.on_report: Callable[[Report], None] = lambda _: None
        self.on_void: Callable[[], None] = lambda: None
        self.settled: Callable[[], bool] = lambda: True  # all that was handed over is known to be done
        self.runner = Runner()
        self.expected = False  # a reset of our own
        self.doubtful = False  # something damaged has been heard: look at all of it
        self.owed_since: float | None = None  # since when a report is owed, on the clock of ``listened``
        self._looked_at = clock.now()
        self.listened = 0.0  # s in which somebody has listened: silence is told by these
        self.answered_at = 0.0
        self._garbage: deque[float] = deque()
        self._wire = wire
        self._inbox = b""
        self._next_question = self._questioned_at = 0.0  # the latter by ``listened``
        self.hurry_until = 0.0  # somebody wants to know as often as it may be asked
        self._leapt: tuple[Report, str] | None = None  # a report that nothing has confirmed, and its line
        self._sees_overrides = self._halted = self._asks_modes = False
        self._opening: Opening[Wire] | None = None  # of a wire that was lost
        self._then: Callable[[], Script] | None = None  # once it is open
        self.modes = ""  # as it has told them to a real-time question
        self.restarted = False  # while nothing was heard of it: what it only counts is not where it stands
        self.found_on: tuple[float, str] | None = (
            None  # s unheard, and what was still on and was switched off
        )

    def send(self, line: str, ticket: int = 0) -> Ask:
        """A line for the controller; its answer comes with later pumps."""
        return self.stream.send(line, self.listened, ticket)

    def run(self, script: Script, doing: str = "") -> None:
        """Begin a script; one that is under way is given up."""
        self.ready, self.expected = False, False
        self.runner.begin(script, doing, self.listened)
        self._advance()

    @property
    def doing(self) -> str:
        """What the present script is for."""
        return self.runner.doing

    def expect_reset(self) -> None:
        """The next banner is that of a reset of our own."""
        self.expected = True

    def see_overrides(self, on: bool) -> None:
        """Ask plainly: a full report leaves the overrides out when it carries the offsets, as it does."""
        self._sees_overrides = on

    def question(self, *, full: bool = False) -> None:
        """Ask for a status report; a full one takes no turn of a plain one that is wanted."""
        self.realtime(grblhal_codes.FULL if full else grblhal_codes.STATUS)
        now = self.clock.now()
        while self.asked and now - self.asked[0] > _COALESCED and self.asked[0] < self.heard_at:
            self.asked.popleft()
        self.asked.append(now)
        self._questioned_at = self.listened
        self.owed_since = self.listened if self.owed_since is None else self.owed_since
        if not (full and self._sees_overrides):
            self._next_question = now + self._interval()

    def question_modes(self) -> None:
        """Ask for the parser's state by a byte that passes every buffer; ``modes`` has it once it is told."""
        self.modes, self._asks_modes = "", True
        self.realtime(grblhal_codes.TELL_MODES)

    def reconnect(self, opening: Opening[Wire], script: Callable[[], Script]) -> None:
        """Begin to open the wire anew, and then the script; why that fails becomes the fault."""
        self.fault, self.ready = "", False
        self._opening, self._then = opening, script

    def close(self) -> None:
        """Let the wire go."""
        self._wire.close()

    def pump(self) -> None:
        """Read, go on, watch. Never waits, never raises."""
        if self._opening is not None:
            self._reopen(self._opening)
        if self.lost:
            return
        try:
            self._listen()
            self._read()
            self._advance()
            self.stream.pump(self.listened)
            self._ask()
            self._watch()
        except WireLostError as error:
            self._gone(error)

    def halt(self) -> None:
        """From any thread, when nobody pumps any more: hold or end the jog; asked again, reset at rest.

        Bytes that bypass every buffer, straight to the wire: a reset ends spindle and coolant.
        """
        self._wire.write(
            bytes([grblhal_codes.RESET] if self._halted else [grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD])
        )
        self._halted = True

    # --- what it is in -------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a script is under way."""
        return self.runner.busy

    @property
    def hindrance(self) -> str:
        """Why nothing may be begun now; empty when it may."""
        if self.fault:
            return self.fault
        if self.alarm == grblhal_codes.HOMING_REQUIRED and not self.busy:
            return "the controller must be homed first"
        if self._opening is not None:
            return "the connection to the controller is being restored"
        if self.busy or not self.ready:
            return "the controller's modal state is being verified"
        return ""

    def realtime(self, *codes_: int) -> None:
        """Bytes that bypass every buffer."""
        self._write(bytes(codes_))

    def fail(self, why: str, code: FaultCode, **values: object) -> None:
        """Something is wrong: no more lines, what moves comes to rest, and the operator has to clear it.

        A jog knows no feed hold, and everything else no jog cancel.
        """
        if not self.fault:
            self.fault = Fault(why, code, **values)
        self.ready = False
        self.stream.waiting.clear()
        if not self.lost and self.report is not None and self.report.moves and self.alarm == 0:
            self.realtime(grblhal_codes.JOG_CANCEL if self.report.state == "Jog" else grblhal_codes.HOLD)

    def void(self) -> None:
        """Nothing that was handed over counts any more."""
        self.stream.void()
        self.index_wait = False
        self.on_void()

    def hear(self, line: str) -> None:
        """One whole line. What begins with ``[`` and is not known is somebody else's."""
        if line.startswith("<"):
            self._reported(read_report(line), line)
        elif line == "ok" or _ANSWER.fullmatch(line):
            self._answer(0 if line == "ok" else int(line[6:]))
        elif alarm := _ALARM.fullmatch(line):
            self.alarmed(int(alarm[1]))
        elif line.startswith("[") and line.endswith("]"):
            self._told(line)
        elif _SETTING.fullmatch(line):
            self.stream.message(line)
        elif line.lower().startswith("grbl"):
            self._restarted()
        elif line and not line.startswith((">", "$")):
            self.damaged(line)

    def alarmed(self, number: int) -> None:
        """The controller has locked itself."""
        self.alarm = number
        lost = number in grblhal_codes.LOST or (number in grblhal_codes.TORN and self._may_move())
        self.trusted = self.trusted and not lost
        self.void()
        if number != grblhal_codes.HOMING_REQUIRED:
            self.fail(grblhal_codes.alarm_text(number), grblhal_codes.alarm_code(number))
        self.ready = False

    def _may_move(self) -> bool:
        """Whether a slide may have been moving when the alarm came."""
        last = self._before_alarm
        return last is not None and (last.moves or (last.state == "Idle" and not self.settled()))

    def damaged(self, line: str) -> None:
        """A line that means nothing may have been an answer: counters are never set right by guessing."""
        now = self.clock.now()
        self._garbage.append(now)
        while self._garbage[0] < now - _WITHIN:
            self._garbage.popleft()
        moving = self.report is not None and self.report.moves
        if self.stream.stale or (self.busy and self.identity is None):
            return
        if moving or not self.stream.quiet or len(self._garbage) >= _GARBAGE:
            self.fail(
                "interference on the line to the controller: {line} is not a valid response",
                "controller-silent",
                line=f"{line!r}",
            )
            self.doubtful = True

    # --- lines that have come ------------------------------------------------------------------------

    def _told(self, line: str) -> None:
        if self._asks_modes and line.startswith("[GC:"):
            self.modes, self._asks_modes = line, False
            return
        if self.stream.stale and line.startswith("[GC:"):
            self.stream.stale = False
        if not line.startswith("[MSG:"):
            self.stream.message(line)

    def _answer(self, error: int) -> None:
        self.answered_at = self.listened
        self.owed_since = None if self.owed_since is None else self.listened
        if self.stream.stale:
            return
        first = self.fault == ""
        ask = self.stream.answered(error)
        if ask is None:
            self.damaged("ok" if not error else f"error:{error}")
        elif error == grblhal_codes.ERROR_LOCKED and ask.line.startswith("M66"):
            return  # a question about an input: the next report says what has locked it
        elif error and first and not self.busy:
            # Sticky: what is behind it is answered with the same error and not executed.
            self.fail(grblhal_codes.error_text(error, ask.line), "controller-refuses")

    def _restarted(self) -> None:
        self.banners += 1
        self.void()
        self.diameter = self.overrides = None
        if not self.expected and self.identity is not None:
            self.fail("the controller was reset and has lost its pending commands", "controller-reset")

    def _reported(self, report: Report | None, line: str) -> None:
        if report is None:
            self.damaged(line)
            return
        if not (self.busy or not self.ready or self.plausible(report)):
            if self._leapt is None:
                self._leapt = report, line
                self.question()  # the next one tells whether it stands there
                return
            if not self._confirms(report, self._leapt[0]):
                self.damaged(line)
                return
        elif self._leapt is not None and not self._confirms(report, self._leapt[0]):
            self.damaged(self._leapt[1])  # this one goes on from where it was before: that one was garbled
        self._leapt = None
        self.keep(report)
        if report.diameter and self.ready:
            self.fail(
                "X is in diameter mode (D:1), so the controller has lost its modal state",
                "controller-modes",
            )
        self.owed_since, self.mute = None, False
        self._mind(report)
        self.on_report(report)

    def _mind(self, report: Report) -> None:
        """States that say that something has happened, however that was missed."""
        if report.state != "Alarm":
            self.alarm = 0
        if self.busy:
            return
        if report.state == "Alarm":
            number = report.sub or self.alarm or grblhal_codes.LOCKED
            if number != grblhal_codes.HOMING_REQUIRED and not self.fault:
                self.alarmed(number)
            self.alarm, self.ready = number, False
        elif report.state == "Door":
            self.fail(
                "{door}; spindle and coolant are off. Close the door, then press Reset",
                "door",
                door=grblhal_codes.DOOR,
            )
        elif report.state in _IDLERS:
            self.fail(
                "the controller is in state {state} and cannot run a program from TurnDesk",
                "controller-modes",
                state=report.state,
            )

    # --- the wire, and what is watched ---------------------------------------------------------------

    def _write(self, data: bytes) -> None:
        if self.lost or not data:
            return
        try:
            self._wire.write(data)
        except WireLostError as error:
            self._gone(error)

    def _reopen(self, opening: Opening[Wire]) -> None:
        """What was said or asked on the old wire counts no more, and what was heard is of before."""
        try:
            wire = opening.take()
        except DriverError as error:
            self._opening = None
            self.fail("the connection to the controller is lost: {error}", "controller-lost", error=error)
            return
        if wire is None:
            return
        self._opening, self._wire, self.lost, self._halted = None, wire, False, False
        self._inbox, self.alarm, self.identity = b"", 0, None
        self.asked.clear()
        self.owed_since = None
        self._garbage.clear()
        self.void()
        assert self._then is not None
        self.run(self._then(), "reconnect")

    def _gone(self, error: WireLostError) -> None:
        self.lost = self.mute = True
        self.runner.drop()
        self.fail(
            "the connection to the controller is lost: {error}; the controller finishes its "
            "buffered moves, then stops",
            "controller-lost",
            error=error,
        )
        self.void()

    def _listen(self) -> None:
        now = self.clock.now()
        self.listened += min(now - self._looked_at, _LISTENING)
        self._looked_at = now

    def _read(self) -> None:
        *lines, self._inbox = (self._inbox + self._wire.read()).split(b"\n")
        if len(self._inbox) > _LINE:
            self._inbox = b""
            self.damaged("an unterminated line")
        for line in lines:
            self.hear(line.decode("ascii", "replace").strip("\r"))

    def _advance(self) -> None:
        """Let the script go on; why it fails is the fault."""
        why = self.runner.go_on(self.listened)
        self.expected = self.expected and self.busy
        if why:
            if self.identity is None:
                self.fault = ""  # why it is not taken at all comes before its alarms
            self.fail(why, code_of(why, "controller-silent"))

    def _interval(self) -> float:
        if self.busy:
            return _ASKING
        if self.clock.now() < self.hurry_until:
            return _HURRIED
        resting = self.report is not None and self.report.state == "Idle" and self.stream.quiet
        return _RESTING if resting and not self._sees_overrides else _RUNNING

    def _ask(self) -> None:
        if self.doubtful:
            self.doubtful = False
            self.question(full=True)
        elif self.clock.now() >= self._next_question and self._may_ask():
            resting = self.report is None or self.report.state in {"Idle", "Alarm"}
            self.question(full=resting and self.stream.quiet and not self._sees_overrides)

    def _may_ask(self) -> bool:
        """One question at a time: on a slow line each stands before the lines behind it."""
        return self.owed_since is None or self.listened - self._questioned_at >= _ASKED_AGAIN

    def _watch(self) -> None:
        """Silence is a fault, but not behind a thread, whose wait for the index answers nothing.

        A controller that answers lines works: a question may lie behind these on the wire.
        """
        if self.busy:
            return
        patience = _INDEX if self.index_wait else _SILENT
        if self.owed_since is not None and self.listened - self.owed_since > patience:
            self.owed_since, self.mute = self.listened, True
            self.fail(
                "no response from the controller; check the cable and the controller", "controller-silent"
            )
        idle = self.report is not None and self.report.state == "Idle"
        if not (self.stream.unanswered and idle) or self.fault:
            return
        first = self.stream.unanswered[0]
        patience = _INDEX if self.index_wait else _UNANSWERED + self.wait_of(first.line)
        if self.listened - max(first.sent_at, self.answered_at) > patience:
            self.fail(
                "no response to {line}; there may be interference on the line",
                "controller-silent",
                line=f"{first.line!r}",
            )
