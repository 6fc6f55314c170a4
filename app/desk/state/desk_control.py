"""The control as the desk uses it, in this process or in a process of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.station_hands import StationPanel
from app.desk.status.machine_status import SilenceWatch
from core.executor.commands import Command
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.desk.stop_keys.watched_keys import OpenLine
    from core.records.recordings import Recordings


@dataclass(slots=True)
class DeskControl:
    """Commands to the control, its snapshots, and its station where that is on the screen.

    ``panel`` is None where the machine has its own operator station. ``set_input`` switches an input of a
    simulated machine. ``recordings`` are the last minutes of samples, None without a recorder.
    ``open_stop_line`` opens the connection that sends stop keys to the control, past the screen.
    """

    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    panel: StationPanel | None = None
    set_input: Callable[[str, bool], None] | None = None
    warnings: Sequence[str] = ()
    recordings: Recordings | None = None
    open_stop_line: OpenLine = lambda: None
    silence: SilenceWatch = field(default_factory=SilenceWatch)
