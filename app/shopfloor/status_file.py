"""The machine in one small JSON file, for a shop without an agent: for a script or a spreadsheet."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable
from pathlib import Path

from app.desk.background_work import RepeatingThread
from app.shopfloor.floor_reading import Reading, Value
from core.executor.snapshot import Alarm, InterruptedJob
from core.file_placing import write_in_place

NAME = "status.json"
_LOOK = 1.0  # s
_LOAD_STEP = 5  # per cent
_AGAIN = 10  # looks without a change after which it is written all the same: an old file is a dead control
_log = logging.getLogger(__name__)

Status = dict[str, object]


def status_of(machine: str, reading: Reading) -> Status:
    """What a shop asks first: running or not and why, which program, how many parts."""
    values = reading.values
    return {
        "machine": machine,
        "available": reading.available,
        "execution": values.get("execution"),
        "mode": values.get("mode"),
        "estop": values.get("estop"),
        "program": values.get("program"),
        "parts": int(values["pcount"] or 0) if reading.available else None,
        "spindle_load": _load(values.get("Sload")),
        "interrupted": _interrupted(reading.interrupted),
        "alarms": [
            {"of": key, "level": level, "code": code, "text": text, **_entry(reading.alarm(code))}
            for key, active in reading.conditions.items()
            for level, code, text in active
        ],
    }


def _load(load: Value) -> int | None:
    """Per cent to the next five: each change is a file written anew."""
    return round(load / _LOAD_STEP) * _LOAD_STEP if isinstance(load, float) else None


def _interrupted(found: InterruptedJob | None) -> Status | None:
    """The job that did not come to its end; ``at`` is UTC, ISO 8601."""
    if found is None:
        return None
    return {"line": found.line, "tool": found.tool, "part": found.part, "at": found.at}


def _entry(alarm: Alarm | None) -> Status:
    """Number, cause and remedy, as the screen tells them."""
    if alarm is None:
        return {"number": None, "cause": "", "remedy": "", "line": None}
    line = alarm.line or None
    return {"number": alarm.number, "cause": alarm.cause, "remedy": alarm.remedy, "line": line}


class StatusFile:
    """Replaced whole: a reader sees the old one or the new one. ``utc`` is the time of day as text."""

    def __init__(self, path: Path, utc: Callable[[], str]) -> None:
        self._path, self._utc = path, utc
        self._written: Status = {}
        self._since = ""
        self._looks = 0
        self._failed = False

    def show(self, status: Status) -> None:
        """Write it when it is new, or when the last one is getting old; a disk that fails is tried again."""
        self._looks += 1
        if status == self._written and self._looks < _AGAIN:
            return
        now = self._utc()
        if not self._since or status.get("execution") != self._written.get("execution"):
            self._since = now
        text = json.dumps({"updated": now, "since": self._since, **status}, indent=1) + "\n"
        try:
            write_in_place(self._path, text.encode())
        except OSError as error:
            if not self._failed:
                _log.warning("%s cannot be written: %s", self._path, error.strerror or error)
            self._failed = True
            return
        self._written, self._looks, self._failed = status, 0, False


class StatusKeeper(RepeatingThread):
    """Shows the status once a second, by a thread of its own: a slow disk keeps nothing else waiting."""

    def __init__(self, file: StatusFile, look: Callable[[], Status], gone: Status) -> None:
        """``gone`` is written last."""
        super().__init__("status", self._show, _LOOK)
        self._file, self._status, self._gone = file, look, gone
        self._last: Status = {}

    def _show(self) -> None:
        self._last = self._status()
        self._file.show(self._last)

    def _repeat(self) -> None:
        try:
            super()._repeat()
            self._last = self._status()  # what closing has interrupted stays so
        finally:
            if not self.closing:
                _log.error("the status file is not kept any more: a mistake of the control", exc_info=True)
            self._file.show({**self._gone, "interrupted": self._last.get("interrupted")})
