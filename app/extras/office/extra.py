"""Registration of the optional feature with the office status page and announcements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import CloseFunction, OptionalFeature, ReportFunction

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import MachineCheckResults
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine

_TABLES = frozenset({"status_page", "announce"})  # tables whose presence loads the office


class OfficeExtra(OptionalFeature):
    """Optional feature with the office status page and announcements.

    The feature declares the machine file tables [status_page] and [announce].
    """

    supervised_threads = {
        "status-page": "STATUS PAGE",
        "announcer": "MQTT AND WEBHOOK",
        "paho-mqtt-client-": "MQTT BROKER CONNECTION",  # thread name used by paho
        "web-hook": "WEBHOOK",
    }
    machine_tables = {"core.extras.office.shop_network_tables": ("status_page", "announce")}
    preceding_table = "setter"

    def start_services(
        self, desk: Desk, journal: Journal, report_reason: ReportFunction
    ) -> CloseFunction | None:
        """Start the status page and the announcements, and return the function that stops them.

        The result is None if the machine file has neither a [status_page] table nor an [announce] table.
        ``report_reason`` shows an error if one of the services fails.
        """
        if desk.machine.machine is None or _TABLES.isdisjoint(desk.machine.machine.hardware.tables):
            return None
        from app.extras.office.office_setup import start_office_services

        return start_office_services(desk, desk.machine.machine, journal, report_reason)

    def list_shop_outputs(self) -> Sequence[JsonOutput]:
        """Return declarations of the data on the office status page and in announcements."""
        from app.extras.office.office_reference import OUTPUTS

        return OUTPUTS

    def add_check_rows(self, machine: Machine, results: MachineCheckResults) -> None:
        """Add rows that show whether the status page can be opened and the MQTT broker responds.

        No row is added if the machine file has neither a [status_page] table nor an [announce] table.
        """
        if not _TABLES.isdisjoint(machine.hardware.tables):
            from app.extras.office.office_check import add_office_check_rows

            add_office_check_rows(machine, results)


EXTRA = OfficeExtra()
