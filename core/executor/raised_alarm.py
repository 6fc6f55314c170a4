"""An alarm as it is raised, with what the catalogue says, and attempts that report their failure."""

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
    """Something that must stop the machine: an alarm's code, and what exactly, where.

    ``detail`` is a sentence: for the operator where the catalogue's entry says so, else for the log.
    """

    def __init__(self, code: Code, detail: str = "", line: int = 0) -> None:
        super().__init__(detail or CATALOGUE[code].text)
        self.code: Code = code
        self.detail = detail
        self.line = line


def alarm_and_reaction(trouble: AlarmError, line: int, now: float) -> tuple[Alarm, Reaction]:
    """The alarm to show, and what it makes of the machine."""
    alarm = make_alarm(trouble.code, trouble.detail, trouble.line or line, now)
    return alarm, CATALOGUE[trouble.code].reaction


def make_alarm(code: Code, detail: str, line: int, now: float) -> Alarm:
    """What the catalogue says of an alarm, a hold or a stop, and what is known of this one."""
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
    """What of the catalogue a hold is: ``reason`` in its words, or ``by`` whom it was pressed."""
    if not reason:
        return "feed-hold", Message("feed hold requested by {name}", name=by) if by else ""
    code = CODES_OF_HOLDS.get(reason)
    return ("held", reason.lower()) if code is None else (code, "")


def log_line(alarm: Alarm) -> str:
    """One line for the log of events; it begins with the number, by which the catalogue is found again."""
    return Message("{number} {alarm}: {cause}", number=alarm.number, alarm=alarm.text, cause=alarm.cause)


def log_alarm(alarm: Alarm) -> None:
    """The technical side of an alarm, for whoever mends it."""
    where = Message(" line {line}", line=alarm.line) if alarm.line else ""
    _log.warning("alarm %d %s%s: %s", alarm.number, alarm.code, where, alarm.detail or alarm.cause)


class Attempt:
    """A ``with`` block that is over when it fails: ``error`` is what it raised, SystemExit of a library too.

    Only Ctrl-C goes on: it is meant for the program, and comes to its main thread alone.
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
    """A ``with`` block whose failure is written to the log, given to ``failed`` and then over.

    Should ``failed`` fail as well, that is written too. What comes in every tick is written the first, the
    tenth, the hundredth time, so that it does not drown what was before.
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
