"""Who works at the desk, by name and level, and what he may change. No Qt, never waits.

Without people there are no levels: everybody may change everything, and nobody is asked. Signing in is an
optional feature. Where people are stored and it is absent, the level stays OPERATOR.
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

NOBODY = "operator"  # in the history, while nobody has signed in
_AGAIN = 1.0  # s between two tries to read people that could not be read


class Session(Protocol):
    """How people sign in. Nothing here waits."""

    def used(self) -> None:
        """A key or a finger: whoever signed in is there."""

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: what was tried, and whether the level falls back."""

    def reload(self) -> None:
        """Read what is stored for signing in. Raises StoreError."""

    def close(self) -> None:
        """The desk shuts."""


@dataclass(slots=True)
class Access:
    """``name`` has signed in, empty: nobody; ``used`` is told of every key and finger."""

    persistence: Persistence = field(default_factory=Persistence)
    say: Callable[[str], None] = lambda _text: None
    clock: Callable[[], float] = time.monotonic
    people: People = field(default_factory=People)
    name: str = ""
    level: Level = Level.OPERATOR
    session: Session | None = None  # None: nobody can sign in
    pending: str = ""  # a service reset that is under way, for the header
    _unread: float | None = None  # when people were tried last, where they could not be read
    _lifted: bool = False  # whether a service reset has ended levels that cannot be read

    def __post_init__(self) -> None:
        self.reload()
        self.persistence.who = lambda: self.who if self.people.on else ""

    @property
    def is_unread(self) -> bool:
        """Whether the people could not be read, so that nobody knows who they are."""
        return self._unread is not None

    # --- who and what --------------------------------------------------------------------------------

    @property
    def who(self) -> str:
        """By whom something is changed, for the history."""
        return self.name or NOBODY

    @property
    def words(self) -> str:
        """Who is in force, for the header; empty without levels."""
        if not self.people.on:
            return ""
        if self.pending:
            return self.pending
        level = tr(self.level.name)
        return join_messages(" · ", (data(self.name), level)) if self.name else level

    def refusal(self, act: Act) -> str:
        """Why this is not changed now; empty when it may be."""
        needed = level_for(act)
        if not self.people.on or self.level >= needed:
            return ""
        text = tr("{what}: {level} REQUIRED (NOW {now}). F10, ACCESS LEVELS: SIGN IN")
        if self.session is None:
            text = tr("{what}: {level} REQUIRED (NOW {now}). THIS TURNDESK IS INSTALLED WITHOUT SIGN-IN")
        return tr(Message(text, what=tr(act.value), level=tr(needed.name), now=tr(self.level.name)))

    def sign_out(self, why: str = "") -> None:
        """Nobody is signed in any more: the level is OPERATOR."""
        if self.name:
            self.note(Message("{name} has signed out{why}", name=self.name, why=why))
        self.name, self.level = "", Level.OPERATOR

    # --- time ----------------------------------------------------------------------------------------

    def used(self) -> None:
        """A key or a finger: whoever signed in is there."""
        if self.session is not None:
            self.session.used()

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: people that could not be read, and what the session has to do."""
        if self._unread is not None and self.clock() - self._unread >= _AGAIN:
            self.reload()  # a store that was away at the start is there some time, and its levels with it
        if self.session is not None:
            self.session.look(snapshot)

    # --- people --------------------------------------------------------------------------------------

    def reload(self) -> None:
        """Read who works here, after a change of it or a restore."""
        try:
            self.people = self.persistence.people()
            if self.session is not None:
                self.session.reload()
        except StoreError:
            self._unread = self.clock()
            if not self._lifted:
                self.people = self.people._replace(damaged=True)  # unknown: the strictest level is in force
            return  # the desk says by itself that nothing can be read
        self._unread = None
        row = self.people.named(self.name)
        if self.name and (row is None or row.level < self.level):
            self.sign_out()

    def lift(self) -> None:
        """End the levels after a service reset; also levels that cannot be read, until TurnDesk ends."""
        self._lifted, self.people = True, People()
        self.reload()

    def note(self, text: str) -> None:
        """A line of the log, with the name of whoever is signed in."""
        self.persistence.note_access(text, self.who)

    def close(self) -> None:
        """The desk shuts."""
        if self.session is not None:
            self.session.close()
