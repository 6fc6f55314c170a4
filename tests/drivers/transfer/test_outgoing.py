"""What goes out, byte by byte."""

from __future__ import annotations

import pytest

from core.ports import DriverError
from drivers.serial_line import LineSettings
from drivers.serial_port import ParityMarkDecoder
from drivers.transfer.program_framing import TransferSettings, encode_program
from tests.coded import raises_code

LINE = LineSettings("bench")


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        (TransferSettings(LINE), b"%\r\nG90\r\nM30\r\n%\r\n"),
        (TransferSettings(LINE, line_end="\n"), b"%\nG90\nM30\n%\n"),
        (TransferSettings(LINE, line_end="\r"), b"%\rG90\rM30\r%\r"),
        (TransferSettings(LINE, line_end="\n", has_dc_codes=True), b"\x12%\nG90\nM30\n%\n\x14"),
        (TransferSettings(LINE, line_end="\n", leader_nul_count=3), b"\0\0\0%\nG90\nM30\n%\n\0\0\0"),
    ],
)
@pytest.mark.parametrize("text", [b"G90\nM30\n", b"G90\r\nM30", b"%\nG90\nM30\n%\n", b"G90\rM30\r\x1a"])
def test_program_is_framed_exactly_once(settings: TransferSettings, expected: bytes, text: bytes) -> None:
    assert encode_program(text, settings) == expected


@pytest.mark.parametrize(
    ("text", "bits", "reason", "values"),
    [
        (b"", 8, "empty", []),
        (b"%\n%\n", 8, "empty", []),
        (b"G90\n%\nM30\n", 8, "wrap", ["line 2 ", "%"]),
        (b"G90\nX\x071\n", 8, "control-character", ["line 2 ", "07"]),
        ("(öl)\n".encode(), 7, "eighth-bit", ["line 1 ", "7 bits"]),
    ],
)
def test_program_that_cannot_be_transferred_is_not_sent(
    text: bytes, bits: int, reason: str, values: list[str]
) -> None:
    with raises_code(DriverError, "driver", *values) as told:
        encode_program(text, TransferSettings(LineSettings("bench", data_bits=bits)))
    assert told.value.reason == reason


def test_program_without_a_delimiter_is_sent_unframed() -> None:
    assert encode_program(b"G90\nM30\n", TransferSettings(LINE, line_end="\r", delimiter="")) == b"G90\rM30\r"


def test_eight_bit_characters_are_sent() -> None:
    text = "(öl)\n".encode()
    assert encode_program(text, TransferSettings(LINE, line_end="\n")) == b"%\n" + text + b"%\n"


def test_parity_marks_are_removed_and_counted() -> None:
    one = ParityMarkDecoder()
    assert one.decode(b"AB") == b"AB"
    assert one.decode(b"\xff\xffC") == b"\xffC"
    assert one.damaged_count == 0
    assert one.decode(b"\xff") + one.decode(b"\x00") + one.decode(b"XY") == b"XY"
    assert one.damaged_count == 1
