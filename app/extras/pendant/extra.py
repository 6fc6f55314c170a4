"""Registration of the pendant."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Extra

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import Connected
    from core.machine.machine_model import Machine
    from core.table_schema import Driver

_TABLE = "pendant"  # table whose presence loads the pendant


class Pendant(Extra):
    """Optional feature with the buttons and handwheel of a USB pendant, and the table [pendant]."""

    threads = {"pendant": "PENDANT CONNECTION"}
    tables_follow = "setter"

    def machine_tables(self) -> Sequence[Driver]:
        from app.extras.pendant.driver.pendant_table import DRIVER

        return (DRIVER,)

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
