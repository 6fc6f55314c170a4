"""Registration of the optional feature that adds users with access levels and PINs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.background_work import LatestRequestWorker
    from app.desk.desk import Desk
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine
    from core.store.store import Store
    from core.store.user_records import UserRow


class AccessExtra(OptionalFeature):
    """Optional feature with sign-in by PIN, ACCESS LEVELS in the F10 list, and ``turndesk access``."""

    subcommands = {
        "access": Subcommand("store", "manage users, access levels and PINs"),
    }

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Create the PIN sign-in, and attach it to the user access of TurnDesk."""
        from app.extras.access.sign_in import get_pin_sign_in

        get_pin_sign_in(desk.user_access)

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the ACCESS LEVELS function, paired with the function that it follows in the F10 list."""
        from app.extras.access.access_levels import AccessLevelsFunction
        from app.extras.access.sign_in import get_pin_sign_in

        return (
            (AccessLevelsFunction(desk, persistence, get_pin_sign_in(desk.user_access)), "LAMPS AND SOUND"),
        )

    def require_pin(self, store: Store, user_row: UserRow, remedy: str) -> bool:
        """Ask for the user's PIN on the command line. Return True because this feature supports PINs.

        ``remedy`` is the instruction for a user without a PIN. Raises CommandError if no PIN is stored or
        the PIN is wrong.
        """
        from app.extras.access.access_command import require_pin

        require_pin(store, user_row, remedy)
        return True

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk access`` for the reference page."""
        from app.extras.access.access_command import OUTPUTS

        return OUTPUTS


EXTRA = AccessExtra()
