"""Sign-in by PIN, automatic sign-out, and the service reset."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from app.desk.access import UserAccess
from app.desk.background_work import LatestRequestWorker
from app.desk.translation import mark_untranslated, tr
from core.access.access_table import AccessLevel
from core.executor.snapshot import MachineState, Snapshot
from core.extras.access.pins import PinHash, WrongPinCounter, hash_pin, is_hash_outdated, is_pin_correct
from core.message import Message
from core.store.store_errors import StoreError
from core.store.user_records import UserRow

TIMEOUT_CHOICES_MIN = (2, 5, 10, 30, 60)  # minutes without input before the automatic sign-out
_DEFAULT_TIMEOUT_MIN = 10
_WARNING_TIME_S = 30.0  # seconds of warning before the sign-out
_WRONG, _MINUTES = "wrong PINs", "access minutes"  # names of settings


@dataclass(slots=True)
class PinSignIn:
    """Sign-in by PIN. This class implements ``app.desk.access.SignInSession``.

    ``record_activity`` must be called for every key press and touch.
    """

    user_access: UserAccess
    timeout_minutes: int = _DEFAULT_TIMEOUT_MIN
    wrong_pin_counter: WrongPinCounter = field(default_factory=WrongPinCounter)
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("access"))
    update_service_reset: Callable[[Snapshot], None] = lambda _snapshot: None  # of a service reset
    _used: float = 0.0
    _warned: bool = False

    def __post_init__(self) -> None:
        self.user_access.sign_in_session = self
        self.user_access.reload()

    def reload(self) -> None:
        """Load the timeout of the automatic sign-out and the number of wrong PIN entries.

        Raises StoreError if the data cannot be read.
        """
        persistence = self.user_access.persistence
        minutes, wrong = persistence.read_setting(_MINUTES), persistence.read_setting(_WRONG)
        self.timeout_minutes = (
            minutes if isinstance(minutes, int) and minutes in TIMEOUT_CHOICES_MIN else _DEFAULT_TIMEOUT_MIN
        )
        if isinstance(wrong, int) and wrong > self.wrong_pin_counter.wrong_pin_count:
            self.wrong_pin_counter = WrongPinCounter(wrong, self.user_access.read_time_s())

    # --- sign-in and sign-out ------------------------------------------------------------------------

    def sign_in(self, row: UserRow, pin: str) -> None:
        """Start checking a PIN.

        The result arrives in a later frame. Each wrong PIN increases the delay before the next attempt.
        """
        left = self.wrong_pin_counter.get_remaining_delay(self.user_access.read_time_s())
        if left > 0.0:
            self.user_access.say(
                tr(Message("TOO MANY WRONG PINS. TRY AGAIN IN {seconds} S", seconds=math.ceil(left)))
            )
        elif not row.has_pin:
            self.user_access.say(
                tr(
                    Message(
                        "{name} HAS NO PIN. A SERVICE USER MUST SET THE PIN", name=mark_untranslated(row.name)
                    )
                )
            )
        elif not self.worker.is_busy:
            self.user_access.say(tr(Message("CHECKING THE PIN OF {name}", name=mark_untranslated(row.name))))
            self.worker.enqueue_work(
                partial(self._check_pin, row, pin), partial(self._tried, row), self.user_access.say
            )

    def _check_pin(self, row: UserRow, pin: str) -> bool:
        """Return whether the PIN is correct, and replace the stored hash if it is outdated.

        This method runs on the worker.
        """
        kept = PinHash(row.salt, row.hash)
        right = is_pin_correct(pin, kept)
        if right and is_hash_outdated(kept):
            with suppress(StoreError):  # retried at the next sign-in
                renewed = UserRow(row.name, row.level, *hash_pin(pin))
                self.user_access.persistence.require_store().people.save_user(renewed).result()
        return right

    def _tried(self, row: UserRow, right: bool) -> None:
        if right:
            self.user_access.reload()  # the hash may be new
            self.wrong_pin_counter.reset_count()
            self.user_access.user_name, self.user_access.access_level = row.name, AccessLevel(row.level)
            self.record_activity()
            self.user_access.log_access(
                Message(
                    "{row} has signed in: {level}", row=row.name, level=self.user_access.access_level.name
                )
            )
            self.user_access.say(
                tr(
                    Message(
                        "{name} HAS SIGNED IN: {level}",
                        name=mark_untranslated(row.name),
                        level=tr(self.user_access.access_level.name),
                    )
                )
            )
        else:
            self.wrong_pin_counter.count_wrong_pin(self.user_access.read_time_s())
            self.user_access.log_access(
                Message(
                    "wrong PIN for {row}; consecutive wrong PINs: {count}",
                    row=row.name,
                    count=self.wrong_pin_counter.wrong_pin_count,
                )
            )
            left = self.wrong_pin_counter.get_remaining_delay(self.user_access.read_time_s())
            name, seconds = mark_untranslated(row.name), math.ceil(left)
            text = Message("WRONG PIN FOR {name}. TRY AGAIN", name=name)
            if seconds:
                text = Message("WRONG PIN FOR {name}. TRY AGAIN IN {seconds} S", name=name, seconds=seconds)
            self.user_access.say(tr(text))
        self._keep(_WRONG, self.wrong_pin_counter.wrong_pin_count or None)

    # --- time ----------------------------------------------------------------------------------------

    def record_activity(self) -> None:
        """Restart the timeout of the automatic sign-out after a key or touch."""
        self._used, self._warned = self.user_access.read_time_s(), False

    def update(self, snapshot: Snapshot) -> None:
        """Process the results of the worker, and sign the user out after a timeout without input.

        The user is warned before the sign-out. This method is called once per frame.
        """
        self.worker.deliver_results()
        self.update_service_reset(snapshot)
        if not self.user_access.user_name:
            return
        left = self._used + 60.0 * self.timeout_minutes - self.user_access.read_time_s()
        if left <= 0.0:
            words = tr("{name} SIGNED OUT (NO INPUT). LEVEL: OPERATOR. F10: SIGN IN")
            self.user_access.say(tr(Message(words, name=mark_untranslated(self.user_access.user_name))))
            self.user_access.sign_out(
                Message(", after {minutes} min without input", minutes=self.timeout_minutes)
            )
        elif left <= _WARNING_TIME_S and not self._warned:
            self._warned = True
            words = tr("{name}: SIGN-OUT IN {seconds} S. PRESS ANY KEY TO STAY SIGNED IN")
            self.user_access.say(
                tr(Message(words, name=mark_untranslated(self.user_access.user_name), seconds=f"{left:.0f}"))
            )

    def set_timeout(self, minutes: int) -> None:
        """Set the timeout of the automatic sign-out in minutes."""
        self.timeout_minutes = minutes
        self._keep(_MINUTES, minutes)
        self.user_access.log_access(
            Message("automatic sign-out after {minutes} min without input", minutes=minutes)
        )

    def _keep(self, key: str, value: object) -> None:
        try:
            self.user_access.persistence.save_setting(key, value)
        except StoreError as error:
            self.user_access.say(tr(Message("NOT SAVED: {why}", why=error)))

    def close(self) -> None:
        """Stop the worker."""
        self.worker.close()


def get_pin_sign_in(access: UserAccess) -> PinSignIn:
    """Return the PIN sign-in attached to the user access, and create it if it does not exist yet."""
    return access.sign_in_session if isinstance(access.sign_in_session, PinSignIn) else PinSignIn(access)


RESET_DELAY_S = 600.0  # seconds


@dataclass(slots=True)
class AccessReset:
    """Service reset, which removes all users if the E-stop stays pressed for the whole waiting time.

    ``remove_all_users`` is called when the waiting time is over.
    """

    pin_sign_in: PinSignIn
    show_message: Callable[[str], None]
    remove_all_users: Callable[[], None]
    _since: float | None = None

    def __post_init__(self) -> None:
        self.pin_sign_in.update_service_reset = self.update

    @property
    def user_access(self) -> UserAccess:
        """Return the current user access of TurnDesk."""
        return self.pin_sign_in.user_access

    @property
    def is_running(self) -> bool:
        """Return whether the waiting time of the reset is running."""
        return self._since is not None

    def find_start_refusal(self, snapshot: Snapshot) -> str:
        """Return the reason why the service reset cannot start, or an empty string if it can start."""
        if not self.user_access.user_list.is_access_restricted:
            return tr("NO ACCESS LEVELS TO RESET")
        if snapshot.state is not MachineState.ESTOP:
            return tr("PRESS E-STOP FIRST. LEAVE IT PRESSED 10 MIN TO RESET ACCESS LEVELS")
        return ""

    def start(self) -> None:
        """Start the waiting time of the reset."""
        self._since = self.user_access.read_time_s()
        self.user_access.log_access("service reset started: the E-stop must stay pressed for 10 min")

    def update(self, snapshot: Snapshot) -> None:
        """Execute the reset when the waiting time is over.

        Releasing the E-stop or signing in cancels the reset. This method is called once per frame.
        """
        if self._since is None:
            return
        left = self._since + RESET_DELAY_S - self.user_access.read_time_s()
        if snapshot.state is not MachineState.ESTOP or self.user_access.user_name:
            self._since = None
            self.user_access.log_access("service reset canceled")
            self.show_message(tr("SERVICE RESET CANCELED: ACCESS LEVELS UNCHANGED"))
        elif left <= 0.0:
            self._since = None
            self.user_access.log_access("service reset done: all users and PINs removed, access levels off")
            self.remove_all_users()
        time = f"{int(left // 60)}:{int(left % 60):02d}"
        self.user_access.pending_notice = (
            tr(Message("PIN RESET IN {time}", time=time)) if self.is_running else ""
        )
