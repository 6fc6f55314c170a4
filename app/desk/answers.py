"""What the desk answers on the prompt line: to the last key, to a refused start, to a disk that fails."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from core.executor.snapshot import Event, Snapshot, State

HEARD = 100  # events that wait for the next frame; older ones are in the log


YES = "Y"
READ = 0.5  # s: sooner nobody has read a question, and what is pressed is meant for something else


@dataclass(slots=True)
class Answers:
    """One answer at a time; it stays until the next key or the next state of the machine.

    An answer may be a question: what is lost for good is done by a key of its own, and never by the key that
    asked. ``clock`` is monotonic.
    """

    snapshot: Callable[[], Snapshot]
    unkept: Callable[[], str]  # why events, parts and versions are not being kept; empty while they are
    clock: Callable[[], float]
    notice: str = ""
    asked: Callable[[], None] | None = None  # what yes does now
    key: str = YES  # that means yes
    _since: float = 0.0
    _in: State | None = None
    _refused: str = ""
    _unkept: str = ""
    _heard: deque[Event] = field(default_factory=lambda: deque(maxlen=HEARD))

    def say(self, text: str) -> None:
        """Put an answer on the prompt line."""
        self.notice, self.asked = text, None
        self._in = self.snapshot().state

    def ask(self, question: str, yes: Callable[[], None], key: str = YES) -> None:
        """Ask on the prompt line; asked again it is the same question, and no answer."""
        if self.asked is not None and self.notice == question:
            return
        self.say(question)
        self.asked, self.key, self._since = yes, key, self.clock()

    def read(self, at: float) -> bool:
        """Whether a question stands, and has stood long enough at this time to have been read."""
        return self.asked is not None and at - self._since >= READ

    def yes(self, at: float) -> None:
        """Yes was pressed ``at`` this time: do what is asked, or take a question back that was not read."""
        asked, read = self.asked, self.read(at)
        self.take_back()
        if asked is not None and read:
            asked()

    def take_back(self) -> None:
        """Nothing is said or asked any more."""
        self.notice, self.asked = "", None

    def outlived(self, snapshot: Snapshot) -> bool:
        """Whether the answer belongs to a state that is over."""
        return bool(self.notice) and snapshot.state is not self._in

    def hear(self, event: Event) -> None:
        """What the executor has to say; it may be called from its thread."""
        self._heard.append(event)

    def starting(self) -> None:
        """A start is tried: the same refusal again is worth saying again."""
        self._refused = ""

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: nothing is refused in silence, a start or whatever else the executor would not do."""
        while self._heard:
            event = self._heard.popleft()
            if event.kind == "refused" and event.text != snapshot.start_refused:
                self.say(f"REFUSED: {event.text}")
            elif event.kind == "uncounted":
                self.say(f"NOT COUNTED AS A PART: {event.text}")
        if snapshot.start_refused != self._refused:
            self._refused = snapshot.start_refused
            if self._refused:
                self.say(f"NO START: {self._refused}")
        self._tell_unkept()

    def _tell_unkept(self) -> None:
        """A disk that fails in the middle of a run is told once, not found out the day after."""
        trouble = self.unkept()
        if trouble != self._unkept:
            if self.notice == f"NOT KEPT: {self._unkept}":
                self.notice = ""  # it is not so any more
            self._unkept = trouble
            if trouble:
                self.say(f"NOT KEPT: {trouble}")
