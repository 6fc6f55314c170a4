"""Registration of the optional feature that imports tool tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from core.json_keys import JsonOutput


class ToolTablesExtra(OptionalFeature):
    """Optional feature with the command ``turndesk tools``."""

    subcommands = {
        "tools": Subcommand("offsets", "import and export the tool tables of other programs"),
    }

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON output of the tool table import for the reference page."""
        from app.extras.tool_tables.import_command import IMPORT_OUTPUT

        return {"offsets history --json": (IMPORT_OUTPUT,)}


EXTRA = ToolTablesExtra()
