"""Registration of users with access levels and PINs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Extra, Subcommand

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.background_work import Latest
    from app.desk.desk import Desk
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.json_key import Output
    from core.machine.machine_model import Machine
    from core.store.people import PersonRow
    from core.store.store import Store


class AccessByPin(Extra):
    """Optional feature with sign-in by PIN, ACCESS LEVELS in F10 and ``turndesk access``."""

    commands = {
        "access": Subcommand("store", "manage users, access levels and PINs"),
    }

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        from app.extras.access.sign_in import sign_in_of

        sign_in_of(desk.access)

    def special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: Latest
    ) -> Sequence[tuple[SpecialFunction, str]]:
        from app.extras.access.access_levels import AccessLevels
        from app.extras.access.sign_in import sign_in_of

        return ((AccessLevels(desk, persistence, sign_in_of(desk.access)), "LAMPS AND SOUND"),)

    def demand_pin(self, store: Store, row: PersonRow, remedy: str) -> bool:
        from app.extras.access.access_command import demand_pin

        demand_pin(store, row, remedy)
        return True

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.access.access_command import OUTPUTS

        return OUTPUTS


EXTRA = AccessByPin()
