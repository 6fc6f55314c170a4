"""Contents of a data folder, which a tour must not change."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from app.extras.tour.tour_setup import SHOWN_SETTING
from core.store.store import Store

_STORE_NAME = "turndesk.db"  # also the beginning of the names of its companion files


def read_contents(folder: Path) -> Mapping[str, object]:
    """Return everything of a data folder that an operator would miss, without the mark of the tour."""
    files = {str(path.relative_to(folder)) for path in folder.rglob("*")}
    with Store.open(folder, read_only=True) as store:
        settings = store.run_query(lambda each: each.execute("SELECT * FROM settings ORDER BY 1").fetchall())
        return {
            "files": {name for name in files if not name.startswith((_STORE_NAME, "turndesk.lock", "logs"))},
            "tools": store.offsets.tool_offsets.read_rows(),
            "secondary": store.offsets.secondary_offsets.read_rows(),
            "shapes": store.offsets.tool_shapes.read_rows(),
            "runs": store.runs.read_run_records(),
            "events": store.events.read_events("", 1000),
            "programs": store.programs.list_programs(),
            "settings": [tuple(row) for row in settings if row[0] != SHOWN_SETTING],
        }
