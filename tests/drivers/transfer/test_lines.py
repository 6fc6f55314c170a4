"""Programs over a pty, by pyserial and the kernel's own flow control, and as commands."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor

import pytest

from drivers.serial_line import LineSettings, SerialLineError
from drivers.serial_port import SerialPort
from drivers.transfer.program_framing import ReceivedText, TransferSettings, encode_program
from drivers.transfer.transfer_session import ReceiveTransfer, SendTransfer, TransferCanceledError
from drivers.wakeups import RealClock
from tests.coded import raises_code
from tests.drivers.inverter.lines import WAIT, Pair, until
from tests.drivers.transfer.far_end import FarEnd, feed

TEXT = b"".join(b"N%d X1.2345 Z-.5\n" % n for n in range(400))

LONG = TEXT * (400_000 // len(TEXT))  # more than a pseudo terminal holds: nobody reads, nobody is done


def sent(
    port: str, pool: ThreadPoolExecutor, flow: str = "xonxoff"
) -> tuple[SendTransfer, bytes, Future[int]]:
    settings = TransferSettings(LineSettings(port, flow_control=flow), line_end="\n")
    data = encode_program(LONG, settings)
    job = SendTransfer(SerialPort(settings.sending_settings), RealClock(), settings, data)
    return job, data, pool.submit(job.send_program)


def test_xoff_stops_sending_within_a_line_and_xon_resumes(far: FarEnd, pool: ThreadPoolExecutor) -> None:
    _, data, future = sent(far.port, pool)
    until(lambda: far.hear() != b"" and len(far.heard) > 200, "the beginning")
    far.say(b"\x13")
    until(lambda: far.hear(0.3) == b"", "a stop")  # what was under way has come
    assert len(far.heard) < len(data)
    assert not future.done()
    far.say(b"\x11")
    until(lambda: far.hear() == b"" and future.done(), "the end")
    while far.hear():  # what came between the last look and the end
        pass
    assert future.result(WAIT) == len(data)
    assert bytes(far.heard) == data


def test_port_without_seven_bits_uses_software_parity_and_flow_control(
    far: FarEnd, pool: ThreadPoolExecutor
) -> None:
    """DC3 has three ones: with even parity it is 93 on the line, DC1 stays 11."""
    settings = TransferSettings(
        LineSettings(far.port, data_bits=7, parity="E", flow_control="xonxoff"), line_end="\n"
    )
    job = SendTransfer(
        SerialPort(settings.sending_settings), RealClock(), settings, encode_program(LONG[:40_000], settings)
    )
    future = pool.submit(job.send_program)
    until(lambda: far.hear() != b"" and len(far.heard) > 200, "the beginning")
    far.say(b"\x93")
    until(lambda: far.hear(0.3) == b"", "a stop")
    assert not future.done()
    far.say(b"\x11")
    until(lambda: far.hear() == b"" and future.done(), "the end")
    while far.hear():
        pass
    assert all(c.bit_count() % 2 == 0 for c in far.heard)
    assert bytes(c & 0x7F for c in far.heard) == encode_program(LONG[:40_000], settings)


def test_canceling_during_xoff_releases_the_port(far: FarEnd, pool: ThreadPoolExecutor) -> None:
    job, _, future = sent(far.port, pool)
    until(lambda: far.hear() != b"", "the beginning")
    far.say(b"\x13")
    until(lambda: far.hear(0.3) == b"", "a stop")
    job.cancel()
    with pytest.raises(TransferCanceledError):
        future.result(WAIT)
    SerialPort(LineSettings(far.port)).close()


def test_port_has_only_one_owner(far: FarEnd) -> None:
    first = SerialPort(LineSettings(far.port))
    with raises_code(SerialLineError, "driver", far.port) as told:
        SerialPort(LineSettings(far.port))
    assert told.value.reason == "not-opened"
    first.close()


def test_disconnected_cable_ends_reception_with_an_error(pool: ThreadPoolExecutor) -> None:
    with Pair() as cable:
        settings = TransferSettings(LineSettings(cable.near))
        job = ReceiveTransfer(
            SerialPort(settings.receiving_settings, count_damaged=True), RealClock(), settings
        )
        future = pool.submit(job.receive_program)
        cable.cut()
        with raises_code(SerialLineError, "driver", cable.near) as told:
            future.result(WAIT)
        assert told.value.reason == "failed"


@pytest.mark.parametrize("bits", [7, 8])
def test_seven_bits_and_even_parity_are_received(far: FarEnd, pool: ThreadPoolExecutor, bits: int) -> None:
    """Set to 7E1, and found out by a port that is set to 8N1."""
    settings = TransferSettings(LineSettings(far.port, data_bits=bits, parity="E" if bits == 7 else "N"))
    job = ReceiveTransfer(SerialPort(settings.receiving_settings, count_damaged=True), RealClock(), settings)
    future: Future[ReceivedText] = pool.submit(job.receive_program)
    stream = bytes(10) + b"%\r\n" + TEXT.replace(b"\n", b"\r\n") + b"%\r\n" + bytes(10)
    feed(far, bytes(c | (c.bit_count() % 2 << 7) for c in stream))
    program = future.result(WAIT)
    assert program.program_bytes == TEXT
    assert program.is_seven_bit == (bits == 8)


def test_eight_bit_characters_and_the_damage_marker_byte_are_received(
    far: FarEnd, pool: ThreadPoolExecutor
) -> None:
    settings = TransferSettings(LineSettings(far.port))
    job = ReceiveTransfer(SerialPort(settings.receiving_settings, count_damaged=True), RealClock(), settings)
    future: Future[ReceivedText] = pool.submit(job.receive_program)
    feed(far, b"%\n(\xff\xfe\x94)\nM30\n%\n")
    assert future.result(WAIT).program_bytes == b"(\xff\xfe\x94)\nM30\n"


def test_closing_the_port_does_not_discard_unsent_data(far: FarEnd) -> None:
    """Closing at once after the last byte, a hundred times: the far end has all of it each time."""
    for _ in range(100):
        wire = SerialPort(LineSettings(far.port))
        assert wire.send_available_bytes(b"%\n") == 2
        wire.close()
        far.heard.clear()
        until(lambda: far.hear() != b"" and len(far.heard) >= 2, "the last %")
        assert bytes(far.heard) == b"%\n"
