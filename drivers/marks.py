"""What a POSIX terminal makes of damaged characters when told to mark them (PARMRK)."""

from __future__ import annotations


class Unmarker:
    """Takes the marks out and counts them: FF 00 c is a damaged c, FF FF a good FF."""

    def __init__(self) -> None:
        self.damaged = 0
        self._rest = b""

    def feed(self, come: bytes) -> bytes:
        """The characters as they were meant; a damaged one as it came."""
        data, out = self._rest + come, bytearray()
        at = 0
        while at < len(data):
            if data[at] != 0xFF:
                out.append(data[at])
                at += 1
            elif data[at + 1 : at + 2] == b"\xff":
                out.append(0xFF)
                at += 2
            elif len(data) - at >= 3:
                self.damaged += 1
                out.append(data[at + 2])
                at += 3
            else:
                break
        self._rest = data[at:]
        return bytes(out)
