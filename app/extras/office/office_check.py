"""Rows of ``turndesk machine check`` for the status page and the MQTT broker."""

from __future__ import annotations

import socket

from app.compose.backends.backend_entry import Answers, Row
from app.extras.office.page_server import listening_at
from core.extras.office.shop_network_tables import AnnounceTable, StatusPageTable, broker_of
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError

_BROKER_PATIENCE = 2.0  # seconds


def check_office(machine: Machine, answers: Answers) -> None:
    """Add rows that show whether the status page can be opened and the broker responds."""
    page, told = machine.hardware.table(StatusPageTable), machine.hardware.table(AnnounceTable)
    if page is not None and page.enabled:
        try:
            listening_at(page.bind, page.port).close()
        except DriverError as error:
            answers.rows.append(Row("status_page", f"{page.bind}:{page.port}", "fault", str(error)))
            answers.trouble.append(str(error))
        else:
            who = (
                "the status page can be opened only with its token"
                if page.token
                else ("the status page can be opened only from this computer")
            )
            answers.rows.append(Row("status_page", f"{page.bind}:{page.port}", "ok", who))
    if told is not None and told.mqtt:
        try:
            socket.create_connection(broker_of(told.mqtt), _BROKER_PATIENCE).close()
        except OSError as error:
            why = Message(
                "[announce] {mqtt}: {cause}; check the address and port of the broker",
                mqtt=told.mqtt,
                cause=error.strerror or error,
            )
            answers.rows.append(Row("announce", told.mqtt, "no answer", why))
            answers.trouble.append(why)
        else:
            answers.rows.append(Row("announce", told.mqtt, "ok", told.topic))
