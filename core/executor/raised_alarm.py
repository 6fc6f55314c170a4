"""Raised alarms with their catalog entries, and context managers that catch and report failures."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable
from types import TracebackType
from typing import ClassVar

from core.alarms import CATALOGUE, Code, Reaction
from core.executor.snapshot import Alarm
from core.message import Message

_log = logging.getLogger(__name__)
CODES_OF_HOLDS: dict[str, Code] = {
    entry.text.upper(): code for code, entry in CATALOGUE.items() if entry.reaction is Reaction.HOLD
}


class AlarmError(Exception):
    """Raised for a condition that must stop the machine.

    ``code`` is the code of the alarm catalog, and ``line`` is the program line or 0. ``detail`` is a sentence
    that is shown to the operator if the catalog entry permits it, and is logged otherwise.
    """

    def __init__(self, code: Code, detail: str = "", line: int = 0) -> None:
        super().__init__(detail or CATALOGUE[code].text)
        self.code: Code = code
        self.detail = detail
        self.line = line


def alarm_and_reaction(trouble: AlarmError, line: int, now: float) -> tuple[Alarm, Reaction]:
    """Return the alarm to show, with ``line`` as its default line, and the reaction of the machine."""
    alarm = make_alarm(trouble.code, trouble.detail, trouble.line or line, now)
    return alarm, CATALOGUE[trouble.code].reaction


def make_alarm(code: Code, detail: str, line: int, now: float) -> Alarm:
    """Return an alarm, a hold or a stop with the texts of the catalog and the details of this case."""
    entry = CATALOGUE[code]
    exactly = detail if entry.tells else ""
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


def code_of_hold(reason: str, by: str) -> tuple[Code, str]:
    """Return the alarm code and the detail of a hold.

    ``reason`` is a catalog text in capitals or a free text. It is empty if a button was pressed; ``by`` then
    names the button.
    """
    if not reason:
        return "feed-hold", Message("feed hold requested by {name}", name=by) if by else ""
    code = CODES_OF_HOLDS.get(reason)
    return ("held", reason.lower()) if code is None else (code, "")


def log_line(alarm: Alarm) -> str:
    """Return one line for the event log, starting with the alarm number of the catalog."""
    return Message("{number} {alarm}: {cause}", number=alarm.number, alarm=alarm.text, cause=alarm.cause)


def log_alarm(alarm: Alarm) -> None:
    """Write the technical details of an alarm to the log file, for service."""
    where = Message(" line {line}", line=alarm.line) if alarm.line else ""
    _log.warning("alarm %d %s%s: %s", alarm.number, alarm.code, where, alarm.detail or alarm.cause)


class Attempt:
    """A ``with`` block that catches its error, including SystemExit, and stores it in ``error``.

    Only KeyboardInterrupt is raised again, because it is meant for the main thread of the program.
    """

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def __enter__(self) -> Attempt:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        self.error = error
        return not isinstance(error, KeyboardInterrupt)


class ReportedAttempt(Attempt):
    """A ``with`` block that logs its error and passes it to ``failed``.

    An error in ``failed`` is logged too. An error that repeats in every tick is logged the first, tenth,
    hundredth … time, so that it does not hide earlier entries.
    """

    _written: ClassVar[Counter[str]] = Counter()

    def __init__(self, failed: Callable[[BaseException], None]) -> None:
        super().__init__()
        self._failed = failed

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        swallowed = super().__exit__(kind, error, trace)
        if error is None or not swallowed:
            return swallowed
        self._write(error)
        with Attempt() as telling:
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
