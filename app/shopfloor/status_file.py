"""State of the machine in a small JSON file, for scripts and spreadsheets."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable
from pathlib import Path

from app.desk.background_work import RepeatingThread
from app.shopfloor.machine_reading import MachineReading, ReadingValue
from core.executor.snapshot import Alarm, InterruptedJob
from core.file_replacement import write_atomically

STATUS_FILE_NAME = "status.json"
_UPDATE_INTERVAL_S = 1.0  # s
_LOAD_STEP_PERCENT = 5  # %
# checks without a change after which the file is written anyway, because an old file means that TurnDesk is
# not running
_MAX_UNCHANGED_CHECKS = 10
_log = logging.getLogger(__name__)

StatusDocument = dict[str, object]


def make_status(machine: str, reading: MachineReading) -> StatusDocument:
    """Return the content of the status file: machine state, program, parts and alarms."""
    values = reading.values
    return {
        "machine": machine,
        "available": reading.is_available,
        "execution": values.get("execution"),
        "mode": values.get("mode"),
        "estop": values.get("estop"),
        "program": values.get("program"),
        "parts": int(values["pcount"] or 0) if reading.is_available else None,
        "spindle_load": _round_load(values.get("Sload")),
        "interrupted": _make_interrupted(reading.interrupted_job),
        "alarms": [
            {
                "of": key,
                "level": level,
                "code": code,
                "text": text,
                **_make_alarm_entry(reading.find_alarm(code)),
            }
            for key, active in reading.conditions.items()
            for level, code, text in active
        ],
    }


def _round_load(load: ReadingValue) -> int | None:
    """Return the spindle load rounded to a multiple of 5 %, so that the file is written less often."""
    return round(load / _LOAD_STEP_PERCENT) * _LOAD_STEP_PERCENT if isinstance(load, float) else None


def _make_interrupted(found: InterruptedJob | None) -> StatusDocument | None:
    """Return the interrupted job as an entry of the file.

    ``at`` is in UTC and in ISO 8601 format.
    """
    if found is None:
        return None
    return {"line": found.line, "tool": found.tool, "part": found.part, "at": found.at}


def _make_alarm_entry(alarm: Alarm | None) -> StatusDocument:
    """Return the number, cause and remedy of an alarm as shown on the screen."""
    if alarm is None:
        return {"number": None, "cause": "", "remedy": "", "line": None}
    line = alarm.line or None
    return {"number": alarm.number, "cause": alarm.cause, "remedy": alarm.remedy, "line": line}


class StatusFileWriter:
    """Writer of the status file, which is always replaced as a whole.

    ``read_utc`` returns the time as text.
    """

    def __init__(self, path: Path, read_utc: Callable[[], str]) -> None:
        self._path, self._utc = path, read_utc
        self._written: StatusDocument = {}
        self._since = ""
        self._looks = 0
        self._failed = False

    def write_status(self, status: StatusDocument) -> None:
        """Write the status if it has changed or the file is too old.

        After a failed write, the next call tries again.
        """
        self._looks += 1
        if status == self._written and self._looks < _MAX_UNCHANGED_CHECKS:
            return
        now = self._utc()
        if not self._since or status.get("execution") != self._written.get("execution"):
            self._since = now
        text = json.dumps({"updated": now, "since": self._since, **status}, indent=1) + "\n"
        try:
            write_atomically(self._path, text.encode())
        except OSError as error:
            if not self._failed:
                _log.warning("%s cannot be written: %s", self._path, error.strerror or error)
            self._failed = True
            return
        self._written, self._looks, self._failed = status, 0, False


class StatusFileUpdater(RepeatingThread):
    """Thread that updates the status file once per second.

    A separate thread is used so that a slow disk does not delay other work.
    """

    def __init__(
        self,
        status_file: StatusFileWriter,
        read_status: Callable[[], StatusDocument],
        final_status: StatusDocument,
    ) -> None:
        """Create the thread.

        ``final_status`` is the status that is written when the thread ends.
        """
        super().__init__("status", self._show, _UPDATE_INTERVAL_S)
        self._file, self._status, self._gone = status_file, read_status, final_status
        self._last: StatusDocument = {}

    def _show(self) -> None:
        self._last = self._status()
        self._file.write_status(self._last)

    def _repeat(self) -> None:
        try:
            super()._repeat()
            self._last = self._status()  # a job that is interrupted by closing remains interrupted
        finally:
            if not self.is_closing:
                _log.error("the status file is not kept any more: a mistake of the control", exc_info=True)
            self._file.write_status({**self._gone, "interrupted": self._last.get("interrupted")})
