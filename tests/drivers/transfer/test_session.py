"""Transfers on a clock of their own: holds, silence, cuts, and giving up at any moment."""

from __future__ import annotations

import dataclasses

import pytest

from core.ports import DriverError
from drivers.serial_line import LineSettings, SerialLineError
from drivers.transfer.program_framing import IncompleteProgramError, TransferSettings, encode_program
from drivers.transfer.transfer_session import (
    ReceiveTransfer,
    SendTransfer,
    TransferCanceledError,
    TransferState,
)
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.transfer.bench import OtherSide

SETTINGS = TransferSettings(LineSettings("bench", flow_control="xonxoff"), line_end="\n")
TEXT = b"".join(b"N%d X1.2345\n" % n for n in range(200))
DATA = encode_program(TEXT, SETTINGS)


def sending(side: OtherSide, settings: TransferSettings = SETTINGS) -> SendTransfer:
    return SendTransfer(side, side.clock, settings, DATA)


def receiving(side: OtherSide, settings: TransferSettings = SETTINGS) -> ReceiveTransfer:
    return ReceiveTransfer(side, side.clock, settings)


def test_program_is_sent_completely_in_small_pieces() -> None:
    side = OtherSide(ManualClock())
    job = sending(side)
    assert job.send_program() == len(DATA)
    assert bytes(side.taken) == DATA
    assert side.largest <= 64
    assert side.closed
    assert job.progress == TransferState(len(DATA), len(DATA), 202, "")
    assert side.clock.now() == pytest.approx(len(DATA) / 960.0, rel=0.3)


def test_xoff_within_a_line_is_awaited_and_reported() -> None:
    side = OtherSide(ManualClock(), holds=(0.5, 30.0))
    job = sending(side)
    told: set[str] = set()

    def look() -> None:
        told.add(job.progress.wait_reason)

    side.before_listening = look
    job.send_program()
    assert bytes(side.taken) == DATA
    assert "held" in told
    assert side.clock.now() > 30.0


def test_endless_xoff_is_an_error() -> None:
    side = OtherSide(ManualClock(), holds=(0.5, 1e9))
    with raises_code(DriverError, "driver", "512 bytes") as told:
        sending(side).send_program()
    assert told.value.reason == "held"
    assert side.closed


class Satisfied(OtherSide):
    """Says DC3 as soon as it has the last %; ``obeyed`` by the kernel, or for us to read."""

    obeyed = True

    def send_available_bytes(self, data: bytes) -> int:
        taken = super().send_available_bytes(data)
        if b"\n%\n" in self.taken and self.holds[0] < 0.0:
            now = self.clock.now()
            self.holds = (now, 1e9) if self.obeyed else (1e8, 1e9)
            self.script = [] if self.obeyed else [(now, b"\x13")]
        return taken


@pytest.mark.parametrize("obeyed", [True, False])
def test_xoff_after_the_final_percent_ends_the_transfer(obeyed: bool) -> None:
    settings = dataclasses.replace(SETTINGS, has_dc_codes=True, leader_nul_count=200)
    data = encode_program(TEXT, settings)
    side = Satisfied(ManualClock())
    side.obeyed = obeyed
    assert SendTransfer(side, side.clock, settings, data).send_program() == len(data)
    assert data.startswith(bytes(side.taken))
    assert bytes(side.taken).rstrip(b"\0\x14\n").endswith(b"\n%")
    assert len(side.taken) < len(data)
    assert side.clock.now() < 10.0


def test_sender_waits_for_dc1_and_then_obeys_flow_control() -> None:
    side = OtherSide(ManualClock(), [(3.0, b"\x91")])  # DC1 with its parity bit
    settings = dataclasses.replace(SETTINGS, needs_dc1=True)
    assert settings.sending_settings.flow_control == "none"
    sending(side, settings).send_program()
    assert bytes(side.taken) == DATA
    assert side.obeys
    assert side.clock.now() > 3.0


def test_send_times_out_if_the_receiver_never_sends_dc1() -> None:
    side = OtherSide(ManualClock())
    with raises_code(DriverError, "driver", "DC1") as told:
        sending(side, dataclasses.replace(SETTINGS, needs_dc1=True)).send_program()
    assert told.value.reason == "not-asked"
    assert side.taken == b""


@pytest.mark.parametrize("at", [0.0, 0.3, 1.0, 2.0])
def test_disconnected_cable_ends_sending_with_an_error(at: float) -> None:
    side = OtherSide(ManualClock(), cut_at=at)
    with pytest.raises(SerialLineError):
        sending(side).send_program()
    assert side.closed


def test_sending_can_be_canceled_during_xoff() -> None:
    side = OtherSide(ManualClock(), [(20.0, b"")], holds=(0.2, 1e9))
    job = sending(side)

    def cancel_late() -> None:
        if side.clock.now() > 5.0:
            job.cancel()

    side.before_listening = cancel_late
    with pytest.raises(TransferCanceledError):
        job.send_program()
    assert side.clock.now() < 5.3
    assert side.closed


def test_program_is_received_between_dc1_and_dc3() -> None:
    side = OtherSide(ManualClock(), [(1.0, DATA[:100]), (1.5, DATA[100:150]), (9.0, DATA[150:])])
    program = receiving(side).receive_program()
    assert program.program_bytes == TEXT
    assert program.line_count == 200
    assert side.closed
    assert bytes(side.taken) == b"\x11\x13"  # come on; enough


def test_dc1_is_repeated_while_nothing_arrives() -> None:
    side = OtherSide(ManualClock(), [(11.0, DATA)])
    receiving(side).receive_program()
    assert bytes(side.taken) == b"\x11\x11\x11\x13"  # at 0, 5 and 10 s


def test_noise_before_the_program_does_not_stop_repeating_dc1() -> None:
    """One stray character at 1 s: DC1 is said at 0, and 5 s after each last word, at 6 and 11."""
    side = OtherSide(ManualClock(), [(1.0, b"?"), (12.0, DATA)])
    assert receiving(side).receive_program().program_bytes == TEXT
    assert bytes(side.taken) == b"\x11\x11\x11\x13"


@pytest.mark.parametrize(
    ("come", "heard", "what"),
    [
        (b"O12 G90\r\n", "O12 G90  ", "frame"),  # a program without %
        (bytes(c | (c.bit_count() & 1) << 7 for c in b"G90"), "G90", "frame"),  # the same in seven bits
        (b"\x00\x00\xff\x7f", "", "frame"),  # a leader and rubbed out characters: nothing to be said
        (b"\x9e\x01\x1c\xe6", "<9E><01><1C><E6>", "noise"),  # another rate
    ],
)
def test_data_received_before_a_program_is_reported(come: bytes, heard: str, what: str) -> None:
    side = OtherSide(ManualClock(), [(1.0, come), (4.0, DATA)])
    told: list[tuple[str, str]] = []
    job = receiving(side)

    def look() -> None:
        if side.clock.now() > 2.0 and not told:
            told.append((job.progress.leading_text, job.progress.wait_reason))

    side.before_listening = look
    assert job.receive_program().program_bytes == TEXT
    assert told == [(heard, what)]


def test_no_control_codes_are_sent_without_flow_control() -> None:
    side = OtherSide(ManualClock(), [(1.0, DATA)])
    receiving(side, dataclasses.replace(SETTINGS, line_settings=LineSettings("bench"))).receive_program()
    assert side.taken == b""


def test_final_percent_without_a_line_ending_ends_reception_quickly() -> None:
    side = OtherSide(ManualClock(), [(1.0, DATA[:-1])])
    assert receiving(side).receive_program().program_bytes == TEXT
    assert side.clock.now() < 2.0


def test_pause_after_a_line_does_not_end_the_program() -> None:
    """The sender reads from a slow disk: five seconds in the middle."""
    side = OtherSide(ManualClock(), [(1.0, DATA[:500]), (6.0, DATA[500:])])
    assert receiving(side).receive_program().program_bytes == TEXT


def test_program_without_a_final_percent_is_rejected() -> None:
    side = OtherSide(ManualClock(), [(1.0, DATA[:-2])])
    with raises_code(IncompleteProgramError, "driver", "%", "201 lines") as told:
        receiving(side).receive_program()
    assert told.value.reason == "no-end"
    assert 11.0 <= side.clock.now() < 11.2
    assert side.closed


def test_damaged_character_ends_reception_immediately() -> None:
    side = OtherSide(ManualClock(), [(1.0, DATA[:100]), (1.2, DATA[100:])])
    job = receiving(side)

    def spoil() -> None:
        side.damaged_character_count = int(side.clock.now() >= 1.1)

    side.before_listening = spoil
    with raises_code(IncompleteProgramError, "driver", "line 201") as told:
        job.receive_program()
    assert told.value.reason == "damaged"


@pytest.mark.parametrize("at", [0.0, 1.02, 1.1, 9.0])
def test_disconnected_cable_ends_reception_with_an_error(at: float) -> None:
    script = [(1.0 + n / 100, DATA[10 * n : 10 * n + 10]) for n in range(len(DATA) // 10 + 1)]
    side = OtherSide(ManualClock(), script, cut_at=at)
    if at > 8.0:
        assert receiving(side).receive_program().program_bytes == TEXT  # it had come
        return
    with pytest.raises(SerialLineError):
        receiving(side).receive_program()
    assert side.closed


def test_reception_can_be_canceled() -> None:
    side = OtherSide(ManualClock(), [(1.0, DATA[:100])])
    job = receiving(side)

    def cancel_late() -> None:
        if side.clock.now() > 2.0:
            job.cancel()

    side.before_listening = cancel_late
    with pytest.raises(TransferCanceledError):
        job.receive_program()
    assert side.clock.now() < 2.2
    assert side.closed
