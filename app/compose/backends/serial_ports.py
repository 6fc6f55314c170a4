"""Access to serial ports through pyserial, which is loaded only for machines with a serial line."""

from __future__ import annotations

from core.ports import DriverError
from drivers.serial_line import FlowControlTransport, LineSettings

MISSING_LIBRARY_TEXT = "serial ports need pyserial; install it with: pip install pyserial"


def open_serial_port(settings: LineSettings, *, count_damaged: bool = False) -> FlowControlTransport:
    """Open a serial port for exclusive use.

    ``count_damaged`` makes the port count damaged characters. Raises DriverError if the port cannot be
    opened or pyserial is missing.
    """
    try:
        from drivers.serial_port import SerialPort
    except ImportError as error:
        raise DriverError(MISSING_LIBRARY_TEXT) from error
    return SerialPort(settings, count_damaged=count_damaged)


def list_serial_ports() -> list[tuple[str, str]]:
    """Return the device and the description of each serial port.

    Raises DriverError if pyserial is missing.
    """
    try:
        from drivers.serial_port import list_serial_ports
    except ImportError as error:
        raise DriverError(MISSING_LIBRARY_TEXT) from error
    return [(found.device_name, found.description) for found in list_serial_ports()]
