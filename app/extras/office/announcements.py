"""Announcements to other systems about finished parts, stops, alarms and used-up tool life."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from app.desk.background_work import RepeatingThread
from app.shopfloor.status_file import StatusDocument
from core.message import Message

POLL_INTERVAL_S = 0.5  # seconds
MAX_QUEUED = 100  # announcements that wait for a receiver that does not respond; the oldest are discarded
_STANDS = frozenset({"FEED HOLD", "PROGRAM STOP", "WAITING", "SINGLE BLOCK"})
_FAULTS = frozenset({"ALARM", "E-STOP", "CONTROL SILENT"})


@dataclass(frozen=True, slots=True)
class Announcement:
    """Announcement of an event to other systems.

    ``event_kind`` is part, stop, alarm, tool-life or runs. ``text`` describes the event in a sentence, and
    ``status`` is the machine status at the time of the event.
    """

    event_kind: str
    text: str
    status: StatusDocument

    def make_json(self) -> bytes:
        """Return the announcement as JSON with the machine status and with the kind and text of the event."""
        return json.dumps({"event": self.event_kind, "text": self.text, **self.status}).encode()


def find_events(previous: Mapping[str, Any], current: StatusDocument) -> Iterator[Announcement]:
    """Yield the events between two machine statuses, or no events without a previous status."""
    state, was = str(current["state"]), previous.get("state")
    if was is None:
        return
    if _more(previous.get("parts"), current.get("parts")):
        yield Announcement(
            "part",
            Message(
                "part {number} of {program} is finished",
                number=current.get("made"),
                program=current.get("program"),
            ),
            current,
        )
    if current.get("next_barred") and not previous.get("next_barred"):
        yield Announcement("tool-life", str(current["next_barred"]), current)
    if state != was:
        yield from _changed(str(was), state, current)


def _more(before: object, now: object) -> bool:
    """Return whether the number of parts made since TurnDesk started has increased.

    The part count of the program is not used, because the operator can edit it.
    """
    return isinstance(now, int) and isinstance(before, int) and now > before


def _changed(was: str, state: str, now: StatusDocument) -> Iterator[Announcement]:
    why = str(now.get("stop") or now.get("waiting_for") or "")
    text = Message("{state}: {why}", state=state, why=why) if why else state
    if state in _FAULTS:
        yield Announcement("alarm", text, now)
    elif state in _STANDS - {"WAITING"}:
        yield Announcement("stop", text, now)
    elif state == "RUNNING" and was != "WAITING":
        yield Announcement("runs", str(now.get("program") or state), now)


class AnnouncementReceiver(Protocol):
    """Interface of a receiver, which forwards announcements to another system.

    No method waits for the other system to respond.
    """

    def send_status(self, status: StatusDocument) -> None:
        """Send the status of the machine after the status has changed."""

    def send_announcement(self, announcement: Announcement) -> None:
        """Send the announcement of an event."""

    def close(self) -> None:
        """Close the connection when TurnDesk closes."""


class Announcer:
    """Service that polls the machine status twice per second and sends changes to the receivers.

    The status is polled in a separate thread.
    """

    def __init__(
        self, read_status: Callable[[], StatusDocument], receivers: Sequence[AnnouncementReceiver]
    ) -> None:
        self._look, self._told = read_status, receivers
        self._before: StatusDocument = {}
        self._thread = RepeatingThread("announcer", self.poll, POLL_INTERVAL_S)

    def start(self) -> None:
        """Start polling. This method may be called only once."""
        self._thread.start()

    def close(self) -> None:
        """Stop the thread and close all receivers.

        The MQTT receiver then reports that TurnDesk is offline.
        """
        self._thread.close()
        for each in self._told:
            each.close()

    def poll(self) -> None:
        """Read the status once, and send changes and events to the receivers."""
        now = self._look()
        shown = {key: value for key, value in now.items() if key not in _ALWAYS_NEW}
        if shown != {key: value for key, value in self._before.items() if key not in _ALWAYS_NEW}:
            for receiver in self._told:
                receiver.send_status(now)
        for announcement in find_events(self._before, now):
            for receiver in self._told:
                receiver.send_announcement(announcement)
        # unknown while the control is silent; parts made in the meantime are reported afterwards
        parts = now.get("parts")
        self._before = now if parts is not None else {**now, "parts": self._before.get("parts")}


_ALWAYS_NEW = frozenset({"updated", "line", "time_left", "cycle_elapsed", "spindle_load"})
