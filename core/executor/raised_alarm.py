"""Alarms with their catalog entries, and context managers that catch and report failures."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable
from types import TracebackType
from typing import ClassVar

from core.alarms import CATALOG, AlarmCode, AlarmReaction
from core.executor.snapshot import Alarm
from core.message import Message

_log = logging.getLogger(__name__)
HOLD_CODES: dict[str, AlarmCode] = {
    entry.text.upper(): code for code, entry in CATALOG.items() if entry.reaction is AlarmReaction.HOLD
}


class AlarmError(Exception):
    """An error raised for a condition that must stop the machine.

    ``code`` is the code of the alarm catalog, and ``line`` is the program line or 0. ``detail`` is a
    sentence that is shown to the operator if the catalog entry permits it, and is only logged otherwise.
    """

    def __init__(self, code: AlarmCode, detail: str = "", line: int = 0) -> None:
        super().__init__(detail or CATALOG[code].text)
        self.code: AlarmCode = code
        self.detail = detail
        self.line = line


def make_alarm_and_reaction(error: AlarmError, line: int, now: float) -> tuple[Alarm, AlarmReaction]:
    """Return the alarm to show and the reaction of the machine.

    ``line`` is used if the error has no line.
    """
    alarm = make_alarm(error.code, error.detail, error.line or line, now)
    return alarm, CATALOG[error.code].reaction


def make_alarm(code: AlarmCode, detail: str, line: int, now: float) -> Alarm:
    """Return an alarm, a hold or a stop with the texts of its catalog entry and the given detail."""
    entry = CATALOG[code]
    exactly = detail if entry.shows_detail else ""
    return Alarm(
        number=entry.number,
        code=code,
        text=entry.text.upper(),
        cause=exactly or entry.causes[0],
        remedy=entry.remedy,
        line=line,
        time=now,
        causes=entry.causes,
        detail=detail,
    )


def find_hold_code(reason: str, source: str) -> tuple[AlarmCode, str]:
    """Return the alarm code and the detail of a hold.

    ``reason`` is a catalog text in capitals or a free text. If a button was pressed, ``reason`` is empty
    and ``source`` names the button.
    """
    if not reason:
        return "feed-hold", Message("feed hold requested by {name}", name=source) if source else ""
    code = HOLD_CODES.get(reason)
    return ("held", reason.lower()) if code is None else (code, "")


def format_log_line(alarm: Alarm) -> str:
    """Return one line for the event log that begins with the alarm's catalog number."""
    return Message("{number} {alarm}: {cause}", number=alarm.number, alarm=alarm.text, cause=alarm.cause)


def log_alarm(alarm: Alarm) -> None:
    """Write the technical details of an alarm to the log file, for service."""
    where = Message(" line {line}", line=alarm.line) if alarm.line else ""
    _log.warning("alarm %d %s%s: %s", alarm.number, alarm.code, where, alarm.detail or alarm.cause)


class ErrorCatcher:
    """A context manager that catches an error of its ``with`` block and stores it in ``error``.

    SystemExit is caught too. Only KeyboardInterrupt is raised again, because it is meant for the main
    thread.
    """

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def __enter__(self) -> ErrorCatcher:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        self.error = error
        return not isinstance(error, KeyboardInterrupt)


class ErrorReporter(ErrorCatcher):
    """A context manager that logs an error of its ``with`` block and passes it to ``handle_failure``.

    An error in ``handle_failure`` is logged too. If an error repeats in every tick, only occurrences 1, 10,
    100 and so on are logged, so that it does not displace earlier log entries.
    """

    _written: ClassVar[Counter[str]] = Counter()

    def __init__(self, handle_failure: Callable[[BaseException], None]) -> None:
        super().__init__()
        self._failed = handle_failure

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        swallowed = super().__exit__(kind, error, trace)
        if error is None or not swallowed:
            return swallowed
        self._write(error)
        with ErrorCatcher() as telling:
            self._failed(error)
        if telling.error is not None:
            _log.error("and could not say so", exc_info=telling.error)
        return True

    def _write(self, error: BaseException) -> None:
        what = Message("{name}: {error}", name=type(error).__name__, error=error)
        self._written[what] += 1
        times = self._written[what]
        if str(times).strip("0") == "1":
            _log.error("the control has failed, %d", times, exc_info=error)
