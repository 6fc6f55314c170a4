"""The conversation with one controller: reads, sorts, asks for reports, and notices what is wrong.

``pump`` is called by whoever looks at the machine, at least once a tick of the executor; nothing waits.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable

from core.ports import Clock
from drivers.grblhal import codes
from drivers.grblhal.config import GrblConfig
from drivers.grblhal.known import Known
from drivers.grblhal.report import Report, read_report
from drivers.grblhal.scripting import Runner, Script
from drivers.grblhal.stream import Ask, Stream
from drivers.grblhal.wire import Wire, WireLostError

_LINE = 1024  # bytes; the controller sends no longer line
_RUNNING, _RESTING, _ASKING = 0.1, 0.2, 0.05  # s between two questions for a report
_SILENT = 1.0  # s without a report
_INDEX = 8.0  # s in which a thread may wait for its index without answering
_UNANSWERED = 2.0  # s for the answer to a line while the controller does nothing
_GARBAGE, _WITHIN = 3, 10.0  # unknown lines within s, while nothing is under way
_SETTING = re.compile(r"\$\d+=.*")
_ANSWER = re.compile(r"error:(\d+)")
_ALARM = re.compile(r"ALARM:(\d+)")


class Controller(Known):
    """One wire and what is known of its other end."""

    def __init__(self, config: GrblConfig, wire: Wire, clock: Clock) -> None:
        super().__init__(config, clock)
        self.stream = Stream(self._write)
        self.banners = 0  # how many resets have been told
        self.fault = ""
        self.lost = False  # for good: start the control again
        self.alarm = 0
        self.trusted = True  # the position
        self.ready = False  # modes verified, nothing wrong
        self.index_wait = False  # a thread pass is under way: no report may come for seconds
        self.on_report: Callable[[Report], None] = lambda _: None
        self.on_void: Callable[[], None] = lambda: None
        self._wire = wire
        self._inbox = b""
        self._runner = Runner()
        self._expected = False  # a reset of our own
        self._asked_at: float | None = None
        self._next_question = 0.0
        self._garbage: deque[float] = deque()
        self._answered_at = 0.0
        self._sees_full = False

    # --- what is asked ------------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a script is under way."""
        return self._runner.busy

    def realtime(self, *codes_: int) -> None:
        """Bytes that bypass every buffer."""
        self._write(bytes(codes_))

    def send(self, line: str, ticket: int = 0) -> Ask:
        """A line for the controller; its answer comes with later pumps."""
        return self.stream.send(line, self.clock.now(), ticket)

    def run(self, script: Script, doing: str = "") -> None:
        """Begin a script; one that is under way is given up."""
        self.ready, self._expected = False, False
        self._runner.begin(script, doing, self.clock.now())
        self._advance()

    @property
    def doing(self) -> str:
        """What the present script is for."""
        return self._runner.doing

    def expect_reset(self) -> None:
        """The next banner is that of a reset of our own."""
        self._expected = True

    def question(self, *, full: bool = False) -> None:
        """Ask for a status report."""
        self.realtime(codes.FULL if full else codes.STATUS)
        now = self.clock.now()
        self._asked_at = now if self._asked_at is None else self._asked_at
        self._next_question = now + self._interval()

    def fail(self, why: str) -> None:
        """Something is wrong: no more lines, what moves comes to rest, and the operator has to clear it."""
        if not self.fault:
            self.fault = why
        self.ready = False
        self.stream.waiting.clear()
        if not self.lost and self.report is not None and self.report.moves and self.alarm == 0:
            self.realtime(codes.HOLD)

    def void(self) -> None:
        """Nothing that was handed over counts any more."""
        self.stream.void()
        self.index_wait = False
        self.on_void()

    def pump(self) -> None:
        """Read, go on, watch. Never waits, never raises."""
        if self.lost:
            return
        try:
            self._read()
            self._advance()
            self.stream.pump(self.clock.now())
            self._watch()
        except WireLostError as error:
            self._gone(error)

    def close(self) -> None:
        """Let the wire go."""
        self._wire.close()

    # --- inside -------------------------------------------------------------------------------------------

    def _write(self, data: bytes) -> None:
        if self.lost or not data:
            return
        try:
            self._wire.write(data)
        except WireLostError as error:
            self._gone(error)

    def _gone(self, error: WireLostError) -> None:
        self.lost = True
        self._runner.drop()
        self.fail(f"the connection to the controller is lost: {error}; it moves what it has, then rests")
        self.void()

    def _read(self) -> None:
        *lines, self._inbox = (self._inbox + self._wire.read()).split(b"\n")
        if len(self._inbox) > _LINE:
            self._inbox = b""
            self._damaged("a line without an end")
        for line in lines:
            self._hear(line.decode("ascii", "replace").strip("\r"))

    def _hear(self, line: str) -> None:
        if line.startswith("<"):
            self._reported(read_report(line), line)
        elif line == "ok" or _ANSWER.fullmatch(line):
            self._answer(0 if line == "ok" else int(line[6:]))
        elif alarm := _ALARM.fullmatch(line):
            self._alarmed(int(alarm[1]))
        elif line.startswith("[") and line.endswith("]"):
            self._told(line)
        elif _SETTING.fullmatch(line):
            self.stream.told(line)
        elif line.lower().startswith("grbl"):
            self._restarted()
        elif line and not line.startswith((">", "$")):
            self._damaged(line)

    def _told(self, line: str) -> None:
        if self.stream.stale and line.startswith("[GC:"):
            self.stream.stale = False
        if not line.startswith("[MSG:"):
            self.stream.told(line)

    def _answer(self, error: int) -> None:
        self._answered_at = self.clock.now()
        if self.stream.stale:
            return
        first = self.fault == ""
        ask = self.stream.answered(error)
        if ask is None:
            self._damaged("ok" if not error else f"error:{error}")
        elif error and first and not self.busy:
            # Sticky: what is behind it is answered with the same error and not executed.
            self.fail(codes.error_text(error, ask.line))

    def _alarmed(self, number: int) -> None:
        self.alarm = number
        self.trusted = self.trusted and number not in codes.LOST
        self.void()
        if number != codes.HOMING_REQUIRED:
            self.fail(codes.alarm_text(number))
        self.ready = False

    def _restarted(self) -> None:
        self.banners += 1
        self.void()
        self.diameter = None
        if not self._expected and self.identity is not None:
            self.fail("the controller has been reset; what it was given is void")

    def _damaged(self, line: str) -> None:
        """A line that means nothing may have been an answer: counters are never set right by guessing."""
        now = self.clock.now()
        self._garbage.append(now)
        while self._garbage[0] < now - _WITHIN:
            self._garbage.popleft()
        moving = self.report is not None and self.report.moves
        if self.stream.stale or (self.busy and self.identity is None):
            return
        if moving or not self.stream.quiet or len(self._garbage) >= _GARBAGE:
            self.fail(f"the line to the controller is disturbed: {line!r} is no answer")
            self.question(full=True)

    def _reported(self, report: Report | None, line: str) -> None:
        fit = report is not None and (self.busy or not self.ready or self.plausible(report))
        if report is None or not fit:
            self._damaged(line)
            return
        self.keep(report)
        if report.diameter and self.ready:
            self.fail("X counts in diameter (D:1): the controller has lost its modes")
        self._asked_at = None
        self._mind(report)
        self.on_report(report)

    def _mind(self, report: Report) -> None:
        """States that say that something has happened, however that was missed."""
        if report.state == "Alarm" and not self.busy:
            number = report.sub or self.alarm
            if number != codes.HOMING_REQUIRED and not self.fault:
                self._alarmed(number)
            self.ready = False
        elif report.state in {"Check", "Sleep", "Tool"} and not self.busy:
            self.fail(f"the controller is in state {report.state}, in which it runs no program of ours")
        elif report.state != "Alarm":
            self.alarm = 0

    def _advance(self) -> None:
        """Let the script go on; why it fails is the fault."""
        why = self._runner.go_on(self.clock.now())
        self._expected = self._expected and self.busy
        if why:
            self.fail(why)

    def _interval(self) -> float:
        if self.busy:
            return _ASKING
        return (
            _RUNNING
            if self.report is None or self.report.state != "Idle" or not self.stream.quiet
            else _RESTING
        )

    def _watch(self) -> None:
        now = self.clock.now()
        if now >= self._next_question:
            resting = self.report is None or self.report.state in {"Idle", "Alarm"}
            self.question(full=(resting and self.stream.quiet) or self._sees_full)
        patience = _INDEX if self.index_wait else _SILENT
        if self._asked_at is not None and now - self._asked_at > patience and not self.busy:
            self._asked_at = now
            self.fail("the controller does not answer; look at the cable and at the controller")
        idle = self.report is not None and self.report.state == "Idle"
        if self.stream.unanswered and idle and not self.busy and not self.fault:
            since = max(self.stream.unanswered[0].sent_at, self._answered_at)
            if now - since > _UNANSWERED:
                self.fail(f"no answer to {self.stream.unanswered[0].line!r}; the line may be disturbed")

    def see_overrides(self, on: bool) -> None:
        """Ask for full reports while running too: only these always carry the overrides."""
        self._sees_full = on
