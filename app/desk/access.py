"""Who works at the desk, by name and level, and what he may change. No Qt, never waits.

Without people there are no levels: everybody may change everything, and nobody is asked.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from app.desk.latest import Latest
from app.desk.persistence import Persistence
from app.desk.translation import data, tr
from core.access.access_table import Act, Level, level_for
from core.access.pins import Hashed, WrongPins, hashed, is_outdated, is_pin
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.store.people import People, PersonRow
from core.store.store_errors import StoreError

NOBODY = "operator"  # in the history, while nobody has signed in
MINUTES = (2, 5, 10, 30, 60)  # without a key or finger after which a level falls back
_USUAL = 10
_WARNED = 30.0  # s before it does
_AGAIN = 1.0  # s between two tries to read people that could not be read
_WRONG, _MINUTES = "wrong PINs", "access minutes"  # settings


@dataclass(slots=True)
class Access:
    """``name`` has signed in, empty: nobody; ``used`` is told of every key and finger."""

    persistence: Persistence = field(default_factory=Persistence)
    say: Callable[[str], None] = lambda _text: None
    clock: Callable[[], float] = time.monotonic
    people: People = field(default_factory=People)
    name: str = ""
    level: Level = Level.OPERATOR
    minutes: int = _USUAL
    wrong: WrongPins = field(default_factory=WrongPins)
    worker: Latest = field(default_factory=lambda: Latest("access"))
    pending: str = ""  # a service reset that is under way, for the header
    reset_look: Callable[[Snapshot], None] = lambda _snapshot: None  # of that reset
    _unread: float | None = None  # when people were tried last, where they could not be read
    _lifted: bool = False  # whether a service reset has ended levels that cannot be read
    _used: float = 0.0
    _warned: bool = False

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
        return tr(Message(text, what=tr(act.value), level=tr(needed.name), now=tr(self.level.name)))

    # --- signing in and out --------------------------------------------------------------------------

    def sign_in(self, row: PersonRow, pin: str) -> None:
        """Try a PIN; the answer comes with a later frame, and wrong ones let wait longer and longer."""
        left = self.wrong.left(self.clock())
        if left > 0.0:
            self.say(tr(Message("TOO MANY WRONG PINS. TRY AGAIN IN {seconds} S", seconds=f"{left:.0f}")))
        elif not row.has_pin:
            self.say(tr(Message("{name} HAS NO PIN. A SERVICE USER MUST SET THE PIN", name=data(row.name))))
        elif not self.worker.busy:
            self.say(tr(Message("CHECKING THE PIN OF {name}", name=data(row.name))))
            self.worker.queue(partial(self._try, row, pin), partial(self._tried, row), self.say)

    def _try(self, row: PersonRow, pin: str) -> bool:
        """On the worker: whether it is the PIN. One that was stored at a lower cost is stored again."""
        kept = Hashed(row.salt, row.hash)
        right = is_pin(pin, kept)
        if right and is_outdated(kept):
            with suppress(StoreError):  # the next time that a PIN is entered it is tried again
                self.persistence.keep_person(PersonRow(row.name, row.level, *hashed(pin)))
        return right

    def _tried(self, row: PersonRow, right: bool) -> None:
        if right:
            self.reload()  # a hash may be new
            self.wrong.right()
            self.name, self.level = row.name, Level(row.level)
            self.used()
            self.note(Message("{row} has signed in: {level}", row=row.name, level=self.level.name))
            self.say(
                tr(Message("{name} HAS SIGNED IN: {level}", name=data(row.name), level=tr(self.level.name)))
            )
        else:
            self.wrong.wrong(self.clock())
            self.note(
                Message(
                    "wrong PIN for {row}; consecutive wrong PINs: {count}",
                    row=row.name,
                    count=self.wrong.count,
                )
            )
            left = self.wrong.left(self.clock())
            text = tr("WRONG PIN FOR {name}. TRY AGAIN IN {seconds} S")
            self.say(tr(Message(text, name=data(row.name), seconds=f"{left:.0f}")))
        self._keep(_WRONG, self.wrong.count or None)

    def sign_out(self, why: str = "") -> None:
        """Nobody is signed in any more: the level is OPERATOR."""
        if self.name:
            self.note(Message("{name} has signed out{why}", name=self.name, why=why))
        self.name, self.level = "", Level.OPERATOR

    # --- time ----------------------------------------------------------------------------------------

    def used(self) -> None:
        """A key or a finger: whoever signed in is there."""
        self._used, self._warned = self.clock(), False

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: what was tried, and whether the level falls back, which is said before."""
        self.worker.poll()
        if self._unread is not None and self.clock() - self._unread >= _AGAIN:
            self.reload()  # a store that was away at the start is there some time, and its levels with it
        self.reset_look(snapshot)
        if not self.name:
            return
        left = self._used + 60.0 * self.minutes - self.clock()
        if left <= 0.0:
            words = tr("{name} SIGNED OUT (NO INPUT). LEVEL: OPERATOR. F10: SIGN IN")
            self.say(tr(Message(words, name=data(self.name))))
            self.sign_out(Message(", after {minutes} min without input", minutes=self.minutes))
        elif left <= _WARNED and not self._warned:
            self._warned = True
            words = tr("{name}: SIGN-OUT IN {seconds} S. PRESS ANY KEY TO STAY SIGNED IN")
            self.say(tr(Message(words, name=data(self.name), seconds=f"{left:.0f}")))

    def choose_minutes(self, minutes: int) -> None:
        """Another time after which a level falls back."""
        self.minutes = minutes
        self._keep(_MINUTES, minutes)
        self.note(Message("automatic sign-out after {minutes} min without input", minutes=minutes))

    # --- people --------------------------------------------------------------------------------------

    def reload(self) -> None:
        """Read who works here, after a change of it or a restore."""
        try:
            self.people = self.persistence.people()
            minutes, wrong = self.persistence.setting(_MINUTES), self.persistence.setting(_WRONG)
        except StoreError:
            self._unread = self.clock()
            if not self._lifted:
                self.people = self.people._replace(damaged=True)  # unknown: the strictest level is in force
            return  # the desk says by itself that nothing can be read
        self._unread = None
        self.minutes = minutes if isinstance(minutes, int) and minutes in MINUTES else _USUAL
        if isinstance(wrong, int) and wrong > self.wrong.count:
            self.wrong = WrongPins(wrong, self.clock())
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

    def _keep(self, key: str, value: object) -> None:
        try:
            self.persistence.save_setting(key, value)
        except StoreError as error:
            self.say(tr(Message("NOT SAVED: {why}", why=error)))

    def close(self) -> None:
        """The desk shuts."""
        self.worker.close()
