"""What ``turndesk machine mtconnect`` does: the device model for an MTConnect agent."""

from __future__ import annotations

import sys
from datetime import UTC, datetime

from app.cli.errors import EXIT_OK, CommandError
from app.compose.machine import read_machine
from core.ports import DriverError


def write_model(file: str) -> int:
    """Writes ``Devices.xml`` of a machine file to stdout. Raises CommandError."""
    from app.compose.shop_floor import device_model

    machine = read_machine(file)
    try:
        sys.stdout.write(device_model(machine, datetime.now(UTC)))
    except DriverError as error:
        raise CommandError(str(error)) from error
    model = machine.hardware.mtconnect
    if model is not None and not model.enabled:
        sys.stderr.write(f"turndesk: {file}: [mtconnect] enabled = false: no agent will find the adapter\n")
    return EXIT_OK
