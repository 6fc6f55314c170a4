"""Registration of the optional feature for a USB pendant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import ConnectedMachine
    from core.machine.machine_model import Machine

_TABLE = "pendant"  # table whose presence loads the pendant


class PendantExtra(OptionalFeature):
    """Optional feature with the buttons and handwheel of a USB pendant, and the table [pendant]."""

    supervised_threads = {"pendant": "PENDANT CONNECTION"}
    machine_tables = {"app.extras.pendant.driver.pendant_table": ("pendant",)}
    preceding_table = "setter"

    def remove_own_inputs(self, machine: Machine) -> Machine:
        """Return the machine without the inputs and the handwheel of the pendant.

        If the machine file has no [pendant] table, the machine is returned unchanged.
        """
        if _TABLE not in machine.hardware.tables:
            return machine
        from app.extras.pendant.pendant_setup import remove_pendant

        return remove_pendant(machine)

    def add_ports(self, machine: Machine, connected: ConnectedMachine) -> ConnectedMachine:
        """Return the connected machine with the ports of its pendant added.

        If the machine file has no [pendant] table, the machine is returned unchanged.
        """
        if _TABLE not in machine.hardware.tables:
            return connected
        from app.extras.pendant.pendant_setup import add_pendant

        return add_pendant(machine, connected)


EXTRA = PendantExtra()
