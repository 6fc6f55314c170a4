"""Signed-in user, access level and permissions of TurnDesk, without Qt and without waiting.

Without configured users, access levels are off and every change is allowed. Signing in is an optional
feature. If users are stored but the feature is not installed, the level remains OPERATOR.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.persistence import Persistence
from app.desk.translation import data, tr
from core.access.access_table import Act, Level, level_for
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.store.people import People
from core.store.store_errors import StoreError

NOBODY = "operator"  # Name in the history while no user is signed in.
_AGAIN = 1.0  # Seconds between two attempts to read the stored users after an error.


class Session(Protocol):
    """Interface of the optional sign-in feature. Its methods never wait."""

    def used(self) -> None:
        """Note that the signed-in user pressed a key or touched the screen."""

    def look(self, snapshot: Snapshot) -> None:
        """Process sign-in attempts and sign out an inactive user; called once a frame."""

    def reload(self) -> None:
        """Read the stored sign-in data again. Raises StoreError."""

    def close(self) -> None:
        """Close the session when TurnDesk closes."""


@dataclass(slots=True)
class Access:
    """The signed-in user, the access level in force and the permissions that follow from them.

    ``name`` is the name of the signed-in user, empty if no user is signed in. Call ``used`` for every key
    press and touch.
    """

    persistence: Persistence = field(default_factory=Persistence)
    say: Callable[[str], None] = lambda _text: None
    clock: Callable[[], float] = time.monotonic
    people: People = field(default_factory=People)
    name: str = ""
    level: Level = Level.OPERATOR
    session: Session | None = None  # None: the sign-in feature is not installed.
    pending: str = ""  # Text for the header while a service reset is in progress.
    _unread: float | None = None  # Time of the last failed attempt to read the users.
    _lifted: bool = False  # True after a service reset removed levels that could not be read.

    def __post_init__(self) -> None:
        self.reload()
        self.persistence.who = lambda: self.who if self.people.on else ""

    @property
    def is_unread(self) -> bool:
        """Whether the stored users could not be read."""
        return self._unread is not None

    # --- who and what --------------------------------------------------------------------------------

    @property
    def who(self) -> str:
        """The user name that the history records for a change."""
        return self.name or NOBODY

    @property
    def words(self) -> str:
        """The user and level in force, for the header. Empty if access levels are off."""
        if not self.people.on:
            return ""
        if self.pending:
            return self.pending
        level = tr(self.level.name)
        return join_messages(" · ", (data(self.name), level)) if self.name else level

    def refusal(self, act: Act) -> str:
        """Return why the level in force does not permit this act. Empty if the act is permitted."""
        needed = level_for(act)
        if not self.people.on or self.level >= needed:
            return ""
        text = tr("{what}: {level} REQUIRED (NOW {now}). F10, ACCESS LEVELS: SIGN IN")
        if self.session is None:
            text = tr("{what}: {level} REQUIRED (NOW {now}). THIS TURNDESK IS INSTALLED WITHOUT SIGN-IN")
        return tr(Message(text, what=tr(act.value), level=tr(needed.name), now=tr(self.level.name)))

    def sign_out(self, why: str = "") -> None:
        """Sign out the user and set the level to OPERATOR. ``why`` is added to the log entry."""
        if self.name:
            self.note(Message("{name} has signed out{why}", name=self.name, why=why))
        self.name, self.level = "", Level.OPERATOR

    # --- time ----------------------------------------------------------------------------------------

    def used(self) -> None:
        """Note that the signed-in user pressed a key or touched the screen."""
        if self.session is not None:
            self.session.used()

    def look(self, snapshot: Snapshot) -> None:
        """Retry reading the users after an error, and update the session; called once a frame."""
        if self._unread is not None and self.clock() - self._unread >= _AGAIN:
            self.reload()  # A store that could not be opened at the start may become available later.
        if self.session is not None:
            self.session.look(snapshot)

    # --- people --------------------------------------------------------------------------------------

    def reload(self) -> None:
        """Read the stored users again, after a change or a restore.

        A user who was removed or whose level was lowered is signed out.
        """
        try:
            self.people = self.persistence.people()
            if self.session is not None:
                self.session.reload()
        except StoreError:
            self._unread = self.clock()
            if not self._lifted:
                # Users are unknown, so the strictest level applies.
                self.people = self.people._replace(damaged=True)
            return  # TurnDesk shows the storage error elsewhere.
        self._unread = None
        row = self.people.named(self.name)
        if self.name and (row is None or row.level < self.level):
            self.sign_out()

    def lift(self) -> None:
        """Remove the access levels after a service reset.

        Levels that cannot be read are ignored until TurnDesk closes.
        """
        self._lifted, self.people = True, People()
        self.reload()

    def note(self, text: str) -> None:
        """Write a line to the log with the name of the signed-in user."""
        self.persistence.note_access(text, self.who)

    def close(self) -> None:
        """Close the session when TurnDesk closes."""
        if self.session is not None:
            self.session.close()
