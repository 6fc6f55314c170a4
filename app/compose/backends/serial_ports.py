"""Serial ports. Loads pyserial, which is needed only for machines with a serial line."""

from __future__ import annotations

from core.ports import DriverError
from drivers.serial_line import FlowWire, LineSettings

MISSING = "serial ports need pyserial; install it with: pip install pyserial"


def open_wire(settings: LineSettings, *, watch: bool = False) -> FlowWire:
    """Open a port exclusively; ``watch`` counts damaged characters.

    Raises DriverError, which names a missing library.
    """
    try:
        from drivers.serial_port import SerialWire
    except ImportError as error:
        raise DriverError(MISSING) from error
    return SerialWire(settings, watch=watch)


def serial_ports() -> list[tuple[str, str]]:
    """Return device and description of each port of this computer. Raises DriverError."""
    try:
        from drivers.serial_port import list_ports
    except ImportError as error:
        raise DriverError(MISSING) from error
    return [(found.device, found.what) for found in list_ports()]
