"""Check of the status page and the MQTT broker for ``turndesk machine check``."""

from __future__ import annotations

import socket

from app.compose.backends.backend_entry import MachineCheckResults, MachineCheckRow
from app.extras.office.page_server import open_listening_socket
from core.extras.office.shop_network_tables import AnnounceTable, StatusPageTable, parse_broker_address
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError

_BROKER_PATIENCE = 2.0  # seconds


def add_office_check_rows(machine: Machine, results: MachineCheckResults) -> None:
    """Add check rows that show whether the status page can be opened and the MQTT broker responds."""
    page, announce_table = (
        machine.hardware.find_driver_table(StatusPageTable),
        machine.hardware.find_driver_table(AnnounceTable),
    )
    if page is not None and page.enabled:
        try:
            open_listening_socket(page.bind, page.port).close()
        except DriverError as error:
            results.rows.append(
                MachineCheckRow("status_page", f"{page.bind}:{page.port}", "fault", str(error))
            )
            results.faults.append(str(error))
        else:
            who = (
                "the status page can be opened only with its token"
                if page.token
                else ("the status page can be opened only from this computer")
            )
            results.rows.append(MachineCheckRow("status_page", f"{page.bind}:{page.port}", "ok", who))
    if announce_table is not None and announce_table.mqtt:
        try:
            socket.create_connection(parse_broker_address(announce_table.mqtt), _BROKER_PATIENCE).close()
        except OSError as error:
            why = Message(
                "[announce] {mqtt}: {cause}; check the address and port of the broker",
                mqtt=announce_table.mqtt,
                cause=error.strerror or error,
            )
            results.rows.append(MachineCheckRow("announce", announce_table.mqtt, "no answer", why))
            results.faults.append(why)
        else:
            results.rows.append(MachineCheckRow("announce", announce_table.mqtt, "ok", announce_table.topic))
