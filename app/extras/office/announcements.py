"""What is told to others: the end of a part, a stop, an alarm, a tool at the end of its life."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from app.desk.background_work import RepeatingThread
from app.shopfloor.status_file import Status
from core.message import Message

LOOK = 0.5  # s
HELD = 100  # announcements that wait for somebody who does not answer; of more the oldest go
_STANDS = frozenset({"FEED HOLD", "PROGRAM STOP", "WAITING", "SINGLE BLOCK"})
_FAULTS = frozenset({"ALARM", "E-STOP", "CONTROL SILENT"})


@dataclass(frozen=True, slots=True)
class Announcement:
    """What has happened: ``part stop alarm tool-life`` or ``runs``, one sentence, the status."""

    kind: str
    text: str
    status: Status

    def json(self) -> bytes:
        """As it goes out: kind and text beside the keys of the status."""
        return json.dumps({"event": self.kind, "text": self.text, **self.status}).encode()


def happened(before: Mapping[str, Any], now: Status) -> Iterator[Announcement]:
    """What has happened between two looks; nothing before the first."""
    state, was = str(now["state"]), before.get("state")
    if was is None:
        return
    if _more(before.get("parts"), now.get("parts")):
        yield Announcement(
            "part",
            Message(
                "part {number} of {program} is finished", number=now.get("made"), program=now.get("program")
            ),
            now,
        )
    if now.get("next_barred") and not before.get("next_barred"):
        yield Announcement("tool-life", str(now["next_barred"]), now)
    if state != was:
        yield from _changed(str(was), state, now)


def _more(before: object, now: object) -> bool:
    """Of the parts since the start: the program's own count is also read from the store, or typed."""
    return isinstance(now, int) and isinstance(before, int) and now > before


def _changed(was: str, state: str, now: Status) -> Iterator[Announcement]:
    why = str(now.get("stop") or now.get("waiting_for") or "")
    text = Message("{state}: {why}", state=state, why=why) if why else state
    if state in _FAULTS:
        yield Announcement("alarm", text, now)
    elif state in _STANDS - {"WAITING"}:
        yield Announcement("stop", text, now)
    elif state == "RUNNING" and was != "WAITING":
        yield Announcement("runs", str(now.get("program") or state), now)


class Told(Protocol):
    """Somebody who is told. Neither call waits for the other side."""

    def state(self, status: Status) -> None:
        """How the machine stands now, whenever that has changed."""

    def tell(self, announcement: Announcement) -> None:
        """Something has happened."""

    def close(self) -> None:
        """The desk ends."""


class Announcer:
    """Looks at the status twice a second, by a thread of its own, and tells."""

    def __init__(self, look: Callable[[], Status], told: Sequence[Told]) -> None:
        self._look, self._told = look, told
        self._before: Status = {}
        self._thread = RepeatingThread("announcer", self.once, LOOK)

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def close(self) -> None:
        """Nobody is told any more; MQTT's own word for that goes out."""
        self._thread.close()
        for each in self._told:
            each.close()

    def once(self) -> None:
        """One look."""
        now = self._look()
        shown = {key: value for key, value in now.items() if key not in _ALWAYS_NEW}
        if shown != {key: value for key, value in self._before.items() if key not in _ALWAYS_NEW}:
            for told in self._told:
                told.state(now)
        for announcement in happened(self._before, now):
            for told in self._told:
                told.tell(announcement)
        parts = now.get("parts")  # of a silent control nobody knows them: what it made meanwhile is told then
        self._before = now if parts is not None else {**now, "parts": self._before.get("parts")}


_ALWAYS_NEW = frozenset({"updated", "line", "time_left", "cycle_elapsed", "spindle_load"})
