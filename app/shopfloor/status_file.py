"""The state of the machine in a small JSON file, for scripts and spreadsheets."""

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
_LOAD_STEP = 5  # %
# checks without a change after which the file is written anyway, because an old file means that TurnDesk is
# not running
_AGAIN = 10
_log = logging.getLogger(__name__)

Status = dict[str, object]


def status_of(machine: str, reading: Reading) -> Status:
    """Return the status of the machine for the file: state, program, parts and alarms."""
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
    """Return the load in % rounded to 5, to limit the number of writes."""
    return round(load / _LOAD_STEP) * _LOAD_STEP if isinstance(load, float) else None


def _interrupted(found: InterruptedJob | None) -> Status | None:
    """Return the interrupted job; ``at`` is UTC in ISO 8601 format."""
    if found is None:
        return None
    return {"line": found.line, "tool": found.tool, "part": found.part, "at": found.at}


def _entry(alarm: Alarm | None) -> Status:
    """Return number, cause and remedy of an alarm as shown on the screen."""
    if alarm is None:
        return {"number": None, "cause": "", "remedy": "", "line": None}
    line = alarm.line or None
    return {"number": alarm.number, "cause": alarm.cause, "remedy": alarm.remedy, "line": line}


class StatusFile:
    """The status file, which is always replaced as a whole. ``utc`` returns the time as text."""

    def __init__(self, path: Path, utc: Callable[[], str]) -> None:
        self._path, self._utc = path, utc
        self._written: Status = {}
        self._since = ""
        self._looks = 0
        self._failed = False

    def show(self, status: Status) -> None:
        """Write the status if it has changed or the file is too old. A failed write is tried again."""
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
    """Thread that updates the status file once per second, so that a slow disk delays no other thread."""

    def __init__(self, file: StatusFile, look: Callable[[], Status], gone: Status) -> None:
        """Create the thread; ``gone`` is the status that is written last."""
        super().__init__("status", self._show, _LOOK)
        self._file, self._status, self._gone = file, look, gone
        self._last: Status = {}

    def _show(self) -> None:
        self._last = self._status()
        self._file.show(self._last)

    def _repeat(self) -> None:
        try:
            super()._repeat()
            self._last = self._status()  # a job that is interrupted by closing remains interrupted
        finally:
            if not self.closing:
                _log.error("the status file is not kept any more: a mistake of the control", exc_info=True)
            self._file.show({**self._gone, "interrupted": self._last.get("interrupted")})
