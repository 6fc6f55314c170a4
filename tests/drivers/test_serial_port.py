"""The serial port: damaged characters told from good ones, and every failure one sentence."""

from __future__ import annotations

import os
import select
from pathlib import Path

import pytest

from drivers.serial_line import LineSettings, SerialLineError
from drivers.serial_port import ParityMarkDecoder, SerialPort
from tests.coded import raises_code
from tests.drivers.ptys import open_pty

# What a terminal makes of A FF B, C damaged, D, 00 damaged (PARMRK of termios: FF 00 c, and FF FF).
MARKED, MEANT = b"A\xff\xffB\xff\x00CD\xff\x00\x00", b"A\xffBCD\x00"


@pytest.mark.parametrize("size", [1, 2, 3, 4, 5, len(MARKED)])
def test_parity_marks_are_removed_and_counted_wherever_data_is_split(size: int) -> None:
    marks = ParityMarkDecoder()
    come = b"".join(marks.decode(MARKED[at : at + size]) for at in range(0, len(MARKED), size))
    assert (come, marks.damaged_count) == (MEANT, 2)


def test_incomplete_parity_mark_waits_for_the_rest() -> None:
    marks = ParityMarkDecoder()
    assert [marks.decode(each) for each in (b"G\xff", b"\x00", b"1")] == [b"G", b"", b"1"]
    assert marks.damaged_count == 1


def test_missing_or_invalid_port_is_reported_with_its_cause(tmp_path: Path) -> None:
    with raises_code(SerialLineError, "driver", "/dev/ttyNone") as told:
        SerialPort(LineSettings("/dev/ttyNone"))
    assert told.value.reason == "not-opened"
    file = tmp_path / "file"
    file.write_bytes(b"")
    with raises_code(SerialLineError, "driver", file) as told:
        SerialPort(LineSettings(str(file)))
    assert told.value.reason == "not-opened"


def test_errors_after_a_disconnection_are_each_one_line() -> None:
    far, near = open_pty()
    name = os.ttyname(near)
    wire = SerialPort(LineSettings(name))
    os.close(near)
    os.write(far, b"G90\n")
    assert wire.receive(1.0) == b"G90\n"
    os.close(far)
    for ask in (lambda: wire.receive(0.0), lambda: wire.send(b"x"), lambda: wire.send_available_bytes(b"x")):
        with raises_code(SerialLineError, "driver", name) as told:
            ask()
        assert told.value.reason == "failed"
    wire.close()
    wire.close()  # a second time is nothing


def test_line_with_a_full_buffer_accepts_nothing_and_can_be_closed() -> None:
    """What the kernel holds is known, can be dropped, and does not keep the port."""
    far, near = open_pty()
    wire = SerialPort(LineSettings(os.ttyname(near)))
    taken = wire.send_available_bytes(b"X" * 4096)
    # The kernel moves what it holds on to the far side, which makes room once more.
    while select.select([], [near], [], 0.2)[1]:
        taken += wire.send_available_bytes(b"X" * 4096)
    assert taken > 4096
    assert wire.send_available_bytes(b"X") == 0
    wire.discard_output()
    wire.discard_input()
    assert wire.receive(0.0) == b""
    wire.close()
    os.close(near)
    os.close(far)


def test_damage_is_not_counted_without_parity() -> None:
    far, near = open_pty()
    for watch in (False, True):
        wire = SerialPort(LineSettings(os.ttyname(near)), count_damaged=watch)
        os.write(far, b"\xff\x01")
        assert wire.receive(1.0) == b"\xff\x01"
        assert wire.damaged_character_count == 0
        assert wire.count_unsent_bytes() == 0
        wire.close()
    os.close(near)
    os.close(far)
