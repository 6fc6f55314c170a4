"""The conversation with one controller: lines out, questions for reports, and a watch for silence.

``pump`` is called by whoever looks at the machine, at least once a tick of the executor; nothing waits.
"""

from __future__ import annotations

from core.ports import Clock, code_of
from drivers.grblhal import codes
from drivers.grblhal.config import GrblConfig
from drivers.grblhal.hearing import Hearing
from drivers.grblhal.scripting import Script
from drivers.grblhal.stream import Ask
from drivers.grblhal.wire import Wire, WireLostError

_LINE = 1024  # bytes; the controller sends no longer line
_RUNNING, _RESTING, _ASKING = 0.1, 0.2, 0.05  # s between two questions for a report
_SILENT = 1.0  # s without a report
_INDEX = 8.0  # s in which a thread may wait for its index: no report, no answer
_UNANSWERED = 2.0  # s for the answer to a line while the controller does nothing


class Controller(Hearing):
    """One wire and what is known of its other end."""

    def __init__(self, config: GrblConfig, wire: Wire, clock: Clock) -> None:
        super().__init__(config, clock, self._write)
        self._wire = wire
        self._inbox = b""
        self._next_question = 0.0
        self._sees_overrides = False
        self._halted = False

    def send(self, line: str, ticket: int = 0) -> Ask:
        """A line for the controller; its answer comes with later pumps."""
        return self.stream.send(line, self.clock.now(), ticket)

    def run(self, script: Script, doing: str = "") -> None:
        """Begin a script; one that is under way is given up."""
        self.ready, self.expected = False, False
        self.runner.begin(script, doing, self.clock.now())
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
        self.realtime(codes.FULL if full else codes.STATUS)
        now = self.clock.now()
        self.asked_at = now if self.asked_at is None else self.asked_at
        if not (full and self._sees_overrides):
            self._next_question = now + self._interval()

    def pump(self) -> None:
        """Read, go on, watch. Never waits, never raises."""
        if self.lost:
            return
        try:
            self._read()
            self._advance()
            self.stream.pump(self.clock.now())
            self._ask()
            self._watch()
        except WireLostError as error:
            self._gone(error)

    def halt(self) -> None:
        """From any thread, when nobody pumps any more: hold or end the jog; asked again, reset at rest.

        Bytes that bypass every buffer, straight to the wire: a reset ends spindle and coolant.
        """
        self._wire.write(bytes([codes.RESET] if self._halted else [codes.JOG_CANCEL, codes.HOLD]))
        self._halted = True

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
        self.runner.drop()
        self.fail(
            f"the connection to the controller is lost: {error}; it moves what it has, then rests",
            "controller-lost",
        )
        self.void()

    def _read(self) -> None:
        *lines, self._inbox = (self._inbox + self._wire.read()).split(b"\n")
        if len(self._inbox) > _LINE:
            self._inbox = b""
            self.damaged("a line without an end")
        for line in lines:
            self.hear(line.decode("ascii", "replace").strip("\r"))

    def _advance(self) -> None:
        """Let the script go on; why it fails is the fault."""
        why = self.runner.go_on(self.clock.now())
        self.expected = self.expected and self.busy
        if why:
            self.fail(why, code_of(why, "controller-silent"))

    def _interval(self) -> float:
        if self.busy:
            return _ASKING
        resting = self.report is not None and self.report.state == "Idle" and self.stream.quiet
        return _RESTING if resting and not self._sees_overrides else _RUNNING

    def _ask(self) -> None:
        if self.doubtful:
            self.doubtful = False
            self.question(full=True)
        elif self.clock.now() >= self._next_question:
            resting = self.report is None or self.report.state in {"Idle", "Alarm"}
            self.question(full=resting and self.stream.quiet and not self._sees_overrides)

    def _watch(self) -> None:
        """Silence is a fault, but not behind a thread, whose wait for the index answers nothing."""
        if self.busy:
            return
        now = self.clock.now()
        if self.asked_at is not None and now - self.asked_at > (_INDEX if self.index_wait else _SILENT):
            self.asked_at = now
            self.fail(
                "the controller does not answer; look at the cable and at the controller", "controller-silent"
            )
        idle = self.report is not None and self.report.state == "Idle"
        if not (self.stream.unanswered and idle) or self.fault:
            return
        first = self.stream.unanswered[0]
        if now - max(first.sent_at, self.answered_at) > (_INDEX if self.index_wait else _UNANSWERED):
            self.fail(f"no answer to {first.line!r}; the line may be disturbed", "controller-silent")
