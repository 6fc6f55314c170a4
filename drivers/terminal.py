"""Settings of a line that a POSIX terminal does itself; some adapters, and ptys, drop them silently."""

from __future__ import annotations

import errno
import sys

if sys.platform != "win32":
    import termios

    _SIZES = {7: termios.CS7, 8: termios.CS8}
    _PARITIES = {"N": 0, "E": termios.PARENB, "O": termios.PARENB | termios.PARODD}
    _FRAME = termios.CSIZE | termios.PARENB | termios.PARODD

    def frame(handle: int, bits: int, parity: str) -> bool:
        """Set bits and parity; whether the port keeps them. Raises termios.error."""
        wanted = _SIZES[bits] | _PARITIES[parity]
        attributes = termios.tcgetattr(handle)
        attributes[2] = attributes[2] & ~_FRAME | wanted
        try:
            termios.tcsetattr(handle, termios.TCSANOW, attributes)
        except termios.error as error:
            if error.args[0] != errno.EINVAL:  # the C library, of a port that keeps none of it
                raise
        return bool(termios.tcgetattr(handle)[2] & _FRAME == wanted)

    def obey_codes(handle: int) -> None:
        """XOFF and XON hold and release what is sent, in the kernel. Raises termios.error."""
        attributes = termios.tcgetattr(handle)
        attributes[0] |= termios.IXON | termios.IXOFF
        termios.tcsetattr(handle, termios.TCSANOW, attributes)

    def mark_damage(handle: int, *, parity: bool) -> None:
        """Damaged characters come as FF 00 and the character, FF as FF FF. Raises termios.error."""
        attributes = termios.tcgetattr(handle)
        attributes[0] |= termios.PARMRK | (termios.INPCK if parity else 0)
        attributes[0] &= ~(termios.IGNPAR | termios.ISTRIP)
        termios.tcsetattr(handle, termios.TCSANOW, attributes)
