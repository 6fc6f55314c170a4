"""Registration of the import and export of tool tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Extra, Subcommand

if TYPE_CHECKING:
    from core.json_key import Output


class ToolTables(Extra):
    """Optional feature with the command ``turndesk tools``."""

    commands = {
        "tools": Subcommand("offsets", "import and export the tool tables of other programs"),
    }

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.tool_tables.import_command import IMPORT

        return {"offsets history --json": (IMPORT,)}


EXTRA = ToolTables()
