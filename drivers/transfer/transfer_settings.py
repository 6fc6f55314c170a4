"""How a program goes over the line, beside the line's own settings."""

from __future__ import annotations

from dataclasses import dataclass, replace

from drivers.serial_line import PARITIES, LineSettings

DC1, DC2, DC3, DC4 = b"\x11", b"\x12", b"\x13", b"\x14"


@dataclass(frozen=True, slots=True)
class TransferSettings:
    """``wrap`` is the line before and behind a program; empty: none, and only silence tells the end.

    ``dc_codes``: DC2 before and DC4 behind what is sent, DC1 and DC3 around what is received. ``wait``: send
    only when the other side has said DC1. ``leader``: so many NULs before and behind.
    """

    line: LineSettings
    wrap: str = "%"
    eol: str = "\r\n"
    dc_codes: bool = False
    wait: bool = False
    leader: int = 0

    @property
    def own_parity(self) -> bool:
        """Seven bits and a parity bit look like eight bits on the line: every parity is checked here."""
        return self.line.bits == 7 and self.line.parity in PARITIES

    @property
    def sending(self) -> LineSettings:
        """The line as it is opened to send: a DC1 that is waited for must not be taken for flow control."""
        held = self.line.flow == "xonxoff" and self.wait
        return replace(self.line, flow="none") if held else self.line

    @property
    def receiving(self) -> LineSettings:
        """The line as it is opened to receive. Nothing is held up: what comes is read at once."""
        flow = "rtscts" if self.line.flow == "rtscts" else "none"
        if self.own_parity:
            return replace(self.line, bits=8, parity="N", flow=flow)
        return replace(self.line, flow=flow)
