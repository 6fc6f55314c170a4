"""Registration of the office status page and of the announcements by MQTT and webhook."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Close, Extra, Tell

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import Answers
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from core.json_key import Output
    from core.machine.machine_model import Machine

_TABLES = frozenset({"status_page", "announce"})  # tables whose presence loads the office


class Office(Extra):
    """Optional feature with the office status page and announcements; tables [status_page] and [announce]."""

    threads = {
        "status-page": "STATUS PAGE",
        "announcer": "MQTT AND WEBHOOK",
        "paho-mqtt-client-": "MQTT BROKER CONNECTION",  # thread name used by paho
        "web-hook": "WEBHOOK",
    }
    machine_tables = {"core.extras.office.shop_network_tables": ("status_page", "announce")}
    tables_follow = "setter"

    def start(self, desk: Desk, journal: Journal, tell: Tell) -> Close | None:
        if desk.machine.model is None or _TABLES.isdisjoint(desk.machine.model.hardware.tables):
            return None
        from app.extras.office.office_desk import open_office

        return open_office(desk, desk.machine.model, journal, tell)

    def floor_outputs(self) -> Sequence[Output]:
        from app.extras.office.office_reference import OUTPUTS

        return OUTPUTS

    def check(self, machine: Machine, answers: Answers) -> None:
        if not _TABLES.isdisjoint(machine.hardware.tables):
            from app.extras.office.office_check import check_office

            check_office(machine, answers)


EXTRA = Office()
