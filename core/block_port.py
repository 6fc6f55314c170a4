"""What a controller that plans by itself must offer: blocks go in, tickets and states come out.

Lengths are mm in the machine frame (X a radius), speeds mm/s.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol


class RapidOp(NamedTuple):
    """Straight to ``x z``, as fast as the rapid rate in force allows."""

    x: float
    z: float
    rate: float


class LineOp(NamedTuple):
    """Straight to ``x z`` at a feed."""

    x: float
    z: float
    feed: float


class ArcOp(NamedTuple):
    """On a circle about ``cx cz`` to ``x z``. ``clockwise`` as elementary blocks say it: from Z+ to X+.

    ``x0 z0`` is where it begins.
    """

    x0: float
    z0: float
    x: float
    z: float
    cx: float
    cz: float
    clockwise: bool
    feed: float


class ThreadOp(NamedTuple):
    """One pass of a thread from ``x0 z0`` to ``x z``, tied to the spindle's index.

    ``lead`` is mm a turn along Z.
    """

    x0: float
    z0: float
    x: float
    z: float
    lead: float


BlockOp = RapidOp | LineOp | ArcOp | ThreadOp


class BlockState(NamedTuple):
    """What the controller does with its blocks at one instant.

    ``hindrance`` says in words why nothing may be begun, such as modes that are still being verified.
    """

    done: int  # every ticket up to this one has been moved to its end
    active: int  # the ticket that is being moved, 0 unknown or none
    resting: bool  # nothing moves, and nothing is left in the controller
    held: bool  # at rest inside its queue: ``resume`` goes on
    hindrance: str = ""


class BlockSink(Protocol):
    """A controller with a planner of its own. Nothing here waits.

    ``caps`` tells what it can do of ``core.interpreter.machine_requirements``; what it cannot is refused
    before the start. ``ahead`` is how many seconds of motion it may be given beyond the block that it
    moves: it goes on by itself when the host is lost.
    """

    ahead: float

    @property
    def fastest(self) -> float:
        """What the controller itself allows its slides, mm/s: its slowest axis."""
        ...

    @property
    def caps(self) -> frozenset[str]: ...

    def submit(self, op: BlockOp) -> int | None:
        """Hand a block over: its ticket, or None while it takes no more. Raises DriverError."""
        ...

    def state(self) -> BlockState: ...

    def hold(self) -> None:
        """Come to rest on the path; a thread pass first ends."""
        ...

    def resume(self) -> None:
        """Go on from a hold. Never starts a spindle."""
        ...

    def abort(self) -> None:
        """Come to rest and forget every block; ``state().resting`` once that is done."""
        ...

    def override(self, feed: float, rapid: float) -> None:
        """Fractions of the programmed speeds, above 0; verified by the driver."""
        ...

    def jog(self, axis: str, velocity: float, lease: float, limits: tuple[float, float] | None) -> bool:
        """Begin or renew: no way is queued beyond the lease. False when there is none before ``limits``.

        Raises DriverError.
        """
        ...

    def jog_to(self, axis: str, target: float, speed: float) -> None:
        """One step from rest to rest. Raises DriverError."""
        ...

    def jog_stop(self) -> None:
        """Come to rest at once."""
        ...
