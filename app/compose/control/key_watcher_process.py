"""Key watcher process for the stop keys, with real-time priority if the system grants it.

The command is ``python -m app.compose.control.key_watcher_process LINE SCREEN``. The module
``app.desk.stop_keys.key_watcher`` describes the arguments.
"""

from __future__ import annotations

import sys

from app.desk.stop_keys import key_watcher
from drivers.process_rights import request_scheduling_policy

REAL_TIME_PRIORITY = 30  # priority of SCHED_RR, below that of the control, which acts on the stop keys


def main(arguments: list[str]) -> int:
    """Watch the stop keys, and return the exit status of the process."""
    request_scheduling_policy("SCHED_RR", REAL_TIME_PRIORITY)
    return key_watcher.main(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
