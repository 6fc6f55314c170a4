"""What ``turndesk machine check`` reports of the MTConnect adapter."""

from __future__ import annotations

from app.compose.backends.backend_entry import Answers, Row
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from app.extras.mtconnect.shop_floor import try_shop_floor
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError


def check_mtconnect(machine: Machine, answers: Answers) -> None:
    """Add whether agents would find the adapter, and accept its device model."""
    model = machine.hardware.table(MtconnectTable)
    if model is None or not model.enabled:
        return
    at = f"{model.bind}:{model.port}"
    try:
        try_shop_floor(machine, model)
    except DriverError as error:
        answers.rows.append(Row("mtconnect", at, "fault", str(error)))
        answers.trouble.append(str(error))
    else:
        answers.rows.append(Row("mtconnect", at, "ok", Message("device {device}", device=model.device)))
