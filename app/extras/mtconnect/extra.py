"""Registration of the MTConnect adapter."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.compose.extra import Close, Extra, Tell

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import Answers
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from core.executor.snapshot import Snapshot
    from core.machine.machine_model import Machine

_TABLE = "mtconnect"  # table whose presence loads the adapter


class Mtconnect(Extra):
    """Optional feature with the MTConnect adapter and ``turndesk machine mtconnect``."""

    machine_actions = ("mtconnect",)
    threads = {"mtconnect": "MTCONNECT"}
    machine_tables = {"app.extras.mtconnect.driver.mtconnect_table": ("mtconnect",)}
    tables_follow = "setter"

    def start(self, desk: Desk, journal: Journal, tell: Tell) -> Close | None:
        if desk.machine.model is None or _TABLE not in desk.machine.model.hardware.tables:
            return None
        from app.extras.mtconnect.shop_floor import open_shop_floor

        return open_shop_floor(desk.machine.model, desk.snapshot, tell)

    def start_headless(
        self, machine: Machine, snapshot: Callable[[], Snapshot], tell: Tell, *, paced: bool
    ) -> Close | None:
        if _TABLE not in machine.hardware.tables:
            return None
        from app.extras.mtconnect.shop_floor import open_headless

        return open_headless(machine, snapshot, tell, paced=paced)

    def check(self, machine: Machine, answers: Answers) -> None:
        if _TABLE in machine.hardware.tables:
            from app.extras.mtconnect.mtconnect_command import check_mtconnect

            check_mtconnect(machine, answers)


EXTRA = Mtconnect()
