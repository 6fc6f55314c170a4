"""Signing in with a PIN at the desk, the time after which a level falls back, and the service reset."""

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

MINUTES = (2, 5, 10, 30, 60)  # without a key or finger after which a level falls back
_USUAL = 10
_WARNED = 30.0  # s before it does
_WRONG, _MINUTES = "wrong PINs", "access minutes"  # settings


@dataclass(slots=True)
class SignIn:
    """``app.desk.access.Session`` by PINs; ``used`` is told of every key and finger."""

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
        """Read the time of the automatic sign-out and the wrong PINs. Raises StoreError."""
        persistence = self.access.persistence
        minutes, wrong = persistence.read_setting(_MINUTES), persistence.read_setting(_WRONG)
        self.minutes = minutes if isinstance(minutes, int) and minutes in MINUTES else _USUAL
        if isinstance(wrong, int) and wrong > self.wrong.count:
            self.wrong = WrongPins(wrong, self.access.clock())

    # --- signing in and out --------------------------------------------------------------------------

    def sign_in(self, row: PersonRow, pin: str) -> None:
        """Try a PIN; the answer comes with a later frame, and wrong ones let wait longer and longer."""
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
        """On the worker: whether it is the PIN. One that was stored at a lower cost is stored again."""
        kept = Hashed(row.salt, row.hash)
        right = is_pin(pin, kept)
        if right and is_outdated(kept):
            with suppress(StoreError):  # the next time that a PIN is entered it is tried again
                renewed = PersonRow(row.name, row.level, *hashed(pin))
                self.access.persistence.opened().people.save_person(renewed).result()
        return right

    def _tried(self, row: PersonRow, right: bool) -> None:
        if right:
            self.access.reload()  # a hash may be new
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
        """A key or a finger: whoever signed in is there."""
        self._used, self._warned = self.access.clock(), False

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: what was tried, and whether the level falls back, which is said before."""
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
        """Another time after which a level falls back."""
        self.minutes = minutes
        self._keep(_MINUTES, minutes)
        self.access.note(Message("automatic sign-out after {minutes} min without input", minutes=minutes))

    def _keep(self, key: str, value: object) -> None:
        try:
            self.access.persistence.save_setting(key, value)
        except StoreError as error:
            self.access.say(tr(Message("NOT SAVED: {why}", why=error)))

    def close(self) -> None:
        """The desk shuts."""
        self.worker.close()


def sign_in_of(access: Access) -> SignIn:
    """Return how people sign in at this desk; it is made where the desk was put together without it."""
    return access.session if isinstance(access.session, SignIn) else SignIn(access)


WAIT = 600.0  # s


@dataclass(slots=True)
class AccessReset:
    """``reset`` takes all people away; called when the time is over."""

    sign_in: SignIn
    say: Callable[[str], None]
    reset: Callable[[], None]
    _since: float | None = None

    def __post_init__(self) -> None:
        self.sign_in.reset_look = self.look

    @property
    def access(self) -> Access:
        """Who is in force."""
        return self.sign_in.access

    @property
    def under_way(self) -> bool:
        """Whether it waits for its time."""
        return self._since is not None

    def why_not(self, snapshot: Snapshot) -> str:
        """Why it cannot begin; empty when it can."""
        if not self.access.people.on:
            return tr("NO ACCESS LEVELS TO RESET")
        if snapshot.state is not State.ESTOP:
            return tr("PRESS E-STOP FIRST. LEAVE IT PRESSED 10 MIN TO RESET ACCESS LEVELS")
        return ""

    def begin(self) -> None:
        """From now on the time runs."""
        self._since = self.access.clock()
        self.access.note("service reset started: the E-stop must stay pressed for 10 min")

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: given up when the E-stop is released or somebody signs in, done in its time."""
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
