"""The transfer of one program, which runs in one thread.

Other threads may read its progress and cancel it.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass

from core.ports import Clock, DriverError
from drivers.serial_line import FlowControlTransport, create_parity_table
from drivers.transfer.program_framing import (
    DC1,
    DC3,
    DC4,
    IncompleteProgramError,
    ProgramParser,
    ReceivedText,
    ReceptionPhase,
    TransferSettings,
)

CHUNK_BYTES = 64  # Bytes that a USB adapter may still send after a stop by the other side.
CYCLE_S = 0.05  # s
STOP_DETECTION_S = (
    1.0  # Seconds without a transmitted byte after which the line counts as stopped by the other side.
)
MAX_STOP_S = 120.0  # Seconds for which the other side may stop the line.
DC1_REPEAT_S = 5.0  # Seconds after which DC1 is repeated without input.
FINAL_SILENCE_S = 0.5  # Seconds of silence after a final % without a line end.
# Reasons for waiting; the screen has the texts.
STOPPED_BY_RECEIVER, WAITING_FOR_DC1, WAITING_FOR_SENDER, WAITING_FOR_FRAME, RECEIVED_NOISE = (
    "held",
    "dc1",
    "sender",
    "frame",
    "noise",
)
END_SILENCE_S = 10.0  # Seconds of silence within a program after which it counts as ended.


class TransferCanceledError(DriverError):
    """Error raised if the operator cancels the transfer, so that nothing is saved."""


@dataclass(frozen=True, slots=True)
class TransferState:
    """The progress of a transfer: bytes, lines, and the reason for waiting.

    ``total_byte_count`` is 0 if the total is unknown. ``wait_reason`` is an empty string or one of the
    reasons that this module defines, such as WAITING_FOR_DC1. ``leading_text`` is the text received before
    the first %, which is not part of the program.
    """

    transferred_byte_count: int = 0
    total_byte_count: int = 0
    transferred_line_count: int = 0
    wait_reason: str = ""
    leading_text: str = ""


class _Transfer:
    """Base class of the transfers for sending and receiving.

    Any thread may read ``progress``, because it is always replaced as a whole.
    """

    def __init__(self, wire: FlowControlTransport, clock: Clock, settings: TransferSettings) -> None:
        self._wire, self._clock, self._settings = wire, clock, settings
        self._cancelled = threading.Event()
        self.progress = TransferState()

    def cancel(self) -> None:
        """Cancel the transfer.

        The cancellation takes effect within 0.1 s.
        """
        self._cancelled.set()

    def _go_on(self) -> None:
        if self._cancelled.is_set():
            raise TransferCanceledError("cancelled")


class SendTransfer(_Transfer):
    """Transfer that sends bytes in chunks of 64, as fast as the connected device permits."""

    def __init__(
        self, wire: FlowControlTransport, clock: Clock, settings: TransferSettings, data: bytes
    ) -> None:
        super().__init__(wire, clock, settings)
        self._data = data
        self._needed = len(data.rstrip(b"\r\n\x00" + DC4))  # Later bytes need not be accepted.
        self._moved = clock.now()
        self._lines = 0
        self._held = False  # Stopped by a DC3 that the kernel does not obey.
        self.progress = TransferState(0, len(data))

    def send_program(self) -> int:
        """Send the program, and return the number of bytes.

        Raises TransferCanceledError, SerialLineError or another DriverError if the program is not sent
        completely. The connected device does not have to accept the bytes after the final %, but the number
        includes them.
        """
        try:
            if self._settings.needs_dc1:
                self._wait_for_start()
            self._send()
        except TransferCanceledError:
            self._wire.discard_output()
            raise
        finally:
            self._wire.close()
        return len(self._data)

    def _wait_for_start(self) -> None:
        until = self._clock.now() + MAX_STOP_S
        self._tell(0, WAITING_FOR_DC1)
        come = b""
        while DC1[0] not in {character & 0x7F for character in come}:
            self._go_on()
            if self._clock.now() > until:
                raise DriverError(
                    "the other device has not requested a program (DC1) for 2 minutes; start the "
                    "transfer on that device",
                    reason="not-asked",
                )
            come = self._wire.receive(CYCLE_S)
        if self._settings.line_settings.flow_control == "xonxoff":
            self._wire.enable_xon_xoff()
        self._handle_codes(come)

    def _send(self) -> None:
        taken = out = 0
        self._moved = self._clock.now()
        while out < len(self._data):
            self._go_on()
            if not self._held and not self._wire.count_unsent_bytes() and taken < len(self._data):
                taken += self._wire.send_available_bytes(self._data[taken : taken + CHUNK_BYTES])
            before, out = out, taken - self._wire.count_unsent_bytes()
            self._watch(out, moved=out > before)
            if out >= self._needed and (self._held or self.progress.wait_reason == STOPPED_BY_RECEIVER):
                return  # DC3 after the final %: the program is complete.
            if out < len(self._data):
                self._wait_for_room(taken - out)

    def _watch(self, out: int, *, moved: bool) -> None:
        now = self._clock.now()
        if moved:
            self._moved = now
        still = now - self._moved
        if still > MAX_STOP_S:
            raise DriverError(
                "the other device paused the transfer after {file} bytes and has not continued "
                "for 2 minutes; check whether that device is ready",
                reason="held",
                file=out,
            )
        self._tell(out, STOPPED_BY_RECEIVER if still > STOP_DETECTION_S else "")

    def _wait_for_room(self, waiting: int) -> None:
        """Wait until the pending bytes are transmitted or a character arrives, and handle that character."""
        self._handle_codes(
            self._wire.receive(min(max(waiting, 1) * self._settings.line_settings.character_time_s, CYCLE_S))
        )

    def _handle_codes(self, received: bytes) -> None:
        """Handle received DC3 and DC1 codes if the kernel does not handle them.

        Other received characters are ignored.
        """
        if self._settings.line_settings.flow_control != "xonxoff":
            return
        for character in received:
            plain = character & 0x7F
            if plain in {DC1[0], DC3[0]}:
                self._held = plain == DC3[0]

    def _tell(self, out: int, what: str) -> None:
        line_end = self._settings.line_end[-1].encode("ascii")
        self._lines += self._data.count(line_end, self.progress.transferred_byte_count, out)
        self.progress = TransferState(out, len(self._data), self._lines, what)


class ReceiveTransfer(_Transfer):
    """A transfer that receives one complete program."""

    def receive_program(self) -> ReceivedText:
        """Receive a program and return it.

        Raises TransferCanceledError, IncompleteProgramError or SerialLineError; nothing is then saved.
        """
        try:
            return self._receive()
        finally:
            self._wire.close()

    def _receive(self) -> ReceivedText:
        incoming, clock = ProgramParser(self._settings), self._clock
        receive_time_s = asked = clock.now()
        self._ask()
        while incoming.phase is not ReceptionPhase.COMPLETE:
            self._go_on()
            come = self._wire.receive(CYCLE_S)
            now = clock.now()
            if come:
                receive_time_s = now
                self._take(incoming, come)
            elif incoming.phase is ReceptionPhase.WAITING:
                if now - max(asked, receive_time_s) >= DC1_REPEAT_S:
                    asked = now
                    self._ask()
            elif now - receive_time_s >= FINAL_SILENCE_S:
                self._finish_after_silence(incoming, is_silent=now - receive_time_s >= END_SILENCE_S)
        self._say(DC3)
        return incoming.build_program()

    def _take(self, incoming: ProgramParser, come: bytes) -> None:
        incoming.add_characters(come)
        if self._wire.damaged_character_count and incoming.phase is not ReceptionPhase.WAITING:
            raise IncompleteProgramError(
                "a character in line {lines} is damaged; nothing was saved. Check the serial "
                "port settings and the shield and ground of the cable, then send the program "
                "again",
                reason="damaged",
                lines=incoming.line_count,
            )
        if incoming.phase is not ReceptionPhase.WAITING:
            self.progress = TransferState(incoming.character_count, 0, incoming.line_count)
            return
        what = (
            RECEIVED_NOISE
            if incoming.is_input_noise or self._wire.damaged_character_count
            else WAITING_FOR_FRAME
        )
        self.progress = TransferState(
            incoming.character_count, 0, incoming.line_count, what, incoming.leading_text
        )

    def _finish_after_silence(self, incoming: ProgramParser, *, is_silent: bool) -> None:
        """Finish the reception after a silence.

        Without a complete frame, wait longer, because the sender may be slow.
        """
        if not self._settings.delimiter and not is_silent:
            return
        try:
            incoming.handle_silence()
        except IncompleteProgramError:
            if is_silent:
                raise

    def _ask(self) -> None:
        if not self.progress.leading_text:
            self.progress = TransferState(wait_reason=WAITING_FOR_SENDER)
        self._say(DC1)

    def _say(self, code: bytes) -> None:
        if self._settings.has_dc_codes or self._settings.line_settings.flow_control == "xonxoff":
            own = self._settings.is_parity_checked
            self._wire.send_available_bytes(
                code.translate(create_parity_table(self._settings.line_settings.parity)) if own else code
            )
