"""Registration of the optional feature with the MTConnect adapter."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.compose.optional_features import CloseFunction, OptionalFeature, ReportFunction

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import MachineCheckResults
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from core.executor.snapshot import Snapshot
    from core.machine.machine_model import Machine

_TABLE = "mtconnect"  # table whose presence loads the adapter


class MtconnectExtra(OptionalFeature):
    """Optional feature with the MTConnect adapter and the command ``turndesk machine mtconnect``."""

    machine_actions = ("mtconnect",)
    supervised_threads = {"mtconnect": "MTCONNECT"}
    machine_tables = {"app.extras.mtconnect.driver.mtconnect_table": ("mtconnect",)}
    preceding_table = "setter"

    def start_services(
        self, desk: Desk, journal: Journal, report_reason: ReportFunction
    ) -> CloseFunction | None:
        """Start the MTConnect adapter, and return the function that stops it.

        The result is None if the machine file has no [mtconnect] table or the adapter cannot run. If the
        adapter cannot run, ``report_reason`` receives the reason.
        """
        if desk.machine.machine is None or _TABLE not in desk.machine.machine.hardware.tables:
            return None
        from app.extras.mtconnect.adapter_setup import start_adapter

        return start_adapter(desk.machine.machine, desk.read_snapshot, report_reason)

    def start_headless_services(
        self,
        machine: Machine,
        read_snapshot: Callable[[], Snapshot],
        report_reason: ReportFunction,
        *,
        is_real_time: bool,
    ) -> CloseFunction | None:
        """Start the adapter for a run without a screen, and return the function that stops the adapter.

        The result is None if the machine file has no [mtconnect] table or if the adapter does not start. A
        run that is faster than real time is not reported, and ``report_reason`` receives the reason.
        """
        if _TABLE not in machine.hardware.tables:
            return None
        from app.extras.mtconnect.adapter_setup import start_headless_adapter

        return start_headless_adapter(machine, read_snapshot, report_reason, is_real_time=is_real_time)

    def add_check_rows(self, machine: Machine, results: MachineCheckResults) -> None:
        """Add a row that shows whether MTConnect agents can connect and the device model is valid.

        No row is added if the machine file has no [mtconnect] table.
        """
        if _TABLE in machine.hardware.tables:
            from app.extras.mtconnect.mtconnect_command import add_mtconnect_check_row

            add_mtconnect_check_row(machine, results)


EXTRA = MtconnectExtra()
