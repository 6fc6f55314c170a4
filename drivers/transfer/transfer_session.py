"""Transfer of one program, which runs in one thread; other threads may read its progress and cancel it."""

from __future__ import annotations

import threading
from dataclasses import dataclass

from core.ports import Clock, DriverError
from drivers.serial_line import FlowWire, table_of
from drivers.transfer.program_framing import (
    DC1,
    DC3,
    DC4,
    Incoming,
    IncompleteError,
    Phase,
    Program,
    TransferSettings,
)

CHUNK = 64  # Bytes that a USB adapter may still send after a stop by the other side.
TICK = 0.05  # s
HELD = 1.0  # Seconds without a transmitted byte after which the line counts as stopped by the other side.
PATIENCE = 120.0  # Seconds for which the other side may stop the line.
AGAIN = 5.0  # Seconds after which DC1 is repeated without input.
LAST = 0.5  # Seconds of silence after a final % without a line end.
# Reasons for waiting; the screen has the texts.
HELD_BACK, FOR_DC1, FOR_SENDER, FOR_FRAME, NO_TEXT = "held", "dc1", "sender", "frame", "noise"
QUIET = 10.0  # Seconds of silence within a program after which it counts as ended.


class CancelledError(DriverError):
    """Cancellation of the transfer by the operator; nothing is saved."""


@dataclass(frozen=True, slots=True)
class Reach:
    """Progress of a transfer: bytes, lines and the reason for waiting, which is one of the words above.

    ``total`` 0 means unknown. The last field is the received text before the first %, which is not a program.
    """

    done: int = 0
    total: int = 0
    lines: int = 0
    what: str = ""
    heard: str = ""


class _Transfer:
    """Base class of both transfer directions; any thread may read ``reach``, which is replaced as a whole."""

    def __init__(self, wire: FlowWire, clock: Clock, settings: TransferSettings) -> None:
        self._wire, self._clock, self._settings = wire, clock, settings
        self._cancelled = threading.Event()
        self.reach = Reach()

    def cancel(self) -> None:
        """Cancel the transfer, which takes effect within 0.1 s."""
        self._cancelled.set()

    def _go_on(self) -> None:
        if self._cancelled.is_set():
            raise CancelledError("cancelled")


class Sending(_Transfer):
    """Transfer that sends bytes in chunks of 64, as fast as the other side permits."""

    def __init__(self, wire: FlowWire, clock: Clock, settings: TransferSettings, data: bytes) -> None:
        super().__init__(wire, clock, settings)
        self._data = data
        self._needed = len(data.rstrip(b"\r\n\x00" + DC4))  # Later bytes need not be accepted.
        self._moved = clock.now()
        self._lines = 0
        self._held = False  # Stopped by a DC3 that the kernel does not obey.
        self.reach = Reach(0, len(data))

    def run(self) -> int:
        """Send the program and return the number of bytes.

        Raises CancelledError, WireError or DriverError.
        """
        try:
            if self._settings.wait:
                self._wait_for_start()
            self._send()
        except CancelledError:
            self._wire.drop_output()
            raise
        finally:
            self._wire.close()
        return len(self._data)

    def _wait_for_start(self) -> None:
        until = self._clock.now() + PATIENCE
        self._tell(0, FOR_DC1)
        come = b""
        while DC1[0] not in {character & 0x7F for character in come}:
            self._go_on()
            if self._clock.now() > until:
                raise DriverError(
                    "the other device has not requested a program (DC1) for 2 minutes; start the "
                    "transfer on that device",
                    reason="not-asked",
                )
            come = self._wire.receive(TICK)
        if self._settings.line.flow == "xonxoff":
            self._wire.obey_codes()
        self._heed(come)

    def _send(self) -> None:
        taken = out = 0
        self._moved = self._clock.now()
        while out < len(self._data):
            self._go_on()
            if not self._held and not self._wire.waiting() and taken < len(self._data):
                taken += self._wire.offer(self._data[taken : taken + CHUNK])
            before, out = out, taken - self._wire.waiting()
            self._watch(out, moved=out > before)
            if out >= self._needed and (self._held or self.reach.what == HELD_BACK):
                return  # DC3 after the final %: the program is complete.
            if out < len(self._data):
                self._pause(taken - out)

    def _watch(self, out: int, *, moved: bool) -> None:
        now = self._clock.now()
        if moved:
            self._moved = now
        still = now - self._moved
        if still > PATIENCE:
            raise DriverError(
                "the other device paused the transfer after {file} bytes and has not continued "
                "for 2 minutes; check whether that device is ready",
                reason="held",
                file=out,
            )
        self._tell(out, HELD_BACK if still > HELD else "")

    def _pause(self, waiting: int) -> None:
        """Wait until the pending bytes are transmitted, or until the other side sends something."""
        self._heed(self._wire.receive(min(max(waiting, 1) * self._settings.line.character, TICK)))

    def _heed(self, come: bytes) -> None:
        """Obey DC3 and DC1 if the kernel does not; other received characters are ignored."""
        if self._settings.line.flow != "xonxoff":
            return
        for character in come:
            plain = character & 0x7F
            if plain in {DC1[0], DC3[0]}:
                self._held = plain == DC3[0]

    def _tell(self, out: int, what: str) -> None:
        line_end = self._settings.eol[-1].encode("ascii")
        self._lines += self._data.count(line_end, self.reach.done, out)
        self.reach = Reach(out, len(self._data), self._lines, what)


class Receiving(_Transfer):
    """Transfer that receives one complete program."""

    def run(self) -> Program:
        """Receive a program. Raises CancelledError, IncompleteError or WireError; then nothing is saved."""
        try:
            return self._receive()
        finally:
            self._wire.close()

    def _receive(self) -> Program:
        incoming, clock = Incoming(self._settings), self._clock
        heard = asked = clock.now()
        self._ask()
        while incoming.phase is not Phase.WHOLE:
            self._go_on()
            come = self._wire.receive(TICK)
            now = clock.now()
            if come:
                heard = now
                self._take(incoming, come)
            elif incoming.phase is Phase.WAITING:
                if now - max(asked, heard) >= AGAIN:
                    asked = now
                    self._ask()
            elif now - heard >= LAST:
                self._ended(incoming, gone=now - heard >= QUIET)
        self._say(DC3)
        return incoming.program()

    def _take(self, incoming: Incoming, come: bytes) -> None:
        incoming.feed(come)
        if self._wire.damaged and incoming.phase is not Phase.WAITING:
            raise IncompleteError(
                "a character in line {lines} is damaged; nothing was saved. Check the serial "
                "port settings and the shield and ground of the cable, then send the program "
                "again",
                reason="damaged",
                lines=incoming.lines,
            )
        if incoming.phase is not Phase.WAITING:
            self.reach = Reach(incoming.count, 0, incoming.lines)
            return
        what = NO_TEXT if incoming.noise or self._wire.damaged else FOR_FRAME
        self.reach = Reach(incoming.count, 0, incoming.lines, what, incoming.heard)

    def _ended(self, incoming: Incoming, *, gone: bool) -> None:
        """Finish after a silence; without a complete frame, wait longer because the sender may be slow."""
        if not self._settings.wrap and not gone:
            return
        try:
            incoming.silence()
        except IncompleteError:
            if gone:
                raise

    def _ask(self) -> None:
        if not self.reach.heard:
            self.reach = Reach(what=FOR_SENDER)
        self._say(DC1)

    def _say(self, code: bytes) -> None:
        if self._settings.dc_codes or self._settings.line.flow == "xonxoff":
            own = self._settings.own_parity
            self._wire.offer(code.translate(table_of(self._settings.line.parity)) if own else code)
