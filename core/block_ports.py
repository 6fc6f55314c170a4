"""Interface of a motion controller with its own planner, and the operations that it executes."""

from __future__ import annotations

from typing import NamedTuple, Protocol


class RapidOperation(NamedTuple):
    """A straight rapid move to ``x z``, at the active rapid rate."""

    x: float
    z: float
    rapid_rate: float


class LineOperation(NamedTuple):
    """A straight move to ``x z`` at a feed rate."""

    x: float
    z: float
    feed: float


class ArcOperation(NamedTuple):
    """An arc from ``start_x start_z`` to ``x z`` around the center ``center_x center_z``.

    ``is_clockwise`` is defined as in elementary blocks: clockwise is the direction from Z+ to X+.
    """

    start_x: float
    start_z: float
    x: float
    z: float
    center_x: float
    center_z: float
    is_clockwise: bool
    feed: float


class ThreadOperation(NamedTuple):
    """One threading pass from ``start_x start_z`` to ``x z``, synchronized with the spindle index.

    ``lead_mm`` is the travel along Z per revolution, in millimeters.
    """

    start_x: float
    start_z: float
    x: float
    z: float
    lead_mm: float


BlockOperation = RapidOperation | LineOperation | ArcOperation | ThreadOperation


class BlockState(NamedTuple):
    """The state of a block controller and its block queue at one instant.

    ``start_refusal_reason`` is the reason why no motion can start, for example because modes are still being
    verified. It is empty if motion can start.
    """

    last_completed_ticket: int  # every ticket up to this one has been moved to its end
    active_ticket: int  # the ticket that is being moved, 0 unknown or none
    is_at_rest: bool  # nothing moves, and nothing is left in the controller
    is_in_feed_hold: bool  # at rest inside its queue: ``resume`` continues
    start_refusal_reason: str = ""


class BlockController(Protocol):
    """A motion controller with its own planner.

    No method waits. ``capabilities`` contains the supported functions, as names from
    ``core.interpreter.shared.machine_requirements``. A program that needs any other function is rejected
    before it starts. ``max_queued_motion_s`` is the longest motion in seconds that may be queued after the
    active block. If the connection to TurnDesk is lost, the controller still executes this motion.
    """

    max_queued_motion_s: float
    css_max_rpm: (
        float  # rpm up to which the spindle can follow the radius: 0 while it is not laid out for that
    )

    def announce_css_max_rpm(self, max_rpm: float) -> None:
        """Announce the highest spindle speed in rpm that constant surface speed (CSS) may require.

        The driver can then select a speed range. ``max_rpm`` is 0 if the spindle speed is constant. This
        method is called before each speed command.
        """
        ...

    def get_max_directional_speed(self, x_component: float, z_component: float) -> float:
        """Return the highest speed along a straight line in this direction, in mm/s.

        At this speed no axis exceeds the limits of the controller and of the machine file.
        """
        ...

    @property
    def capabilities(self) -> frozenset[str]:
        """Return the supported functions, as names from ``machine_requirements``."""
        ...

    def submit_block(self, block: BlockOperation) -> int | None:
        """Submit a block; return its ticket number, or None if the block cannot be accepted now.

        Raises DriverError if the driver fails.
        """
        ...

    def state(self) -> BlockState:
        """Return the last reported state from memory, without waiting."""
        ...

    def stop_on_path(self) -> None:
        """Stop on the path (feed hold). A threading pass is completed first."""
        ...

    def resume(self) -> None:
        """Resume motion after a feed hold. This method never starts the spindle."""
        ...

    def abort_blocks(self) -> None:
        """Stop motion and discard all blocks; ``state().is_at_rest`` becomes True afterwards."""
        ...

    def set_overrides(self, feed_fraction: float, rapid_fraction: float) -> None:
        """Set the overrides as factors of the programmed speeds, greater than 0.

        The driver verifies that the controller has accepted them.
        """
        ...

    def start_jog(
        self, axis: str, velocity: float, lease_s: float, limits: tuple[float, float] | None
    ) -> bool:
        """Start a jog or renew its lease; return False if no travel remains within ``limits``.

        No motion is queued that lasts longer than the lease. Raises DriverError if the driver fails.
        """
        ...

    def move_to_target(self, axis: str, target: float, speed: float) -> None:
        """Move an axis to ``target``, starting and ending at rest.

        Raises DriverError if the move cannot be started.
        """
        ...

    def stop_jog(self) -> None:
        """Stop the jog immediately."""
        ...
