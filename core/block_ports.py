"""The interface of a controller with its own planner, and the operations of the blocks that it receives."""

from __future__ import annotations

from typing import NamedTuple, Protocol


class RapidOperation(NamedTuple):
    """Straight to ``x z``, as fast as the rapid rate in force allows."""

    x: float
    z: float
    rapid_rate: float


class LineOperation(NamedTuple):
    """Straight to ``x z`` at a feed."""

    x: float
    z: float
    feed: float


class ArcOperation(NamedTuple):
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


class ThreadOperation(NamedTuple):
    """One pass of a thread from ``x0 z0`` to ``x z``, tied to the spindle's index.

    ``lead`` is mm a turn along Z.
    """

    x0: float
    z0: float
    x: float
    z: float
    lead: float


BlockOperation = RapidOperation | LineOperation | ArcOperation | ThreadOperation


class BlockState(NamedTuple):
    """What the controller does with its blocks at one instant.

    ``start_refusal`` says in words why nothing may be begun, such as modes that are still being verified.
    """

    last_done_ticket: int  # every ticket up to this one has been moved to its end
    active_ticket: int  # the ticket that is being moved, 0 unknown or none
    is_at_rest: bool  # nothing moves, and nothing is left in the controller
    is_in_feed_hold: bool  # at rest inside its queue: ``resume`` goes on
    start_refusal: str = ""


class BlockController(Protocol):
    """A controller with a planner of its own. Nothing here waits.

    ``capabilities`` tells what it can do of ``core.interpreter.shared.machine_requirements``; what it cannot
    is refused before the start. ``max_lead_s`` is how many seconds of motion it may be given beyond the block
    that it moves: it goes on by itself when the host is lost.
    """

    max_lead_s: float
    css_max_rpm: (
        float  # rpm up to which the spindle can follow the radius: 0 while it is not laid out for that
    )

    def prepare_css(self, max_rpm: float) -> None:
        """Up to so many rpm the spindle will have to follow the radius; 0: its speed is constant. Said before
        each speed, so that a driver whose spindle has steps can choose what they count from.
        """
        ...

    def max_line_speed(self, dx: float, dz: float) -> float:
        """mm/s of a straight way in this direction on which no slide is faster than controller and machine
        file allow it.
        """
        ...

    @property
    def capabilities(self) -> frozenset[str]:
        """What it can do, by the names of ``machine_requirements``."""
        ...

    def submit_block(self, operation: BlockOperation) -> int | None:
        """Hand a block over: its ticket, or None while it takes no more. Raises DriverError."""
        ...

    def state(self) -> BlockState:
        """How far it has come, as last told; from memory, at once."""
        ...

    def hold_on_path(self) -> None:
        """Come to rest on the path; a thread pass first ends."""
        ...

    def resume(self) -> None:
        """Go on from a hold. Never starts a spindle."""
        ...

    def abort_blocks(self) -> None:
        """Come to rest and forget every block; ``state().resting`` once that is done."""
        ...

    def set_overrides(self, feed_fraction: float, rapid_fraction: float) -> None:
        """Fractions of the programmed speeds, above 0; verified by the driver."""
        ...

    def start_jog(
        self, axis: str, velocity: float, lease_s: float, limits: tuple[float, float] | None
    ) -> bool:
        """Begin or renew: no way is queued beyond the lease. False when there is none before ``limits``.

        Raises DriverError.
        """
        ...

    def step_to(self, axis: str, target: float, speed: float) -> None:
        """One step from rest to rest. Raises DriverError."""
        ...

    def stop_jog(self) -> None:
        """Come to rest at once."""
        ...
