"""The service reset at the desk: who has forgotten every PIN is not locked out for ever.

It takes the machine's own E-stop, pressed for ten minutes; nothing can be made meanwhile, everybody sees it,
and the log keeps when it was begun, given up or done.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.access import Access
from app.desk.translation import tr
from app.extras.access.sign_in import SignIn
from core.executor.snapshot import Snapshot, State
from core.message import Message

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
