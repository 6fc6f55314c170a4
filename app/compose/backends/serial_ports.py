"""Serial ports. Loads pyserial, which is needed only for machines with a serial line."""

from __future__ import annotations

from core.ports import DriverError
from drivers.serial_line import FlowControlTransport, LineSettings

MISSING_LIBRARY_TEXT = "serial ports need pyserial; install it with: pip install pyserial"


def open_serial_port(settings: LineSettings, *, count_damaged: bool = False) -> FlowControlTransport:
    """Open a port exclusively; ``count_damaged`` counts damaged characters.

    Raises DriverError, which names a missing library.
    """
    try:
        from drivers.serial_port import SerialPort
    except ImportError as error:
        raise DriverError(MISSING_LIBRARY_TEXT) from error
    return SerialPort(settings, count_damaged=count_damaged)


def list_serial_ports() -> list[tuple[str, str]]:
    """Return device and description of each port of this computer. Raises DriverError."""
    try:
        from drivers.serial_port import list_ports
    except ImportError as error:
        raise DriverError(MISSING_LIBRARY_TEXT) from error
    return [(found.device, found.description) for found in list_ports()]
