"""Registration of the pendant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.compose.extra import Extra

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import Connected
    from core.machine.machine_model import Machine

_TABLE = "pendant"  # table whose presence loads the pendant


class Pendant(Extra):
    """Optional feature with the buttons and handwheel of a USB pendant, and the table [pendant]."""

    threads = {"pendant": "PENDANT CONNECTION"}
    machine_tables = {"app.extras.pendant.driver.pendant_table": ("pendant",)}
    tables_follow = "setter"

    def wired(self, machine: Machine) -> Machine:
        if _TABLE not in machine.hardware.tables:
            return machine
        from app.extras.pendant.pendant_wire import wired

        return wired(machine)

    def connect(self, machine: Machine, connected: Connected) -> Connected:
        if _TABLE not in machine.hardware.tables:
            return connected
        from app.extras.pendant.pendant_wire import with_pendant

        return with_pendant(machine, connected)


EXTRA = Pendant()
