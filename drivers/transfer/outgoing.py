"""What goes out for a program: leader, DC2, %, lines, %, DC4, trailer."""

from __future__ import annotations

import re

from core.ports import DriverError
from drivers.transfer.settings import DC2, DC4, TransferSettings

_LINE_END = re.compile(rb"\r\n|\r|\n")
_TOP = 0x80


def outgoing(text: bytes, settings: TransferSettings) -> bytes:
    """The bytes for the line. Raises DriverError for what would not arrive as it is."""
    eol, wrap = settings.eol.encode("ascii"), settings.wrap.encode("ascii")
    lines = _LINE_END.split(text.rstrip(b"\x1a\r\n"))
    if wrap:
        lines = _bare(lines, wrap)
    if not any(line.strip() for line in lines):
        raise DriverError("the program is empty: there is nothing to send")
    for number, line in enumerate(lines, 1):
        _check(line, number, wrap, seven=settings.line.bits == 7)
    framed = [wrap, *lines, wrap] if wrap else lines
    body = b"".join(line + eol for line in framed)
    nulls = bytes(settings.leader)
    return nulls + (DC2 + body + DC4 if settings.dc_codes else body) + nulls


def _bare(lines: list[bytes], wrap: bytes) -> list[bytes]:
    """Without a frame of its own: it would be there twice."""
    if lines and lines[0].strip() == wrap:
        lines = lines[1:]
    return lines[:-1] if lines and lines[-1].strip() == wrap else lines


def _check(line: bytes, number: int, wrap: bytes, *, seven: bool) -> None:
    if wrap and line.strip().startswith(wrap):
        raise DriverError(
            f"line {number} begins with {wrap.decode()}: the other side would take it for the end"
        )
    for character in line:
        if character < 0x20 and character != 0x09:
            raise DriverError(f"line {number} holds the control character {character:02X}; take it out")
        if seven and character >= _TOP:
            raise DriverError(
                f"line {number} holds a letter that 7 bits cannot carry; take it out, or use 8 bits"
            )
