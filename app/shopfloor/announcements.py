"""Who is told of the end of a part, a stop, an alarm, a tool at the end of its life: MQTT and a web hook."""

from __future__ import annotations

import json
import logging
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from http.client import HTTPException
from typing import Any, Protocol
from urllib.error import URLError
from urllib.request import Request, urlopen

from app.desk.repeating_thread import RepeatingThread
from app.shopfloor.status_file import Status

LOOK = 0.5  # s
HELD = 100  # announcements that wait for somebody who does not answer; of more the oldest go
_PATIENCE = 5.0  # s
_STANDS = frozenset({"FEED HOLD", "PROGRAM STOP", "WAITING", "SINGLE BLOCK"})
_FAULTS = frozenset({"ALARM", "E-STOP", "CONTROL SILENT"})
_log = logging.getLogger(__name__)


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
    made, made_before = now.get("made"), before.get("made")
    one_program = now.get("program") == before.get("program")
    if isinstance(made, int) and isinstance(made_before, int) and made > made_before and one_program:
        yield Announcement("part", f"part {made} of {now.get('program')} is done", now)
    if now.get("next_barred") and not before.get("next_barred"):
        yield Announcement("tool-life", str(now["next_barred"]), now)
    if state != was:
        yield from _changed(str(was), state, now)


def _changed(was: str, state: str, now: Status) -> Iterator[Announcement]:
    why = str(now.get("stop") or now.get("waiting_for") or "")
    text = f"{state}: {why}" if why else state
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


class WebHook:
    """Each announcement is posted as JSON to an address, by a thread of its own, in their order."""

    def __init__(self, address: str, post: Callable[[str, bytes], None] | None = None) -> None:
        self._address, self._post = address, post or posted
        self._waiting: deque[Announcement] = deque(maxlen=HELD)
        self._there = threading.Event()
        self._closing = False
        self._failed = False
        self._thread = threading.Thread(target=self._work, name="web-hook", daemon=True)
        self._thread.start()

    def state(self, status: Status) -> None:
        """A web hook is told of what happens, not of every change."""

    def tell(self, announcement: Announcement) -> None:
        """Queue it."""
        self._waiting.append(announcement)
        self._there.set()

    def close(self) -> None:
        """What is under way goes out; nobody waits for it."""
        self._closing = True
        self._there.set()

    def _work(self) -> None:
        while not self._closing:
            self._there.wait()
            self._there.clear()
            while self._waiting:
                self._one(self._waiting.popleft())

    def _one(self, announcement: Announcement) -> None:
        try:
            self._post(self._address, announcement.json())
        except (URLError, HTTPException, OSError, ValueError) as error:
            if not self._failed:
                _log.warning("%s cannot be told: %s", self._address, getattr(error, "reason", error))
            self._failed = True
            return
        self._failed = False


def posted(address: str, body: bytes) -> None:
    """Post JSON to an address. Raises OSError, ValueError or HTTPException."""
    request = Request(address, body, {"Content-Type": "application/json"}, method="POST")
    with urlopen(request, timeout=_PATIENCE):
        return


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
        self._before = now


_ALWAYS_NEW = frozenset({"updated", "line", "time_left", "cycle_elapsed", "spindle_load"})
