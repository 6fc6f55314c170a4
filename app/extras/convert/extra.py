"""Registration of the optional feature that converts programs of other controls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from core.json_keys import JsonOutput


class ConvertExtra(OptionalFeature):
    """Optional feature with the command ``turndesk convert``."""

    subcommands = {
        "convert": Subcommand("serial", "convert a turning program of another control to OmniTurn"),
    }

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk convert``.

        The reference lists them after ``access table --json``.
        """
        from app.extras.convert.convert_command import OUTPUTS

        return {"access table --json": OUTPUTS}


EXTRA = ConvertExtra()
