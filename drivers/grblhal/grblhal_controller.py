"""Communication with one grblHAL controller: lines, report requests and timeouts.

``pump`` must be called at least once per tick of the executor and never waits.
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

_LINE = 1024  # Bytes; the controller sends no longer line.
_RUNNING, _RESTING, _ASKING = 0.1, 0.2, 0.05  # Seconds between two report requests.
_SILENT = 1.0  # Seconds without a requested report.
_ASKED_AGAIN = 0.5  # Seconds after which a lost request is repeated.
_INDEX = 8.0  # Seconds that a thread may wait for its index, without reports or replies.
_UNANSWERED = 2.0  # Seconds for the reply to a line while the controller is idle.
_GARBAGE, _WITHIN = 3, 10.0  # Invalid lines within this number of seconds while nothing moves.
_SETTING = re.compile(r"\$\d+=.*")
_ANSWER = re.compile(r"error:(\d+)")
_ALARM = re.compile(r"ALARM:(\d+)")
_IDLERS = frozenset(("Check", "Sleep", "Tool"))  # States in which the controller cannot run a program.
_HURRIED = 0.02  # Seconds, while a tool is touched off.
_COALESCED = 0.5  # Seconds; requests that are further apart never share one report.
_LISTENING = 0.1  # Seconds; a longer pause of this computer does not count as silence of the controller.


class Controller(ReportedState):
    """Connection to one controller, with the pending lines and the reported state."""

    def __init__(self, config: GrblConfig, wire: Wire, clock: Clock) -> None:
        super().__init__(config, clock)
        self.stream = Stream(self._write)
        self.banners = 0  # Number of reported resets.
        self.fault: Fault | str = ""
        self.lost = False  # The connection is lost.
        self.mute = True  # The controller is silent, so the reported state is old.
        self.alarm = 0
        self.trusted = True  # The position is reliable.
        self.ready = False  # The modes are verified, without a fault.
        self.index_wait = False  # A thread pass is running, so reports may be missing for seconds.
        self.on_report: Callable[[Report], None] = lambda _: None
        self.on_void: Callable[[], None] = lambda: None
        self.settled: Callable[[], bool] = lambda: True  # All submitted blocks are known to be complete.
        self.runner = Runner()
        self.expected = False  # A reset by the driver is expected.
        self.doubtful = False  # An invalid line was received, so a full report is needed.
        # Time since which a report is due, on the clock of ``listened``.
        self.owed_since: float | None = None
        self._looked_at = clock.now()
        self.listened = 0.0  # Seconds during which the driver was reading; the base of all timeouts.
        self.answered_at = 0.0
        self._garbage: deque[float] = deque()
        self._wire = wire
        self._inbox = b""
        self._next_question = self._questioned_at = 0.0  # The second time is on the clock of ``listened``.
        self.hurry_until = 0.0  # End of the time with the shortest request interval.
        # An implausible report that is not yet confirmed, and its line.
        self._leapt: tuple[Report, str] | None = None
        self._sees_overrides = self._halted = self._asks_modes = False
        self._opening: Opening[Wire] | None = None  # Opening of a lost connection.
        self._then: Callable[[], Script] | None = None  # Script to run after opening.
        self.modes = ""  # Modes as reported after a real-time request.
        # The controller restarted during the silence, so counted positions are invalid.
        self.restarted = False
        self.found_on: tuple[float, str] | None = (
            None  # Seconds of silence, and the accessories that were on and have been switched off.
        )

    def send(self, line: str, ticket: int = 0) -> Ask:
        """Queue a line for the controller and return its entry, which later calls of ``pump`` complete."""
        return self.stream.send(line, self.listened, ticket)

    def run(self, script: Script, doing: str = "") -> None:
        """Start a script; a script that is running is canceled."""
        self.ready, self.expected = False, False
        self.runner.begin(script, doing, self.listened)
        self._advance()

    @property
    def doing(self) -> str:
        """The purpose of the present script."""
        return self.runner.doing

    def expect_reset(self) -> None:
        """Declare that the next banner results from a reset by the driver."""
        self.expected = True

    def see_overrides(self, on: bool) -> None:
        """Select plain reports that contain the overrides.

        A full report omits the overrides when it contains the offsets, which is always the case.
        """
        self._sees_overrides = on

    def question(self, *, full: bool = False) -> None:
        """Request a status report; a full one does not delay a plain one that is needed for the overrides."""
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
        """Request the parser state with a real-time byte; ``modes`` receives the reply."""
        self.modes, self._asks_modes = "", True
        self.realtime(grblhal_codes.TELL_MODES)

    def reconnect(self, opening: Opening[Wire], script: Callable[[], Script]) -> None:
        """Start to open the connection again, then run a script; a failure becomes the fault."""
        self.fault, self.ready = "", False
        self._opening, self._then = opening, script

    def close(self) -> None:
        """Close the connection."""
        self._wire.close()

    def pump(self) -> None:
        """Read, continue the script, send and check timeouts, without waiting or raising an error."""
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
        """Stop the motion from any thread if ``pump`` has stopped being called.

        The first call sends a jog cancel and a feed hold. The next call, for axes that are then at rest,
        resets the controller, which also stops spindle and coolant. The bytes bypass all buffers.
        """
        self._wire.write(
            bytes([grblhal_codes.RESET] if self._halted else [grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD])
        )
        self._halted = True

    # --- state ---------------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a script is running."""
        return self.runner.busy

    @property
    def hindrance(self) -> str:
        """The reason why nothing can be started now, or an empty text."""
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
        """Send real-time bytes, which bypass all buffers."""
        self._write(bytes(codes_))

    def fail(self, why: str, code: FaultCode, **values: object) -> None:
        """Set the fault, discard waiting lines and stop the motion; the operator must clear the fault.

        A jog is canceled, and any other motion is stopped by a feed hold.
        """
        if not self.fault:
            self.fault = Fault(why, code, **values)
        self.ready = False
        self.stream.waiting.clear()
        if not self.lost and self.report is not None and self.report.moves and self.alarm == 0:
            self.realtime(grblhal_codes.JOG_CANCEL if self.report.state == "Jog" else grblhal_codes.HOLD)

    def void(self) -> None:
        """Discard all pending lines and tickets."""
        self.stream.void()
        self.index_wait = False
        self.on_void()

    def hear(self, line: str) -> None:
        """Handle one complete line; an unknown line that begins with ``[`` is passed on as a message."""
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
        """Handle an alarm, which locks the controller."""
        self.alarm = number
        lost = number in grblhal_codes.LOST or (number in grblhal_codes.TORN and self._may_move())
        self.trusted = self.trusted and not lost
        self.void()
        if number != grblhal_codes.HOMING_REQUIRED:
            self.fail(grblhal_codes.alarm_text(number), grblhal_codes.alarm_code(number))
        self.ready = False

    def _may_move(self) -> bool:
        """Return whether an axis may have been moving when the alarm occurred."""
        last = self._before_alarm
        return last is not None and (last.moves or (last.state == "Idle" and not self.settled()))

    def damaged(self, line: str) -> None:
        """Handle a line that is not valid, which may have been a reply.

        The driver never guesses which line was acknowledged. It sets a fault if a reply may be missing.
        """
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

    # --- received lines ------------------------------------------------------------------------------

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
            return  # A request for an input; the next report shows the reason for the lock.
        elif error and first and not self.busy:
            # The error is sticky: later lines get the same error and are not executed.
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
                self.question()  # The next report shows whether the position is correct.
                return
            if not self._confirms(report, self._leapt[0]):
                self.damaged(line)
                return
        elif self._leapt is not None and not self._confirms(report, self._leapt[0]):
            # This report continues from the earlier position, so the last one was corrupted.
            self.damaged(self._leapt[1])
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
        """Handle a state in a report that shows an event, even if its message was missed."""
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

    # --- connection and timeouts ---------------------------------------------------------------------

    def _write(self, data: bytes) -> None:
        if self.lost or not data:
            return
        try:
            self._wire.write(data)
        except WireLostError as error:
            self._gone(error)

    def _reopen(self, opening: Opening[Wire]) -> None:
        """Complete the opening of the connection and discard everything that belongs to the old one."""
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
        """Continue the script; the reason for a failure becomes the fault."""
        why = self.runner.go_on(self.listened)
        self.expected = self.expected and self.busy
        if why:
            if self.identity is None:
                self.fault = ""  # The reason for rejecting the controller has priority over its alarms.
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
        """Return whether a report can be requested now.

        Only one request is pending at a time, because each one delays the lines after it.
        """
        return self.owed_since is None or self.listened - self._questioned_at >= _ASKED_AGAIN

    def _watch(self) -> None:
        """Set a fault if the controller does not respond in time.

        The limit is longer while a thread waits for its index. A reply to a line counts as a response,
        because a report request may be delayed by lines.
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
