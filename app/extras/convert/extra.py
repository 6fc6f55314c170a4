"""Registration of the optional feature that converts programs of other controls."""

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


class ConvertExtra(OptionalFeature):
    """Optional feature with the command ``turndesk convert`` and the special function CONVERT PROGRAM."""

    subcommands = {
        "convert": Subcommand("serial", "convert a turning program from or to another control"),
    }

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Attach the conversion of loaded, listed and edited programs of other controls."""
        from app.extras.convert.convert_function import RecognitionNotice, make_program_conversion

        if has_conversions(machine):
            desk.page_registry.add_frame_watcher(RecognitionNotice(desk).observe_frame)
            desk.page_registry.program_conversion = make_program_conversion(desk)

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the special function CONVERT PROGRAM of a lathe.

        The function is paired with ACCESS LEVELS, after which it is listed.
        """
        from app.compose.machine.machine_setup import get_control_limits
        from app.extras.convert.convert_function import ConvertFunction

        if not has_conversions(machine):
            return ()
        return ((ConvertFunction(desk, machine, get_control_limits(machine), worker), "ACCESS LEVELS"),)

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk convert`` for the reference page."""
        from app.extras.convert.convert_command import OUTPUTS

        return {"access table --json": OUTPUTS}


def has_conversions(machine: Machine) -> bool:
    """Return whether programs can be converted on the screen of this machine, which must be a lathe."""
    from core.language.source import Dialect

    return machine.kind == "lathe" and machine.mdi_language in {Dialect.OMNITURN, Dialect.SINUMERIK}


EXTRA = ConvertExtra()
