"""Registration of the conversion of programs of other controls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Extra, Subcommand

if TYPE_CHECKING:
    from core.json_key import Output


class Convert(Extra):
    """Optional feature with ``turndesk convert``."""

    commands = {
        "convert": Subcommand("serial", "convert a turning program of another control to OmniTurn"),
    }

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.convert.convert_command import OUTPUTS

        return {"access table --json": OUTPUTS}


EXTRA = Convert()
