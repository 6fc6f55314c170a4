"""Serial ports. Loads pyserial, which a machine without a serial line need not have."""

from __future__ import annotations

from core.ports import DriverError
from drivers.serial_line import FlowWire, LineSettings

MISSING = "serial ports need pyserial; install it with: pip install pyserial"


def open_wire(settings: LineSettings, *, watch: bool = False) -> FlowWire:
    """A port for us alone; ``watch`` counts damaged characters.

    Raises DriverError; it names the library where that is missing.
    """
    try:
        from drivers.serial_port import SerialWire
    except ImportError as error:
        raise DriverError(MISSING) from error
    return SerialWire(settings, watch=watch)


def serial_ports() -> list[tuple[str, str]]:
    """(device, what it is) of each port of this computer. Raises DriverError."""
    try:
        from drivers.serial_port import list_ports
    except ImportError as error:
        raise DriverError(MISSING) from error
    return [(found.device, found.what) for found in list_ports()]
