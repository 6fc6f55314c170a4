"""Signed-in user, access level and permissions, without Qt. No function of this module blocks.

Without configured users, access levels are off and every change is allowed. Signing in is an optional
feature. If users are stored but the feature is not installed, the level remains OPERATOR.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.persistence import Persistence
from app.desk.translation import mark_untranslated, tr
from core.access.access_table import AccessLevel, ProtectedChange, get_required_level
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.store.store_errors import StoreError
from core.store.user_records import UserList

DEFAULT_USER = "operator"  # Name in the history while no user is signed in.
_RETRY_INTERVAL_S = 1.0  # Seconds between two attempts to read the stored users after an error.


class SignInSession(Protocol):
    """Interface of the optional sign-in feature. Its methods never wait."""

    def record_activity(self) -> None:
        """Record that the signed-in user pressed a key or touched the screen."""

    def update(self, snapshot: Snapshot) -> None:
        """Process sign-in attempts and sign out an inactive user.

        The screen calls this method once per frame.
        """

    def reload(self) -> None:
        """Reload the stored sign-in data. Raises StoreError if the store cannot be read."""

    def close(self) -> None:
        """Close the session when TurnDesk closes."""


@dataclass(slots=True)
class UserAccess:
    """The signed-in user, the current access level, and the resulting permissions.

    ``user_name`` is the name of the signed-in user, or empty if no user is signed in. Call
    ``record_activity`` for every key press and touch.
    """

    persistence: Persistence = field(default_factory=Persistence)
    say: Callable[[str], None] = lambda _text: None
    read_time_s: Callable[[], float] = time.monotonic
    user_list: UserList = field(default_factory=UserList)
    user_name: str = ""
    access_level: AccessLevel = AccessLevel.OPERATOR
    sign_in_session: SignInSession | None = None  # None: the sign-in feature is not installed.
    pending_notice: str = ""  # Text for the header while a service reset is in progress.
    _unread: float | None = None  # Time of the last failed attempt to read the users.
    _lifted: bool = False  # True after a service reset removed levels that could not be read.

    def __post_init__(self) -> None:
        self.reload()
        self.persistence.who = lambda: self.history_user_name if self.user_list.is_access_restricted else ""

    @property
    def has_read_failed(self) -> bool:
        """Return whether an error prevented reading the stored users."""
        return self._unread is not None

    # --- who and what --------------------------------------------------------------------------------

    @property
    def history_user_name(self) -> str:
        """Return the user name to record in the history for a change."""
        return self.user_name or DEFAULT_USER

    @property
    def header_text(self) -> str:
        """Return the user and the access level for the header, or an empty string if levels are off."""
        if not self.user_list.is_access_restricted:
            return ""
        if self.pending_notice:
            return self.pending_notice
        level = tr(self.access_level.name)
        return join_messages(" · ", (mark_untranslated(self.user_name), level)) if self.user_name else level

    def find_refusal_reason(self, change: ProtectedChange) -> str:
        """Return the reason why the access level forbids this change, or an empty string if permitted."""
        needed = get_required_level(change)
        if not self.user_list.is_access_restricted or self.access_level >= needed:
            return ""
        text = tr("{what}: {level} REQUIRED (NOW {now}). F10, ACCESS LEVELS: SIGN IN")
        if self.sign_in_session is None:
            text = tr("{what}: {level} REQUIRED (NOW {now}). THIS TURNDESK IS INSTALLED WITHOUT SIGN-IN")
        return tr(Message(text, what=tr(change.value), level=tr(needed.name), now=tr(self.access_level.name)))

    def sign_out(self, reason: str = "") -> None:
        """Sign out the user and set the level to OPERATOR. ``reason`` is added to the log entry."""
        if self.user_name:
            self.log_access(Message("{name} has signed out{why}", name=self.user_name, why=reason))
        self.user_name, self.access_level = "", AccessLevel.OPERATOR

    # --- time ----------------------------------------------------------------------------------------

    def record_activity(self) -> None:
        """Record that the signed-in user pressed a key or touched the screen."""
        if self.sign_in_session is not None:
            self.sign_in_session.record_activity()

    def update(self, snapshot: Snapshot) -> None:
        """Retry reading the users after an error, and update the session.

        The screen calls this method once per frame.
        """
        if self._unread is not None and self.read_time_s() - self._unread >= _RETRY_INTERVAL_S:
            self.reload()  # A store that could not be opened at the start may become available later.
        if self.sign_in_session is not None:
            self.sign_in_session.update(snapshot)

    # --- people --------------------------------------------------------------------------------------

    def reload(self) -> None:
        """Reload the stored users after a change or a restore.

        A user who was removed or whose level was lowered is signed out.
        """
        try:
            self.user_list = self.persistence.people()
            if self.sign_in_session is not None:
                self.sign_in_session.reload()
        except StoreError:
            self._unread = self.read_time_s()
            if not self._lifted:
                # Users are unknown, so the strictest level applies.
                self.user_list = self.user_list._replace(has_damaged_row=True)
            return  # TurnDesk shows the storage error elsewhere.
        self._unread = None
        row = self.user_list.find_user(self.user_name)
        if self.user_name and (row is None or row.level < self.access_level):
            self.sign_out()

    def remove_access_levels(self) -> None:
        """Remove the access levels after a service reset.

        Stored levels that cannot be read are ignored until TurnDesk closes.
        """
        self._lifted, self.user_list = True, UserList()
        self.reload()

    def log_access(self, text: str) -> None:
        """Log a line with the name of the signed-in user."""
        self.persistence.log_access(text, self.history_user_name)

    def close(self) -> None:
        """Close the session when TurnDesk closes."""
        if self.sign_in_session is not None:
            self.sign_in_session.close()
