"""What comes in from the line: framed, whole, every parity right; or a sentence."""

from __future__ import annotations

from hashlib import sha256

import pytest

from drivers.serial_line import LineSettings
from drivers.transfer.program_framing import (
    IncompleteProgramError,
    ProgramParser,
    ReceivedText,
    ReceptionPhase,
    TransferSettings,
)
from tests.coded import raises_code

EIGHT = TransferSettings(LineSettings("bench"))
SEVEN = TransferSettings(LineSettings("bench", data_bits=7, parity="E"))
ODD = TransferSettings(LineSettings("bench", data_bits=7, parity="O"))
BODY = b"G90G70\nG00X1.Z.1\n\nM30\n"  # with an empty line
LINES = b"G90G70", b"G00X1.Z.1", b"", b"M30"


def even(text: bytes) -> bytes:
    """Bit 7 makes the count of ones even, as 7E1 sends it."""
    return bytes(c | (0x80 if c.bit_count() % 2 else 0) for c in text)


def odd(text: bytes) -> bytes:
    return bytes(c | (0x80 if c.bit_count() % 2 == 0 else 0) for c in text)


def framed(eol: bytes) -> bytes:
    return eol.join((b"%", *LINES, b"%")) + eol


def taken(stream: bytes, settings: TransferSettings = EIGHT, *, chunk: int = 1) -> ReceivedText:
    """Feed it in pieces; then silence."""
    incoming = ProgramParser(settings)
    for at in range(0, len(stream), chunk):
        incoming.add_characters(stream[at : at + chunk])
    incoming.handle_silence()
    assert incoming.phase is ReceptionPhase.COMPLETE
    return incoming.build_program()


@pytest.mark.parametrize("eol", [b"\r\n", b"\n", b"\r", b"\n\r\r"], ids=["CRLF", "LF", "CR", "LFCRCR"])
@pytest.mark.parametrize("chunk", [1, 3, 64])
def test_every_line_end_gives_the_same_program(eol: bytes, chunk: int) -> None:
    program = taken(framed(eol), chunk=chunk)
    assert program.program_bytes == BODY
    assert program.line_count == 4
    assert program.sha256 == sha256(BODY).hexdigest()
    assert not program.is_seven_bit


@pytest.mark.parametrize(
    "stream",
    [
        bytes(40) + framed(b"\n") + bytes(40),  # leader and trailer
        b"GARBAGE \x07\x81\r\nlogin: " + framed(b"\n"),
        b"\x12" + framed(b"\r\n") + b"\x14",  # DC2 … DC4
        b"\x11\x13" + framed(b"\r\n") + b"\x13",
        framed(b"\n").rstrip(b"\n"),  # the last % without a line end
        framed(b"\n") + b"what stands behind is of no interest",
        framed(b"\n").replace(b"X1.", b"X\x7f\x001."),  # rubbed out, and a NUL between
    ],
    ids=["NULs", "garbage", "DC2 DC4", "XON XOFF", "no last end", "behind", "rubout"],
)
def test_data_around_a_program_is_ignored(stream: bytes) -> None:
    assert taken(stream).program_bytes == BODY


def test_seven_bits_with_even_parity_are_detected_on_an_8n1_port() -> None:
    program = taken(even(framed(b"\r\n")))
    assert program.program_bytes == BODY
    assert program.is_seven_bit


@pytest.mark.parametrize(("settings", "code"), [(SEVEN, even), (ODD, odd)])
def test_seven_bits_are_decoded_according_to_the_settings(settings: TransferSettings, code: object) -> None:
    assert callable(code)
    program = taken(bytes(20) + code(framed(b"\n")) + bytes(20), settings)
    assert program.program_bytes == BODY
    assert not program.is_seven_bit  # that is no discovery


def test_eight_bit_characters_are_retained() -> None:
    """cp437: 94 is an ö, 84 an ä, 9A an Ü; with the top bit off they would be DC4, EOT and ^Z."""
    stream = b"%\n(\x94l, h\x84ngt \x9abel)\nM30\n%\n"
    assert taken(stream).program_bytes == b"(\x94l, h\x84ngt \x9abel)\nM30\n"


def test_false_percent_in_noise_before_the_program_is_ignored() -> None:
    """A5 is a % with even parity; here it is noise before an eight-bit program."""
    assert taken(b"\xa5" + framed(b"\n")).program_bytes == BODY


@pytest.mark.parametrize(
    ("head", "first", "name"),
    [
        (b"%", b"O1234 (BUSHING)", "O1234"),
        (b"%BUSH-7", b"G90", "BUSH-7"),
        (b"%_N_RING_MPF", b"G90", "RING.mpf"),
        (b"% (PIN.NC)", b"G90", "PIN.NC"),
        (b"%../../etc/passwd", b"G90", ""),
        (b"%", b"G90 O5", ""),
    ],
)
def test_program_name_is_found_in_the_header(head: bytes, first: bytes, name: str) -> None:
    assert taken(head + b"\n" + first + b"\nM30\n%\n").program_name == name


@pytest.mark.parametrize(
    ("stream", "settings", "reason", "values"),
    [
        (b"", EIGHT, "nothing", []),
        (b"G90\nM30\n", EIGHT, "no-begin", ["8 characters", "%"]),
        (framed(b"\n")[:-2], EIGHT, "no-end", ["%", "5 lines"]),
        (framed(b"\n")[:-2] + b"\x14", EIGHT, "no-end", ["%"]),
        (b"%\nG90\n", EIGHT, "no-end", ["%"]),
        (b"%\n%\n", EIGHT, "empty", []),
        (b"%\n\n\n%\n", EIGHT, "empty", []),
        (b"%\nG90\nX\x021.\n%\n", EIGHT, "control-character", ["line 2 ", "02"]),
        (b"%_N_A_MPF\nG90\n%_N_B_MPF\nG91\n%\n", EIGHT, "several", ["line 2 ", "%"]),
        (even(framed(b"\n"))[:8] + b"\x31" + even(b"9\nM30\n%\n"), SEVEN, "parity", ["error in line 1;"]),
        (even(framed(b"\n"))[:8] + b"\xb0\xb0", EIGHT, "parity", ["error in line 1;"]),
        (odd(framed(b"\n")), SEVEN, "no-begin", ["%"]),
    ],
    ids=["nothing", "no %", "lost %", "DC4 before %", "stopped", "empty", "blank", "control", "two", "parity",
         "parity found", "wrong parity"],
)  # fmt: skip
def test_incomplete_program_is_rejected(
    stream: bytes, settings: TransferSettings, reason: str, values: list[str]
) -> None:
    with raises_code(IncompleteProgramError, "driver", *values) as told:
        taken(stream, settings)
    assert told.value.reason == reason


def test_truncation_of_a_program_is_always_detected() -> None:
    """Wherever the line is cut: no part of a program passes for a whole one."""
    stream = framed(b"\r\n")
    for length in range(len(stream) - 2):
        with pytest.raises(IncompleteProgramError):
            taken(stream[:length], chunk=7)


def test_every_flipped_bit_is_detected_with_parity() -> None:
    stream = even(framed(b"\n"))
    for at in range(1, len(stream)):
        for bit in range(8):
            spoilt = stream[:at] + bytes((stream[at] ^ 1 << bit,)) + stream[at + 1 :]
            if spoilt[at] == 0:
                continue
            with pytest.raises(IncompleteProgramError):
                taken(spoilt, SEVEN)


def test_program_without_percents_ends_with_silence() -> None:
    bare = TransferSettings(LineSettings("bench"), delimiter="")
    assert taken(bytes(9) + BODY, bare).program_bytes == BODY
    assert taken(even(BODY), bare).program_bytes == BODY
    assert taken(BODY + b"\x14", bare).program_bytes == BODY
