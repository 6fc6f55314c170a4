"""Interface through which the screen uses the control, in the same process or in another process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.station_controls import StationPanel
from app.desk.status.machine_status import ControlSilenceDetector
from core.executor.commands import Command
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.desk.stop_keys.key_watcher_client import OpenStopChannel
    from core.records.recordings import ScopeRecordings


@dataclass(slots=True)
class DeskControl:
    """Access of the screen to the commands, the snapshots and the simulated station of the control.

    - ``station_panel`` is None if the machine has its own operator station.
    - ``set_input`` switches an input of a simulated machine.
    - ``recordings`` contains the last minutes of samples, or is None if there is no recorder.
    - ``open_stop_channel`` opens a connection that sends stop keys to the control, bypassing the screen.
    - ``restart_control`` replaces a control that does not respond, or is None if this is not possible.
    - ``report_event`` adds an event of the screen to the event log, with its kind and text.
    - ``read_control_identity`` returns the identity of a control process, or an empty string for a control
      in this process.
    """

    post: Callable[[Command], None]
    read_snapshot: Callable[[], Snapshot]
    station_panel: StationPanel | None = None
    set_input: Callable[[str, bool], None] | None = None
    warnings: Sequence[str] = ()
    recordings: ScopeRecordings | None = None
    open_stop_channel: OpenStopChannel = lambda: None
    restart_control: Callable[[], object] | None = None
    read_control_identity: Callable[[], str] = str
    report_event: Callable[[str, str], None] = lambda _kind, _text: None
    silence_watch: ControlSilenceDetector = field(default_factory=ControlSilenceDetector)
