"""Command ``turndesk machine mtconnect``, which prints the device model.

The module also adds a row for the adapter to ``turndesk machine check``.
"""

from __future__ import annotations

import argparse
import sys
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from app.desk.command_errors import EXIT_OK, convert_to_command_error
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.compose.backends.backend_entry import MachineCheckResults
    from core.machine.machine_model import Machine


def add_parser(actions: SubParsers) -> None:
    """Add the action ``mtconnect`` to the command ``turndesk machine``."""
    model = actions.add_parser(
        "mtconnect", help="print the device model (Devices.xml) for an MTConnect agent"
    )
    model.add_argument("file", metavar="FILE")


def run(args: argparse.Namespace) -> int:
    """Write ``Devices.xml`` for a machine file to stdout.

    Raises CommandError if the machine file or the device model is invalid.
    """
    from app.compose.machine.machine_setup import read_machine
    from app.extras.mtconnect.adapter_setup import is_adapter_enabled, make_devices_document
    from core.ports import DriverError

    file = args.file
    machine = read_machine(file)
    with convert_to_command_error(DriverError):
        sys.stdout.write(make_devices_document(machine, datetime.now(UTC)))
    if not is_adapter_enabled(machine):
        sys.stderr.write(f"turndesk: {file}: [mtconnect] enabled = false, so no agent can find the adapter\n")
    return EXIT_OK


def add_mtconnect_check_row(machine: Machine, results: MachineCheckResults) -> None:
    """Add a check row that shows whether agents can connect and whether the device model is valid."""
    from app.compose.backends.backend_entry import MachineCheckRow
    from app.extras.mtconnect.adapter_setup import check_adapter
    from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
    from core.ports import DriverError

    model = machine.hardware.find_driver_table(MtconnectTable)
    if model is None or not model.enabled:
        return
    at = f"{model.bind}:{model.port}"
    try:
        check_adapter(machine, model)
    except DriverError as error:
        results.rows.append(MachineCheckRow("mtconnect", at, "fault", str(error)))
        results.faults.append(str(error))
    else:
        results.rows.append(
            MachineCheckRow("mtconnect", at, "ok", Message("device {device}", device=model.device))
        )
