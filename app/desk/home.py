"""Where this installation keeps what it must remember."""

from __future__ import annotations

import os
from pathlib import Path

from platformdirs import user_data_path


def home() -> Path:
    """The folder of store, logs and settings: ``TURNDESK_HOME``, else the platform's data folder."""
    named = os.environ.get("TURNDESK_HOME", "")
    if named:
        return Path(named).expanduser().absolute()
    return user_data_path("turndesk", appauthor=False)
