"""Check of the shared location, which adds a row to ``turndesk machine check``."""

from __future__ import annotations

from app.compose.backends.backend_entry import MachineCheckResults, MachineCheckRow
from app.extras.sharing.sharing_setup import make_shared_location
from core.extras.sharing.shared_location import SharingError
from core.extras.sharing.sharing_table import SharingTable
from core.machine.machine_model import Machine


def add_sharing_check_row(machine: Machine, results: MachineCheckResults) -> None:
    """Add a row that shows whether the shared location responds and is set up for sharing."""
    table = machine.hardware.find_driver_table(SharingTable)
    if table is None:
        return
    place = make_shared_location(table)
    try:
        found = place.read_contents({})
    except SharingError as error:
        results.rows.append(MachineCheckRow("sharing", place.name, "no answer", str(error)))
        results.faults.append(str(error))
    else:
        desks = ", ".join(sorted(each.machine_name for each in found.machine_states)) or (
            "no control shares programs yet"
        )
        results.rows.append(MachineCheckRow("sharing", place.name, "ok", desks))
