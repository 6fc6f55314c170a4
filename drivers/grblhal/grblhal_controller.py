"""Communication with one grblHAL controller: lines, report requests and timeouts.

``GrblController.run_cycle`` never waits, and must be called at least once per tick of the executor.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable

from core.faults import get_fault_code
from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_config import GrblConfig
from drivers.grblhal.grblhal_report import StatusReport, parse_report
from drivers.grblhal.grblhal_state import ReportedState
from drivers.grblhal.grblhal_transport import (
    GrblTransport,
    LineSender,
    Script,
    ScriptRunner,
    SentLine,
    TransportLostError,
)
from drivers.wakeups import ConnectionAttempt

_LINE = 1024  # Bytes; the controller sends no longer line.
_RUNNING, _RESTING, _ASKING = 0.1, 0.2, 0.05  # Seconds between two report requests.
_SILENCE_TIMEOUT_S = 1.0  # Seconds without a requested report.
_REPEAT_REQUEST_S = 0.5  # Seconds after which a lost request is repeated.
_INDEX_TIMEOUT_S = 8.0  # Seconds that a thread may wait for its index, without reports or replies.
_REPLY_TIMEOUT_S = 2.0  # Seconds for the reply to a line while the controller is idle.
_GARBAGE, _WITHIN = 3, 10.0  # Invalid lines within this number of seconds while nothing moves.
_SETTING = re.compile(r"\$\d+=.*")
_ERROR_PATTERN = re.compile(r"error:(\d+)")
_ALARM = re.compile(r"ALARM:(\d+)")
_BLOCKING_STATES = frozenset(
    ("Check", "Sleep", "Tool")
)  # States in which the controller cannot run a program.
_FAST_INTERVAL_S = 0.02  # Seconds, while a tool is touched off.
_MERGED_REQUEST_S = 0.5  # Seconds; requests that are further apart never share one report.
_MAX_LISTEN_SLICE_S = (
    0.1  # Seconds; a longer pause of this computer does not count as silence of the controller.
)


class GrblController(ReportedState):
    """Connection to one grblHAL controller, including its pending lines and its reported state."""

    def __init__(self, config: GrblConfig, transport: GrblTransport, clock: Clock) -> None:
        super().__init__(config, clock)
        self.line_sender = LineSender(self._write)
        self.reset_count = 0  # Number of reported resets.
        self.fault: Fault | str = ""
        self.is_lost = False  # The connection is lost.
        self.is_silent = True  # The controller is silent, so the reported state is old.
        self.alarm_number = 0
        self.is_position_reliable = True  # The position is reliable.
        self.is_ready = False  # The modes are verified, without a fault.
        self.waits_for_index = False  # A thread pass is running, so reports may be missing for seconds.
        self.on_status_report: Callable[[StatusReport], None] = lambda _: None
        self.on_discard: Callable[[], None] = lambda: None
        self.are_blocks_settled: Callable[[], bool] = lambda: (
            True
        )  # All submitted blocks are known to be complete.
        self.script_runner = ScriptRunner()
        self.is_reset_expected = False  # A reset by the driver is expected.
        self.needs_full_report = False  # An invalid line was received, so a full report is needed.
        # Time since which a report is due, on the clock of ``listened_s``.
        self.report_due_since_s: float | None = None
        self._looked_at = clock.now()
        self.listened_s = 0.0  # Seconds during which the driver was reading; the base of all timeouts.
        self.last_reply_s = 0.0
        self._garbage: deque[float] = deque()
        self._wire = transport
        self._inbox = b""
        self._next_question = self._questioned_at = 0.0  # The second time is on the clock of ``listened_s``.
        self.fast_polling_until = 0.0  # End of the time with the shortest request interval.
        # An implausible report that is not yet confirmed, and its line.
        self._leapt: tuple[StatusReport, str] | None = None
        self._sees_overrides = self._halted = self._asks_modes = False
        self._opening: ConnectionAttempt[GrblTransport] | None = None  # Opening of a lost connection.
        self._then: Callable[[], Script] | None = None  # Script to run after opening.
        self.reported_modes = ""  # Modes as reported after a real-time request.
        # The controller restarted during the silence, so counted positions are invalid.
        self.has_restarted = False
        self.active_at_silence: tuple[float, str] | None = (
            None  # Seconds of silence, and the accessories that were on and have been switched off.
        )

    def send_line(self, line: str, ticket: int = 0) -> SentLine:
        """Queue a line for the controller, and return the entry of the line in the queue.

        Later calls of ``run_cycle`` send the line and complete its entry.
        """
        return self.line_sender.send_line(line, self.listened_s, ticket)

    def start_script(self, script: Script, purpose: str = "") -> None:
        """Start a script, and cancel the script that is running."""
        self.is_ready, self.is_reset_expected = False, False
        self.script_runner.start_script(script, purpose, self.listened_s)
        self._advance()

    @property
    def script_purpose(self) -> str:
        """Return the purpose of the script that is running."""
        return self.script_runner.purpose

    def expect_driver_reset(self) -> None:
        """Expect a reset by the driver, so that the next startup message is not treated as a restart."""
        self.is_reset_expected = True

    def set_override_reports_enabled(self, enabled: bool) -> None:
        """Select whether reports without offsets are requested as well, to receive the overrides.

        The controller omits the overrides from a full report, which always contains the offsets.
        """
        self._sees_overrides = enabled

    def request_report(self, *, full: bool = False) -> None:
        """Request a status report.

        While overrides are needed, a full report does not postpone the next plain report.
        """
        self.send_realtime_bytes(grblhal_codes.FULL if full else grblhal_codes.STATUS)
        now = self.clock.now()
        while (
            self.request_times
            and now - self.request_times[0] > _MERGED_REQUEST_S
            and self.request_times[0] < self.last_report_s
        ):
            self.request_times.popleft()
        self.request_times.append(now)
        self._questioned_at = self.listened_s
        self.report_due_since_s = (
            self.listened_s if self.report_due_since_s is None else self.report_due_since_s
        )
        if not (full and self._sees_overrides):
            self._next_question = now + self._interval()

    def request_parser_modes(self) -> None:
        """Request the parser state with a real-time byte; the reply is stored in ``reported_modes``."""
        self.reported_modes, self._asks_modes = "", True
        self.send_realtime_bytes(grblhal_codes.TELL_MODES)

    def reconnect(
        self, connection_attempt: ConnectionAttempt[GrblTransport], script: Callable[[], Script]
    ) -> None:
        """Start to reopen the connection, and run a script when it is open.

        If the connection cannot be opened, the reason becomes the fault.
        """
        self.fault, self.is_ready = "", False
        self._opening, self._then = connection_attempt, script

    def close(self) -> None:
        """Close the connection to the controller."""
        self._wire.close()

    def run_cycle(self) -> None:
        """Read replies, continue the script, send lines and check timeouts.

        This method never waits and never raises an exception.
        """
        if self._opening is not None:
            self._reopen(self._opening)
        if self.is_lost:
            return
        try:
            self._listen()
            self._read()
            self._advance()
            self.line_sender.send_waiting_lines(self.listened_s)
            self._ask()
            self._check_timeouts()
        except TransportLostError as error:
            self._gone(error)

    def halt_motion(self) -> None:
        """Stop the motion if ``run_cycle`` is no longer called; any thread may call this method.

        The first call sends a jog cancel and a feed hold. A second call, when the axes are at rest, resets
        the controller, which also stops the spindle and coolant. The bytes bypass all buffers.
        """
        self._wire.write(
            bytes([grblhal_codes.RESET] if self._halted else [grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD])
        )
        self._halted = True

    # --- state ---------------------------------------------------------------------------------------

    @property
    def is_script_running(self) -> bool:
        """Return whether a script is running."""
        return self.script_runner.is_script_running

    @property
    def motion_refusal_reason(self) -> str:
        """Return the reason why no motion can start now, or an empty string if motion can start."""
        if self.fault:
            return self.fault
        if self.alarm_number == grblhal_codes.HOMING_REQUIRED_ALARM and not self.is_script_running:
            return "the controller must be homed first"
        if self._opening is not None:
            return "the connection to the controller is being restored"
        if self.is_script_running or not self.is_ready:
            return "the controller's modal state is being verified"
        return ""

    def send_realtime_bytes(self, *codes_: int) -> None:
        """Send real-time bytes, which bypass all buffers."""
        self._write(bytes(codes_))

    def set_fault(self, reason: str, code: FaultCode, **values: object) -> None:
        """Set a fault, discard waiting lines and stop the motion; the operator must clear the fault.

        A jog cancel stops a jog, and a feed hold stops any other motion.
        """
        if not self.fault:
            self.fault = Fault(reason, code, **values)
        self.is_ready = False
        self.line_sender.waiting_lines.clear()
        if not self.is_lost and self.report is not None and self.report.moves and self.alarm_number == 0:
            self.send_realtime_bytes(
                grblhal_codes.JOG_CANCEL if self.report.state == "Jog" else grblhal_codes.HOLD
            )

    def discard_pending_lines(self) -> None:
        """Discard all pending lines and tickets."""
        self.line_sender.discard_lines()
        self.waits_for_index = False
        self.on_discard()

    def handle_line(self, line: str) -> None:
        """Handle one complete line from the controller.

        An unknown line that begins with ``[`` is treated as a message.
        """
        if line.startswith("<"):
            self._reported(parse_report(line), line)
        elif line == "ok" or _ERROR_PATTERN.fullmatch(line):
            self._answer(0 if line == "ok" else int(line[6:]))
        elif alarm := _ALARM.fullmatch(line):
            self.handle_alarm(int(alarm[1]))
        elif line.startswith("[") and line.endswith("]"):
            self._told(line)
        elif _SETTING.fullmatch(line):
            self.line_sender.add_received_line(line)
        elif line.lower().startswith("grbl"):
            self._restarted()
        elif line and not line.startswith((">", "$")):
            self.handle_invalid_line(line)

    def handle_alarm(self, number: int) -> None:
        """Handle an alarm, which locks the controller."""
        self.alarm_number = number
        lost = number in grblhal_codes.POSITION_LOST_ALARMS or (
            number in grblhal_codes.ABRUPT_STOP_ALARMS and self._may_move()
        )
        self.is_position_reliable = self.is_position_reliable and not lost
        self.discard_pending_lines()
        if number != grblhal_codes.HOMING_REQUIRED_ALARM:
            self.set_fault(grblhal_codes.describe_alarm(number), grblhal_codes.get_alarm_code(number))
        self.is_ready = False

    def _may_move(self) -> bool:
        """Return whether an axis may have been moving when the alarm occurred."""
        last = self._before_alarm
        return last is not None and (last.moves or (last.state == "Idle" and not self.are_blocks_settled()))

    def handle_invalid_line(self, line: str) -> None:
        """Handle an invalid line, which may be a damaged reply.

        The driver does not guess to which line a damaged reply belongs. If a reply may be missing, it sets
        a fault.
        """
        now = self.clock.now()
        self._garbage.append(now)
        while self._garbage[0] < now - _WITHIN:
            self._garbage.popleft()
        moving = self.report is not None and self.report.moves
        if self.line_sender.has_stale_replies or (self.is_script_running and self.identity is None):
            return
        if moving or not self.line_sender.is_idle or len(self._garbage) >= _GARBAGE:
            self.set_fault(
                "interference on the line to the controller: {line} is not a valid response",
                "controller-silent",
                line=f"{line!r}",
            )
            self.needs_full_report = True

    # --- received lines ------------------------------------------------------------------------------

    def _told(self, line: str) -> None:
        if self._asks_modes and line.startswith("[GC:"):
            self.reported_modes, self._asks_modes = line, False
            return
        if self.line_sender.has_stale_replies and line.startswith("[GC:"):
            self.line_sender.has_stale_replies = False
        if not line.startswith("[MSG:"):
            self.line_sender.add_received_line(line)

    def _answer(self, error: int) -> None:
        self.last_reply_s = self.listened_s
        self.report_due_since_s = None if self.report_due_since_s is None else self.listened_s
        if self.line_sender.has_stale_replies:
            return
        first = self.fault == ""
        ask = self.line_sender.assign_reply(error)
        if ask is None:
            self.handle_invalid_line("ok" if not error else f"error:{error}")
        elif error == grblhal_codes.LOCKED_ERROR and ask.line_text.startswith("M66"):
            return  # A request for an input; the next report shows the reason for the lock.
        elif error and first and not self.is_script_running:
            # The error is sticky: later lines get the same error and are not executed.
            self.set_fault(grblhal_codes.describe_line_error(error, ask.line_text), "controller-refuses")

    def _restarted(self) -> None:
        self.reset_count += 1
        self.discard_pending_lines()
        self.is_diameter_mode = self.overrides = None
        if not self.is_reset_expected and self.identity is not None:
            self.set_fault("the controller was reset and has lost its pending commands", "controller-reset")

    def _reported(self, report: StatusReport | None, line: str) -> None:
        if report is None:
            self.handle_invalid_line(line)
            return
        if not (self.is_script_running or not self.is_ready or self.is_report_plausible(report)):
            if self._leapt is None:
                self._leapt = report, line
                self.request_report()  # The next report shows whether the position is correct.
                return
            if not self._confirms_jump(report, self._leapt[0]):
                self.handle_invalid_line(line)
                return
        elif self._leapt is not None and not self._confirms_jump(report, self._leapt[0]):
            # This report continues from the earlier position, so the last one was corrupted.
            self.handle_invalid_line(self._leapt[1])
        self._leapt = None
        self.store_report(report)
        if report.diameter and self.is_ready:
            self.set_fault(
                "X is in diameter mode (D:1), so the controller has lost its modal state",
                "controller-modes",
            )
        self.report_due_since_s, self.is_silent = None, False
        self._check_report(report)
        self.on_status_report(report)

    def _check_report(self, report: StatusReport) -> None:
        """Handle changes of state that a report shows, in case the corresponding messages were missed."""
        if report.state != "Alarm":
            self.alarm_number = 0
        if self.is_script_running:
            return
        if report.state == "Alarm":
            number = report.sub or self.alarm_number or grblhal_codes.LOCKED_ALARM
            if number != grblhal_codes.HOMING_REQUIRED_ALARM and not self.fault:
                self.handle_alarm(number)
            self.alarm_number, self.is_ready = number, False
        elif report.state == "Door":
            self.set_fault(
                "{door}; spindle and coolant are off. Close the door, then press Reset",
                "door",
                door=grblhal_codes.DOOR_OPEN_TEXT,
            )
        elif report.state in _BLOCKING_STATES:
            self.set_fault(
                "the controller is in state {state} and cannot run a program from TurnDesk",
                "controller-modes",
                state=report.state,
            )

    # --- connection and timeouts ---------------------------------------------------------------------

    def _write(self, data: bytes) -> None:
        if self.is_lost or not data:
            return
        try:
            self._wire.write(data)
        except TransportLostError as error:
            self._gone(error)

    def _reopen(self, opening: ConnectionAttempt[GrblTransport]) -> None:
        """Finish reopening the connection, and discard all data of the previous connection."""
        try:
            wire = opening.take_connection()
        except DriverError as error:
            self._opening = None
            self.set_fault(
                "the connection to the controller is lost: {error}", "controller-lost", error=error
            )
            return
        if wire is None:
            return
        self._opening, self._wire, self.is_lost, self._halted = None, wire, False, False
        self._inbox, self.alarm_number, self.identity = b"", 0, None
        self.request_times.clear()
        self.report_due_since_s = None
        self._garbage.clear()
        self.discard_pending_lines()
        assert self._then is not None
        self.start_script(self._then(), "reconnect")

    def _gone(self, error: TransportLostError) -> None:
        self.is_lost = self.is_silent = True
        self.script_runner.cancel_script()
        self.set_fault(
            "the connection to the controller is lost: {error}; the controller finishes its "
            "buffered moves, then stops",
            "controller-lost",
            error=error,
        )
        self.discard_pending_lines()

    def _listen(self) -> None:
        now = self.clock.now()
        self.listened_s += min(now - self._looked_at, _MAX_LISTEN_SLICE_S)
        self._looked_at = now

    def _read(self) -> None:
        *lines, self._inbox = (self._inbox + self._wire.read()).split(b"\n")
        if len(self._inbox) > _LINE:
            self._inbox = b""
            self.handle_invalid_line("an unterminated line")
        for line in lines:
            self.handle_line(line.decode("ascii", "replace").strip("\r"))

    def _advance(self) -> None:
        """Continue the script; if the script fails, the reason becomes the fault."""
        why = self.script_runner.advance_script(self.listened_s)
        self.is_reset_expected = self.is_reset_expected and self.is_script_running
        if why:
            if self.identity is None:
                self.fault = ""  # The reason for rejecting the controller has priority over its alarms.
            self.set_fault(why, get_fault_code(why, "controller-silent"))

    def _interval(self) -> float:
        if self.is_script_running:
            return _ASKING
        if self.clock.now() < self.fast_polling_until:
            return _FAST_INTERVAL_S
        resting = self.report is not None and self.report.state == "Idle" and self.line_sender.is_idle
        return _RESTING if resting and not self._sees_overrides else _RUNNING

    def _ask(self) -> None:
        if self.needs_full_report:
            self.needs_full_report = False
            self.request_report(full=True)
        elif self.clock.now() >= self._next_question and self._can_request():
            resting = self.report is None or self.report.state in {"Idle", "Alarm"}
            self.request_report(full=resting and self.line_sender.is_idle and not self._sees_overrides)

    def _can_request(self) -> bool:
        """Return whether a report can be requested now.

        Only one request is pending at a time, because each request delays the lines that follow.
        """
        return self.report_due_since_s is None or self.listened_s - self._questioned_at >= _REPEAT_REQUEST_S

    def _check_timeouts(self) -> None:
        """Set a fault if the controller does not respond in time.

        The timeout is longer while a threading pass waits for the spindle index. A reply to a line also
        counts as a response, because the controller may execute lines before it answers a report request.
        """
        if self.is_script_running:
            return
        patience = _INDEX_TIMEOUT_S if self.waits_for_index else _SILENCE_TIMEOUT_S
        if self.report_due_since_s is not None and self.listened_s - self.report_due_since_s > patience:
            self.report_due_since_s, self.is_silent = self.listened_s, True
            self.set_fault(
                "no response from the controller; check the cable and the controller", "controller-silent"
            )
        idle = self.report is not None and self.report.state == "Idle"
        if not (self.line_sender.unacknowledged_lines and idle) or self.fault:
            return
        first = self.line_sender.unacknowledged_lines[0]
        patience = (
            _INDEX_TIMEOUT_S
            if self.waits_for_index
            else _REPLY_TIMEOUT_S + self.get_line_wait_s(first.line_text)
        )
        if self.listened_s - max(first.sent_time_s, self.last_reply_s) > patience:
            self.set_fault(
                "no response to {line}; there may be interference on the line",
                "controller-silent",
                line=f"{first.line_text!r}",
            )
