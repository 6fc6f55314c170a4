"""Environment variables for Python processes that TurnDesk starts, such as the control process."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

_FOLDER = str(Path(__file__).parents[1])


def make_module_environment(**more: str) -> Mapping[str, str]:
    """Return environment variables with which ``python -m`` finds the modules of this TurnDesk first.

    An installed TurnDesk has its packages in a folder that is not in the module path of other Python
    processes.
    """
    path = os.environ.get("PYTHONPATH", "")
    return {**os.environ, **more, "PYTHONPATH": os.pathsep.join(filter(None, (_FOLDER, path)))}
