"""What the office and a telephone see of a desk: status.json with state, times, last stops and last alarm."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime

from app.shopfloor.floor_reading import FloorReader
from app.shopfloor.status_file import Status, status_of
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.production.part_cycles import StopRow

STOPS = 6  # the newest


@dataclass(frozen=True, slots=True)
class OfficeLook:
    """Looks at what the desk publishes; from any thread. ``time_left`` is in s, infinite while it stands."""

    machine: str
    reader: FloorReader
    snapshot: Callable[[], Snapshot]
    time_left: Callable[[Snapshot], float]
    stops: Callable[[], Sequence[StopRow]]
    utc: Callable[[], datetime]

    def status(self) -> Status:
        """The keys of status.json and those of the page; seconds, ``None`` for what is not known."""
        snapshot = self.snapshot()
        reading = self.reader.look(snapshot)
        told = {"updated": self.utc().isoformat(timespec="seconds"), **status_of(self.machine, reading)}
        if not reading.available:
            return {**told, **_NOTHING_KNOWN}
        left = self.time_left(snapshot)
        newest = self.stops()[::-1][:STOPS]  # as they came: the clock may have been set back
        return {
            **told,
            "state": snapshot.state.value,
            "waiting_for": snapshot.waiting_for,
            "line": snapshot.line or None,
            "made": snapshot.made,
            "time_left": round(left, 1) if math.isfinite(left) and snapshot.counts else None,
            "cycle_elapsed": round(snapshot.cycle_elapsed, 1),
            "last_cycle": round(snapshot.last_cycle, 1) or None,
            "stop": _words(snapshot),
            "next_barred": snapshot.next_barred,
            "stops": [{"at": row.at, "reason": row.reason, "seconds": round(row.seconds)} for row in newest],
        }


_NOTHING_KNOWN: Status = {
    "state": "CONTROL SILENT",
    "waiting_for": "",
    "line": None,
    "made": None,
    "time_left": None,
    "cycle_elapsed": None,
    "last_cycle": None,
    "stop": "",
    "next_barred": "",
    "stops": [],
}


def _words(snapshot: Snapshot) -> str:
    """Why it stands, in the words of the screen."""
    if snapshot.alarms:
        return Message("{alarms}: {cause}", alarms=snapshot.alarms[0].text, cause=snapshot.alarms[0].cause)
    if snapshot.message:
        return snapshot.message
    told = snapshot.stop.text if snapshot.stop is not None else ""
    return "" if told == snapshot.state.value else told
