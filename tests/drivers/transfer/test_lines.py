"""Programs over a pty, by pyserial and the kernel's own flow control, and as commands."""

from __future__ import annotations

import os
import select
import threading
import tty
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import pytest

from app.cli.main import main
from drivers.serial_wire import SerialWire
from drivers.simulated import RealClock
from drivers.transfer.incoming import Program
from drivers.transfer.outgoing import outgoing
from drivers.transfer.session import CancelledError, Receiving, Sending
from drivers.transfer.settings import TransferSettings
from drivers.wire import LineSettings, WireError
from tests.drivers.inverter.lines import WAIT, Pair, until
from tests.drivers.ptys import open_pty

TEXT = b"".join(b"N%d X1.2345 Z-.5\n" % n for n in range(400))

LONG = TEXT * (400_000 // len(TEXT))  # more than a pseudo terminal holds: nobody reads, nobody is done


class FarEnd:
    """The other side by hand: what it has heard, and what it says."""

    def __init__(self) -> None:
        self.handle, self._slave = open_pty()
        tty.setraw(self._slave)
        self.port = os.ttyname(self._slave)
        self.heard = bytearray()

    def hear(self, limit: float = 0.05) -> bytes:
        """What comes within the limit."""
        ready, _, _ = select.select((self.handle,), (), (), limit)
        data = os.read(self.handle, 4096) if ready else b""
        self.heard += data
        return data

    def say(self, data: bytes) -> None:
        os.write(self.handle, data)

    def close(self) -> None:
        for handle in (self.handle, self._slave):
            os.close(handle)


@pytest.fixture
def far() -> Iterator[FarEnd]:
    end = FarEnd()
    yield end
    end.close()


@pytest.fixture
def pool() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor(2) as made:
        yield made


def sent(port: str, pool: ThreadPoolExecutor, flow: str = "xonxoff") -> tuple[Sending, bytes, Future[int]]:
    settings = TransferSettings(LineSettings(port, flow=flow), eol="\n")
    data = outgoing(LONG, settings)
    job = Sending(SerialWire(settings.sending), RealClock(), settings, data)
    return job, data, pool.submit(job.run)


def test_xoff_in_the_middle_of_a_line_stops_it_and_xon_goes_on(far: FarEnd, pool: ThreadPoolExecutor) -> None:
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


def test_giving_up_while_it_is_held_lets_the_port_go(far: FarEnd, pool: ThreadPoolExecutor) -> None:
    job, _, future = sent(far.port, pool)
    until(lambda: far.hear() != b"", "the beginning")
    far.say(b"\x13")
    until(lambda: far.hear(0.3) == b"", "a stop")
    job.cancel()
    with pytest.raises(CancelledError):
        future.result(WAIT)
    SerialWire(LineSettings(far.port)).close()


def test_a_port_has_one_owner(far: FarEnd) -> None:
    first = SerialWire(LineSettings(far.port))
    with pytest.raises(WireError, match="cannot be opened"):
        SerialWire(LineSettings(far.port))
    first.close()


def test_cable_out_while_receiving(pool: ThreadPoolExecutor) -> None:
    with Pair() as cable:
        settings = TransferSettings(LineSettings(cable.near))
        job = Receiving(SerialWire(settings.receiving, watch=True), RealClock(), settings)
        future = pool.submit(job.run)
        cable.cut()
        with pytest.raises(WireError, match="has failed"):
            future.result(WAIT)


@pytest.mark.parametrize("bits", [7, 8])
def test_seven_bits_and_even_parity_arrive(far: FarEnd, pool: ThreadPoolExecutor, bits: int) -> None:
    """Set to 7E1, and found out by a port that is set to 8N1."""
    settings = TransferSettings(LineSettings(far.port, bits=bits, parity="E" if bits == 7 else "N"))
    job = Receiving(SerialWire(settings.receiving, watch=True), RealClock(), settings)
    future: Future[Program] = pool.submit(job.run)
    stream = bytes(10) + b"%\r\n" + TEXT.replace(b"\n", b"\r\n") + b"%\r\n" + bytes(10)
    feed(far, bytes(c | (c.bit_count() % 2 << 7) for c in stream))
    program = future.result(WAIT)
    assert program.text == TEXT
    assert program.seven == (bits == 8)


def test_letters_of_eight_bits_and_the_byte_that_marks_damage(far: FarEnd, pool: ThreadPoolExecutor) -> None:
    settings = TransferSettings(LineSettings(far.port))
    job = Receiving(SerialWire(settings.receiving, watch=True), RealClock(), settings)
    future: Future[Program] = pool.submit(job.run)
    feed(far, b"%\n(\xff\xfe\x94)\nM30\n%\n")
    assert future.result(WAIT).text == b"(\xff\xfe\x94)\nM30\n"


def test_a_received_program_overwrites_nothing(far: FarEnd, tmp_path: Path, pool: ThreadPoolExecutor) -> None:
    target = tmp_path / "OLD.nc"
    target.write_bytes(b"M02\n")
    future = pool.submit(
        main, ["serial", "receive", "--port", far.port, "--out", str(target), "--flow", "none"]
    )
    answer(far, future, b"%\nG90\nM30\n%\n")
    assert future.result(WAIT) == 1
    assert target.read_bytes() == b"M02\n"
    assert [path.name for path in tmp_path.iterdir()] == ["OLD.nc"]


def test_what_is_not_whole_leaves_nothing(far: FarEnd, tmp_path: Path, pool: ThreadPoolExecutor) -> None:
    target = tmp_path / "NEW.nc"
    arguments = [
        "serial",
        "receive",
        "--port",
        far.port,
        "--bits",
        "7",
        "--parity",
        "E",
        "--out",
        str(target),
    ]
    future = pool.submit(main, arguments)
    answer(far, future, b"\xa5\x0a\x31")  # a 1 without its parity bit
    assert future.result(WAIT) == 1
    assert list(tmp_path.iterdir()) == []


def test_commands_that_cannot_be(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serial", "send", str(tmp_path / "none.nc"), "--port", "/dev/ttyNONE7"]) == 1
    assert "CANNOT BE READ" in capsys.readouterr().err
    program = tmp_path / "p.nc"
    program.write_text("M30\n")
    assert main(["serial", "send", str(program), "--port", "/dev/ttyNONE7"]) == 1
    assert "/dev/ttyNONE7 cannot be opened: No such file" in capsys.readouterr().err
    assert main(["serial", "send", str(program)]) == 2
    assert "no port: say --port" in capsys.readouterr().err


def test_ports_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serial", "ports"]) == 0
    told = capsys.readouterr()
    assert told.out or "no serial port" in told.err


def feed(far: FarEnd, data: bytes) -> None:
    """As fast as the pty takes it."""
    at = 0
    os.set_blocking(far.handle, False)
    while at < len(data):
        _, free, _ = select.select((), (far.handle,), (), WAIT)
        assert free
        at += os.write(far.handle, data[at : at + 512])


def answer(far: FarEnd, future: Future[int], data: bytes) -> None:
    """Say it again until the command, which opens its port in its own time, has come to its end."""
    tick = threading.Event()
    for _ in range(int(WAIT / 0.1)):
        if future.done():
            return
        far.say(data)
        tick.wait(0.1)
