"""Sign-in by PIN, automatic sign-out, and the service reset."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from app.desk.access import Access
from app.desk.background_work import Latest
from app.desk.translation import data, tr
from core.access.access_table import Level
from core.executor.snapshot import Snapshot, State
from core.extras.access.pins import Hashed, WrongPins, hashed, is_outdated, is_pin
from core.message import Message
from core.store.people import PersonRow
from core.store.store_errors import StoreError

MINUTES = (2, 5, 10, 30, 60)  # minutes without input before the automatic sign-out
_USUAL = 10
_WARNED = 30.0  # seconds of warning before the sign-out
_WRONG, _MINUTES = "wrong PINs", "access minutes"  # names of settings


@dataclass(slots=True)
class SignIn:
    """Implementation of ``app.desk.access.Session`` with PINs.

    ``used`` is called for every key and touch.
    """

    access: Access
    minutes: int = _USUAL
    wrong: WrongPins = field(default_factory=WrongPins)
    worker: Latest = field(default_factory=lambda: Latest("access"))
    reset_look: Callable[[Snapshot], None] = lambda _snapshot: None  # of a service reset
    _used: float = 0.0
    _warned: bool = False

    def __post_init__(self) -> None:
        self.access.session = self
        self.access.reload()

    def reload(self) -> None:
        """Load the time of the automatic sign-out and the wrong PINs. Raises StoreError."""
        persistence = self.access.persistence
        minutes, wrong = persistence.read_setting(_MINUTES), persistence.read_setting(_WRONG)
        self.minutes = minutes if isinstance(minutes, int) and minutes in MINUTES else _USUAL
        if isinstance(wrong, int) and wrong > self.wrong.count:
            self.wrong = WrongPins(wrong, self.access.clock())

    # --- sign-in and sign-out ------------------------------------------------------------------------

    def sign_in(self, row: PersonRow, pin: str) -> None:
        """Check a PIN. The result arrives in a later frame, and each wrong PIN increases the wait."""
        left = self.wrong.left(self.access.clock())
        if left > 0.0:
            self.access.say(
                tr(Message("TOO MANY WRONG PINS. TRY AGAIN IN {seconds} S", seconds=f"{left:.0f}"))
            )
        elif not row.has_pin:
            self.access.say(
                tr(Message("{name} HAS NO PIN. A SERVICE USER MUST SET THE PIN", name=data(row.name)))
            )
        elif not self.worker.busy:
            self.access.say(tr(Message("CHECKING THE PIN OF {name}", name=data(row.name))))
            self.worker.queue(partial(self._try, row, pin), partial(self._tried, row), self.access.say)

    def _try(self, row: PersonRow, pin: str) -> bool:
        """Return whether the PIN is correct. An outdated hash is replaced. Runs on the worker."""
        kept = Hashed(row.salt, row.hash)
        right = is_pin(pin, kept)
        if right and is_outdated(kept):
            with suppress(StoreError):  # retried at the next sign-in
                renewed = PersonRow(row.name, row.level, *hashed(pin))
                self.access.persistence.opened().people.save_person(renewed).result()
        return right

    def _tried(self, row: PersonRow, right: bool) -> None:
        if right:
            self.access.reload()  # the hash may be new
            self.wrong.right()
            self.access.name, self.access.level = row.name, Level(row.level)
            self.used()
            self.access.note(
                Message("{row} has signed in: {level}", row=row.name, level=self.access.level.name)
            )
            self.access.say(
                tr(
                    Message(
                        "{name} HAS SIGNED IN: {level}", name=data(row.name), level=tr(self.access.level.name)
                    )
                )
            )
        else:
            self.wrong.wrong(self.access.clock())
            self.access.note(
                Message(
                    "wrong PIN for {row}; consecutive wrong PINs: {count}",
                    row=row.name,
                    count=self.wrong.count,
                )
            )
            left = self.wrong.left(self.access.clock())
            text = tr("WRONG PIN FOR {name}. TRY AGAIN IN {seconds} S")
            self.access.say(tr(Message(text, name=data(row.name), seconds=f"{left:.0f}")))
        self._keep(_WRONG, self.wrong.count or None)

    # --- time ----------------------------------------------------------------------------------------

    def used(self) -> None:
        """Restart the time of the automatic sign-out after a key or touch."""
        self._used, self._warned = self.access.clock(), False

    def look(self, snapshot: Snapshot) -> None:
        """Process results, warn, and sign out after the time without input; called once per frame."""
        self.worker.poll()
        self.reset_look(snapshot)
        if not self.access.name:
            return
        left = self._used + 60.0 * self.minutes - self.access.clock()
        if left <= 0.0:
            words = tr("{name} SIGNED OUT (NO INPUT). LEVEL: OPERATOR. F10: SIGN IN")
            self.access.say(tr(Message(words, name=data(self.access.name))))
            self.access.sign_out(Message(", after {minutes} min without input", minutes=self.minutes))
        elif left <= _WARNED and not self._warned:
            self._warned = True
            words = tr("{name}: SIGN-OUT IN {seconds} S. PRESS ANY KEY TO STAY SIGNED IN")
            self.access.say(tr(Message(words, name=data(self.access.name), seconds=f"{left:.0f}")))

    def choose_minutes(self, minutes: int) -> None:
        """Set the time of the automatic sign-out in minutes."""
        self.minutes = minutes
        self._keep(_MINUTES, minutes)
        self.access.note(Message("automatic sign-out after {minutes} min without input", minutes=minutes))

    def _keep(self, key: str, value: object) -> None:
        try:
            self.access.persistence.save_setting(key, value)
        except StoreError as error:
            self.access.say(tr(Message("NOT SAVED: {why}", why=error)))

    def close(self) -> None:
        """Stop the worker."""
        self.worker.close()


def sign_in_of(access: Access) -> SignIn:
    """Return the sign-in of TurnDesk, created if necessary."""
    return access.session if isinstance(access.session, SignIn) else SignIn(access)


WAIT = 600.0  # seconds


@dataclass(slots=True)
class AccessReset:
    """Service reset. ``reset`` removes all users when the waiting time is over."""

    sign_in: SignIn
    say: Callable[[str], None]
    reset: Callable[[], None]
    _since: float | None = None

    def __post_init__(self) -> None:
        self.sign_in.reset_look = self.look

    @property
    def access(self) -> Access:
        """Present access of TurnDesk."""
        return self.sign_in.access

    @property
    def under_way(self) -> bool:
        """Whether the waiting time is running."""
        return self._since is not None

    def why_not(self, snapshot: Snapshot) -> str:
        """Return the reason why the reset cannot start, or an empty string."""
        if not self.access.people.on:
            return tr("NO ACCESS LEVELS TO RESET")
        if snapshot.state is not State.ESTOP:
            return tr("PRESS E-STOP FIRST. LEAVE IT PRESSED 10 MIN TO RESET ACCESS LEVELS")
        return ""

    def begin(self) -> None:
        """Start the waiting time."""
        self._since = self.access.clock()
        self.access.note("service reset started: the E-stop must stay pressed for 10 min")

    def look(self, snapshot: Snapshot) -> None:
        """Execute the reset after the waiting time, once per frame.

        A release of the E-stop or a sign-in cancels the reset.
        """
        if self._since is None:
            return
        left = self._since + WAIT - self.access.clock()
        if snapshot.state is not State.ESTOP or self.access.name:
            self._since = None
            self.access.note("service reset canceled")
            self.say(tr("SERVICE RESET CANCELED: ACCESS LEVELS UNCHANGED"))
        elif left <= 0.0:
            self._since = None
            self.access.note("service reset done: all users and PINs removed, access levels off")
            self.reset()
        time = f"{int(left // 60)}:{int(left % 60):02d}"
        self.access.pending = tr(Message("PIN RESET IN {time}", time=time)) if self.under_way else ""
