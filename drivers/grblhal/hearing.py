"""What the controller says, line by line: sorted, believed or not, and what follows from it."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable

from core.ports import Clock, Fault, FaultCode
from drivers.grblhal import codes
from drivers.grblhal.config import GrblConfig
from drivers.grblhal.known import Known
from drivers.grblhal.report import Report, read_report
from drivers.grblhal.scripting import Runner
from drivers.grblhal.stream import Stream

_GARBAGE, _WITHIN = 3, 10.0  # unknown lines within s, while nothing is under way
_SETTING = re.compile(r"\$\d+=.*")
_ANSWER = re.compile(r"error:(\d+)")
_ALARM = re.compile(r"ALARM:(\d+)")
_IDLERS = frozenset(("Check", "Sleep", "Tool"))  # states in which it runs no program of ours


class Hearing(Known):
    """The receiving half of the conversation. ``write`` puts bytes on the wire."""

    def __init__(self, config: GrblConfig, clock: Clock, write: Callable[[bytes], None]) -> None:
        super().__init__(config, clock)
        self.write = write
        self.stream = Stream(write)
        self.banners = 0  # how many resets have been told
        self.fault: Fault | str = ""
        self.lost = False  # for good: start the control again
        self.alarm = 0
        self.trusted = True  # the position
        self.ready = False  # modes verified, nothing wrong
        self.index_wait = False  # a thread pass is under way: no report may come for seconds
        self.on_report: Callable[[Report], None] = lambda _: None
        self.on_void: Callable[[], None] = lambda: None
        self.runner = Runner()
        self.expected = False  # a reset of our own
        self.doubtful = False  # something damaged has been heard: look at all of it
        self.asked_at: float | None = None  # the oldest question for a report that is open
        self.answered_at = 0.0
        self._garbage: deque[float] = deque()

    @property
    def busy(self) -> bool:
        """Whether a script is under way."""
        return self.runner.busy

    @property
    def state(self) -> str:
        """As the last report says it; nothing before the first."""
        return self.report.state if self.report is not None else ""

    @property
    def hindrance(self) -> str:
        """Why nothing may be begun now; empty when it may."""
        if self.fault:
            return self.fault
        if self.alarm == codes.HOMING_REQUIRED and not self.busy:
            return "the controller has to be homed first"
        if self.busy or not self.ready:
            return "the controller's modes are being verified"
        return ""

    def realtime(self, *codes_: int) -> None:
        """Bytes that bypass every buffer."""
        self.write(bytes(codes_))

    def fail(self, why: str, code: FaultCode) -> None:
        """Something is wrong: no more lines, what moves comes to rest, and the operator has to clear it.

        A jog knows no feed hold, and everything else no jog cancel.
        """
        if not self.fault:
            self.fault = Fault(why, code)
        self.ready = False
        self.stream.waiting.clear()
        if not self.lost and self.report is not None and self.report.moves and self.alarm == 0:
            self.realtime(codes.JOG_CANCEL if self.report.state == "Jog" else codes.HOLD)

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
            self.stream.told(line)
        elif line.lower().startswith("grbl"):
            self._restarted()
        elif line and not line.startswith((">", "$")):
            self.damaged(line)

    def alarmed(self, number: int) -> None:
        """The controller has locked itself."""
        self.alarm = number
        self.trusted = self.trusted and number not in codes.LOST
        self.void()
        if number != codes.HOMING_REQUIRED:
            self.fail(codes.alarm_text(number), codes.alarm_code(number))
        self.ready = False

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
            self.fail(f"the line to the controller is disturbed: {line!r} is no answer", "controller-silent")
            self.doubtful = True

    # --- inside -------------------------------------------------------------------------------------------

    def _told(self, line: str) -> None:
        if self.stream.stale and line.startswith("[GC:"):
            self.stream.stale = False
        if not line.startswith("[MSG:"):
            self.stream.told(line)

    def _answer(self, error: int) -> None:
        self.answered_at = self.clock.now()
        if self.stream.stale:
            return
        first = self.fault == ""
        ask = self.stream.answered(error)
        if ask is None:
            self.damaged("ok" if not error else f"error:{error}")
        elif error and first and not self.busy:
            # Sticky: what is behind it is answered with the same error and not executed.
            self.fail(codes.error_text(error, ask.line), "controller-refuses")

    def _restarted(self) -> None:
        self.banners += 1
        self.void()
        self.diameter = self.overrides = None
        if not self.expected and self.identity is not None:
            self.fail("the controller has been reset; what it was given is void", "controller-reset")

    def _reported(self, report: Report | None, line: str) -> None:
        fit = report is not None and (self.busy or not self.ready or self.plausible(report))
        if report is None or not fit:
            self.damaged(line)
            return
        self.keep(report)
        if report.diameter and self.ready:
            self.fail("X counts in diameter (D:1): the controller has lost its modes", "controller-modes")
        self.asked_at = None
        self._mind(report)
        self.on_report(report)

    def _mind(self, report: Report) -> None:
        """States that say that something has happened, however that was missed."""
        if report.state != "Alarm":
            self.alarm = 0
        if self.busy:
            return
        if report.state == "Alarm":
            number = report.sub or self.alarm or codes.LOCKED
            if number != codes.HOMING_REQUIRED and not self.fault:
                self.alarmed(number)
            self.alarm, self.ready = number, False
        elif report.state == "Door":
            self.fail(f"{codes.DOOR}, spindle and coolant are off: close it, then Reset", "door")
        elif report.state in _IDLERS:
            self.fail(
                f"the controller is in state {report.state}, in which it runs no program of ours",
                "controller-modes",
            )
