"""A held jog: a slide moves by hand only while one key or finger is held, and is seen to be held.

Everything that is not exactly that ends the move: the release, the loss of the keyboard, another key, a
second finger, a changed increment, a screen that was away, a key that has gone silent. After such an end
nothing moves before everything is let go and pressed anew.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.translation import tr
from app.jog.jog_speeds import CONTINUOUS, JogSpeeds
from app.offsets.offset_values import Mode
from core.executor.commands import Command, Jog, JogStep, JogStop
from core.executor.hand_motion.jog_line import Direction
from core.executor.snapshot import Snapshot, State

BEGINS = 0.3  # s within which the machine must have begun to move
SILENT = 0.5  # s without another repeat of a key that repeats: its release was lost
RENEWED = 4  # times in a lease


@dataclass(slots=True)
class Held:
    """One jog that is held."""

    source: str
    axis: str
    velocity: float
    rapid: bool
    since: float
    posted: float
    looked: float
    repeated: float | None = None  # when the key last repeated, None: it has not yet
    moving: bool = False
    along: Direction | None = None


@dataclass(slots=True)
class HeldJog:
    """``lease`` seconds; ``barred`` tells why nothing is jogged now; ``clock`` is monotonic."""

    speeds: JogSpeeds
    lease: float
    post: Callable[[Command], None]
    say: Callable[[str], None]
    clear: Callable[[], None]
    clock: Callable[[], float]
    barred: Callable[[], str]
    mode: Mode = field(default_factory=Mode)
    along: Callable[[str], Direction | None] = field(default=lambda _axis: None)  # of a tilted plane (3D-ROT)
    held: Held | None = None
    rapid_armed: bool = False  # by the key RAPID on the screen: for the next jog only
    button: str = ""  # the input that the last press came from, where a button beside the slides did
    down: set[str] = field(default_factory=set)  # keys and fingers that were pressed and not let go yet
    _ended: str = ""  # why the last one ended, to be said once more when the slide rests

    def press(self, source: str, axis: str, sign: int, *, rapid: bool, button: str = "") -> None:
        """A key or finger goes down on a direction, or a ``button`` beside the slides: its input's name."""
        others, self._ended = self.down - {source}, ""
        self.rapid_armed = False
        self.down.add(source)
        if others or self.held is not None:
            self.stop(tr("TWO KEYS PRESSED, JOG STOPPED. RELEASE BOTH, THEN PRESS ONE"))
        elif why := self.barred():
            self.say(why)
        else:
            self.button = button
            self._go(source, axis, sign, rapid)

    def _go(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        """What one press alone begins."""
        if self.speeds.step != CONTINUOUS:
            self._step(axis, sign, rapid)
        else:
            self._begin(source, axis, sign, rapid)

    def _step(self, axis: str, sign: int, rapid: bool) -> None:
        """One step, which is its own length and not longer by being held."""
        if rapid:
            self.say(tr("RAPID NEEDS CONTINUOUS JOG. SELECT CONT OR RELEASE SHIFT"))
            return
        self.clear()
        distance = sign * self.speeds.distance(axis, self.mode)
        self.post(JogStep(axis, distance, self.speeds.step_speed(axis), self.along(axis)))

    def _begin(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        velocity = sign * self.speeds.velocity(axis, self.mode, rapid=rapid)
        along = self.along(axis)
        self._hold(source, axis, velocity, rapid, Jog(axis, velocity, self.lease, self.button, along))

    def _hold(self, source: str, axis: str, velocity: float, rapid: bool, command: Command) -> None:
        self.clear()
        now = self.clock()
        along = command.along if isinstance(command, Jog) else None
        self.held = Held(source, axis, velocity, rapid, now, now, now, along=along)
        self.post(command)

    def repeated(self, source: str) -> None:
        """A held key repeats by itself: it is still down."""
        if self.held is not None and self.held.source == source:
            self.held.repeated = self.clock()

    def release(self, source: str) -> None:
        """A key or finger comes up."""
        self.down.discard(source)
        if self.held is not None and self.held.source == source:
            self.stop("")

    def other_key(self) -> None:
        """Another key goes down: whoever reaches for it does not look at the slide."""
        if self.held is not None:
            self.stop(tr("JOG STOPPED: ANOTHER KEY WAS PRESSED"))

    def shift_released(self) -> None:
        """A rapid does not go on without its Shift, nor slower."""
        if self.held is not None and self.held.rapid:
            self.stop(tr("SHIFT RELEASED. RAPID STOPPED"))

    def let_go(self, why: str = "") -> None:
        """Hands off everything: no release will arrive any more."""
        self.down.clear()
        if self.held is not None:
            self.stop(why)

    def stop(self, why: str) -> None:
        """End the jog; nothing moves before all is let go."""
        if self.held is not None:
            self.held = None
            self.post(JogStop())
        if why:
            self._ended = why
            self.say(why)

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: renew the lease while everything is as it should be, or let it go."""
        self.mode = Mode(snapshot.modal.metric, snapshot.reads_diameter)
        held, now = self.held, self.clock()
        if held is None:
            self._say_again(snapshot)
            return
        away, held.looked = now - held.looked, now
        if away > self.lease:
            self.stop(tr("SCREEN FROZE. JOG STOPPED"))
        elif held.repeated is not None and now - held.repeated > SILENT:
            self.stop(tr("JOG KEY SIGNAL LOST. RELEASE THE KEY, THEN PRESS IT AGAIN"))
        elif snapshot.state is State.JOG:
            held.moving = True
            self._renew(held, now)
        elif held.moving or snapshot.state is not State.IDLE or now - held.since > BEGINS:
            self.held = None  # the machine has ended it, or never began
            self.post(JogStop())

    def _say_again(self, snapshot: Snapshot) -> None:
        """An answer goes when the state changes; this one came while the slide still moved."""
        if self._ended and snapshot.state is not State.JOG:
            self.say(self._ended)
            self._ended = ""

    def _renew(self, held: Held, now: float) -> None:
        if now - held.posted >= self.lease / RENEWED:
            held.posted = now
            self.post(self._renewal(held))

    def _renewal(self, held: Held, /) -> Command:
        return Jog(held.axis, held.velocity, self.lease, self.button, held.along)
