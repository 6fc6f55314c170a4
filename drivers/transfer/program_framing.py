"""Framing of programs as characters on a serial line, with checks for completeness and parity."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import StrEnum
from hashlib import sha256

from core.message import Message
from core.ports import DriverError
from drivers.serial_line import PARITY_VALUES, LineSettings, calculate_parity

DC1, DC2, DC3, DC4 = b"\x11", b"\x12", b"\x13", b"\x14"


@dataclass(frozen=True, slots=True)
class TransferSettings:
    """Settings for the transfer of a program, in addition to the line settings.

    - ``delimiter`` is the line before and after a program. If it is empty, only silence marks the end.
    - ``has_dc_codes`` means that DC2 and DC4 are sent before and after a program, and DC1 and DC3 before
      and after reception.
    - ``needs_dc1`` means that sending starts only after DC1 from the connected device.
    - ``leader_nul_count`` is the number of NUL characters before and after a program.
    """

    line_settings: LineSettings
    delimiter: str = "%"
    line_end: str = "\r\n"
    has_dc_codes: bool = False
    needs_dc1: bool = False
    leader_nul_count: int = 0

    @property
    def is_parity_checked(self) -> bool:
        """Return whether TurnDesk checks the parity itself.

        The line then has eight bits and carries seven bits with parity.
        """
        return self.line_settings.data_bits == 7 and self.line_settings.parity in PARITY_VALUES

    @property
    def sending_settings(self) -> LineSettings:
        """Return the line settings for sending.

        The port uses no flow control while TurnDesk waits for a DC1.
        """
        held = self.line_settings.flow_control == "xonxoff" and self.needs_dc1
        return replace(self.line_settings, flow_control="none") if held else self.line_settings

    @property
    def receiving_settings(self) -> LineSettings:
        """Return the line settings for receiving.

        The port does not use XON/XOFF, because the input is read immediately.
        """
        flow = "rtscts" if self.line_settings.flow_control == "rtscts" else "none"
        if self.is_parity_checked:
            return replace(self.line_settings, data_bits=8, parity="N", flow_control=flow)
        return replace(self.line_settings, flow_control=flow)


# --- Lines and name of a received program, as tapes and controls write them.


_LINE_ENDS = re.compile(rb"[\r\n]+")
_NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,39}")


def split_lines(text: bytes) -> list[bytes]:
    """Return the lines of a text, divided at LF, CR LF, CR or the LF CR CR of tapes.

    Empty lines between other lines are retained.
    """
    lines: list[bytes] = []
    at = 0
    for ends in _LINE_ENDS.finditer(text):
        count = ends[0].count(b"\n") or ends[0].count(b"\r")
        lines += [text[at : ends.start()], *[b""] * (count - 1)]
        at = ends.end()
    return [*lines, text[at:]] if text[at:].strip() else lines


def find_program_name(first_characters: bytes, lines: list[bytes]) -> str:
    """Return the program name after the first %, or the O number of the first line that is not blank."""
    said = first_characters.decode("ascii", "replace").strip().strip("()").strip()
    header = re.fullmatch(r"_N_(.+)_(MPF|SPF)", said, re.IGNORECASE)
    if header is not None:
        said = f"{header[1]}.{header[2].lower()}"
    if _NAME_PATTERN.fullmatch(said):
        return said
    first = next((line for line in lines if line.strip()), b"").decode("ascii", "replace")
    number = re.match(r"\s*[O:](\d{1,8})\b", first, re.IGNORECASE)
    return f"O{number[1]}" if number else ""


MAX_PROGRAM_BYTES = 50_000_000  # Maximum size of a program in bytes.
MAX_SHOWN_CHARACTERS = 32  # Number of characters before the first % that are shown.
_SEVEN_BIT_MASK = 0x7F
_CR, _LF, _TAB, _DC3 = 0x0D, 0x0A, 0x09, 0x13
_END_CODES = frozenset((0x04, 0x13, 0x14, 0x1A))  # EOT, DC3, DC4, ^Z: end of the sender's data.
# Leader, tape and flow control characters, and DEL.
_SKIPPED_CODES = bytes((0x00, 0x11, 0x12, 0x13, 0x14, 0x1A, 0x04, 0x7F))


class ReceptionPhase(StrEnum):
    """Phase of receiving a program."""

    WAITING = "waiting"  # Waiting for the first %.
    STORING = "storing"
    COMPLETE = "whole"


class IncompleteProgramError(DriverError):
    """Error raised if the received program is incomplete or invalid, so that nothing is saved."""


@dataclass(frozen=True, slots=True)
class ReceivedText:
    """A complete received program.

    ``program_name`` is empty if the program does not contain a name.
    """

    program_bytes: bytes
    program_name: str
    line_count: int
    sha256: str  # SHA-256
    is_seven_bit: bool  # Received with even parity through a line of eight bits.
    skipped_byte_count: int  # Number of characters before the first %.


class ProgramParser:
    """Parser of received characters.

    ``add_characters`` adds characters, ``handle_silence`` marks the end of the input, and ``build_program``
    returns the complete program. On a line with eight bits, the first % shows the encoding: 25 hex means
    eight bits, and A5 hex means seven bits with even parity.
    """

    def __init__(self, settings: TransferSettings) -> None:
        self._settings = settings
        self._wrap = settings.delimiter.encode("ascii")
        self._parity = PARITY_VALUES[settings.line_settings.parity] if settings.is_parity_checked else None
        self._raw = bytearray()  # Characters with parity bits, after the first %.
        self._skipped = 0
        self._before = bytearray()  # Last characters before the first %, without leaders.
        self._begins = 0  # Start of the present line.
        self._feeds = self._returns = 0
        self.phase = ReceptionPhase.WAITING
        self.character_count = 0  # Number of received characters.

    @property
    def leading_text(self) -> str:
        """Return the last characters before the first %, with codes for characters that are not text."""
        return "".join(self._told())

    @property
    def is_input_noise(self) -> bool:
        """Return whether over half of the characters stored from before the first % are not text.

        A character is text if it is printable or white space, as eight bits or as seven bits with parity.
        """
        return sum(len(one) > 1 for one in self._told()) * 2 > len(self._before)

    def _told(self) -> list[str]:
        parity = PARITY_VALUES["E"] if self._parity is None else self._parity
        return [_format_character(character, parity) for character in self._before]

    @property
    def line_count(self) -> int:
        """Return the number of received lines, including the line of the first %."""
        return self._feeds or self._returns

    def add_characters(self, received: bytes) -> None:
        """Add received characters.

        Raises IncompleteProgramError at the first parity error within the program, at an end code of the
        sender before the final %, and after more than 50 MB. ``build_program`` detects invalid control
        characters.
        """
        self.character_count += len(received)
        if self.character_count > MAX_PROGRAM_BYTES:
            raise IncompleteProgramError(
                "more than {largest} MB were received; the received data is not a program",
                largest=MAX_PROGRAM_BYTES // 1000000,
            )
        for character in received:
            if self.phase is ReceptionPhase.WAITING:
                self._wait(character)
            elif self.phase is ReceptionPhase.STORING:
                self._store(character)

    def handle_silence(self) -> None:
        """End the program after a silence, which marks the end of the input.

        A final % needs no line end. Raises IncompleteProgramError if the program has not begun or the final
        % is missing. Without a delimiter, no final % is required.
        """
        if self.phase is ReceptionPhase.COMPLETE:
            return
        if self.phase is ReceptionPhase.WAITING or (self._wrap and not self._is_at_end()):
            raise self._lacking()
        self.phase = ReceptionPhase.COMPLETE

    def build_program(self) -> ReceivedText:
        """Return the complete program.

        Raises IncompleteProgramError if its text is empty, contains an invalid control character, or
        contains more than one program.
        """
        raw = bytes(self._raw)
        seven = self._parity is not None or (not self._wrap and _has_even_parity(raw))
        text = bytes(character & _SEVEN_BIT_MASK for character in raw) if seven else raw
        head, lines = self._split_text(text.translate(None, _SKIPPED_CODES))
        for number, line in enumerate(lines, 1):
            self._check(line, number)
        whole = b"".join(line + b"\n" for line in lines)
        if not whole.strip():
            raise IncompleteProgramError(
                "the received program is empty; send the program again", reason="empty"
            )
        detected = seven and not self._settings.is_parity_checked
        digest = sha256(whole).hexdigest()
        return ReceivedText(
            whole, find_program_name(head, lines), len(lines), digest, detected, self._skipped
        )

    def _split_text(self, text: bytes) -> tuple[bytes, list[bytes]]:
        """Return the text after the first % on its line, and the lines of the program."""
        lines = split_lines(text)
        if not self._wrap:
            return b"", lines
        if lines and lines[-1].strip() == self._wrap:
            lines = lines[:-1]
        return lines[0] if lines else b"", lines[1:]

    def _check(self, line: bytes, number: int) -> None:
        if self._wrap and line.lstrip().startswith(self._wrap):
            raise IncompleteProgramError(
                "line {number} begins with {wrap}, so more than one program was received; send "
                "only one program",
                reason="several",
                number=number,
                wrap=self._settings.delimiter,
            )
        for character in line:
            if character < 0x20 and character != _TAB:
                raise IncompleteProgramError(
                    "line {number} contains the control character {character} because of "
                    "interference on the serial line. Nothing was saved; send the program again",
                    reason="control-character",
                    number=number,
                    character=f"{character:02X}",
                )

    def _wait(self, character: int) -> None:
        wrong = self._parity is not None and calculate_parity(character) != self._parity
        plain = character & _SEVEN_BIT_MASK
        begins = plain == self._wrap[0] if self._wrap else plain > 0x20 and plain != _SEVEN_BIT_MASK
        if wrong or not begins:
            self._skipped += 1
            if plain and plain != _SEVEN_BIT_MASK:
                self._before = (self._before + bytes([character]))[-MAX_SHOWN_CHARACTERS:]
            return
        self.phase = ReceptionPhase.STORING
        if not self._wrap:
            self._raw.append(character)
        elif character > _SEVEN_BIT_MASK:
            self._parity = PARITY_VALUES["E"]

    def _store(self, character: int) -> None:
        # A leader has no parity.
        if character and self._parity is not None and calculate_parity(character) != self._parity:
            self._handle_bad_parity(character)
            return
        plain = character if self._parity is None else character & _SEVEN_BIT_MASK
        if plain in _END_CODES or plain in {_CR, _LF}:
            if self._wrap and self._is_at_end():
                self.phase = ReceptionPhase.COMPLETE
                return
            if plain in _END_CODES:
                self._sender_ends(plain)
                return
            self._feeds, self._returns = self._feeds + (plain == _LF), self._returns + (plain == _CR)
            self._raw.append(character)
            self._begins = len(self._raw)
        else:
            self._raw.append(character)

    def _sender_ends(self, plain: int) -> None:
        if not self._wrap:
            self.phase = ReceptionPhase.COMPLETE
        elif plain != _DC3:  # DC3 may also be the XOFF of flow control that is not active here.
            raise self._lacking()

    def _handle_bad_parity(self, character: int) -> None:
        """Handle a parity error.

        In noise before an eight-bit program, a character may look like a % with parity. The parser then
        discards the received characters and waits for the first % again. Otherwise, it raises
        IncompleteProgramError.
        """
        if not self._settings.is_parity_checked and not self.line_count:
            self._skipped += len(self._raw) + 1
            self._raw.clear()
            self._parity, self.phase = None, ReceptionPhase.WAITING
            self._wait(character)
            return
        raise IncompleteProgramError(
            "parity error in line {lines}; nothing was saved. Check the serial port "
            "settings ({line}) and the shield and ground of the cable, then send the "
            "program again",
            reason="parity",
            lines=self.line_count,
            line=self._settings.line_settings.description,
        )

    def _is_at_end(self) -> bool:
        """Return whether the current line contains only the final %."""
        line = bytes(character & _SEVEN_BIT_MASK for character in self._raw[self._begins :])
        return bool(self._begins) and line.translate(None, _SKIPPED_CODES).strip() == self._wrap

    def _lacking(self) -> IncompleteProgramError:
        wrap = self._settings.delimiter
        if self.phase is ReceptionPhase.WAITING:
            came = (
                Message(
                    "{count} characters were received, but not the start character {wrap}",
                    count=self.character_count,
                    wrap=wrap,
                )
                if self.character_count
                else "nothing came"
            )
            return IncompleteProgramError(
                "{came}; check the serial port settings and the other device, then send the program again",
                reason="no-begin" if self.character_count else "nothing",
                came=came,
            )
        return IncompleteProgramError(
            "the end character {wrap} is missing after {lines} lines: the program is incomplete "
            "and was not saved; send the program again",
            reason="no-end",
            wrap=wrap,
            lines=self.line_count,
        )


def _format_character(character: int, parity: int) -> str:
    """Return a character if it is printable, otherwise its code.

    The character is read with eight bits, or with seven bits and the given parity.
    """
    plain = character & _SEVEN_BIT_MASK if calculate_parity(character) == parity else character
    if plain in {_CR, _LF, _TAB}:
        return " "
    return chr(plain) if 0x20 <= plain < _SEVEN_BIT_MASK else f"<{character:02X}>"


def _has_even_parity(raw: bytes) -> bool:
    """Return whether all characters have seven bits with even parity.

    At least one character must have the top bit set.
    """
    return any(character > _SEVEN_BIT_MASK for character in raw) and not any(
        calculate_parity(c) for c in raw if c
    )


# --- Sent bytes: leader, DC2, %, lines, %, DC4, trailer.


_LINE_END = re.compile(rb"\r\n|\r|\n")
_PARITY_BIT = 0x80


def encode_program(text: bytes, settings: TransferSettings) -> bytes:
    """Return the bytes that must be sent for a program.

    Raises DriverError if the program is empty, if a line begins with the delimiter, or if it contains
    characters that cannot be transferred.
    """
    eol, wrap = settings.line_end.encode("ascii"), settings.delimiter.encode("ascii")
    lines = _LINE_END.split(text.rstrip(b"\x1a\r\n"))
    if wrap:
        lines = _strip_framing(lines, wrap)
    if not any(line.strip() for line in lines):
        raise DriverError("the program is empty; there is nothing to send", reason="empty")
    for number, line in enumerate(lines, 1):
        _check(line, number, wrap, seven=settings.line_settings.data_bits == 7)
    framed = [wrap, *lines, wrap] if wrap else lines
    body = b"".join(line + eol for line in framed)
    nulls = bytes(settings.leader_nul_count)
    return nulls + (DC2 + body + DC4 if settings.has_dc_codes else body) + nulls


def _strip_framing(lines: list[bytes], wrap: bytes) -> list[bytes]:
    """Return the lines without the delimiters that the program already contains.

    Otherwise, the delimiters would be sent twice.
    """
    if lines and lines[0].strip() == wrap:
        lines = lines[1:]
    return lines[:-1] if lines and lines[-1].strip() == wrap else lines


def _check(line: bytes, number: int, wrap: bytes, *, seven: bool) -> None:
    if wrap and line.strip().startswith(wrap):
        raise DriverError(
            Message(
                "line {number} begins with {text}, which the other device would treat as the "
                "end of the program",
                number=number,
                text=wrap.decode(),
            ),
            reason="wrap",
        )
    for character in line:
        if character < 0x20 and character != 0x09:
            raise DriverError(
                "line {number} contains the control character {character}; remove this character",
                reason="control-character",
                number=number,
                character=f"{character:02X}",
            )
        if seven and character >= _PARITY_BIT:
            raise DriverError(
                "line {number} contains a character that 7 bits cannot represent; remove this "
                "character, or use 8 bits",
                reason="eighth-bit",
                number=number,
            )
