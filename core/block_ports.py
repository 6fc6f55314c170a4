"""Interface of a controller with its own planner, and the block operations that it executes."""

from __future__ import annotations

from typing import NamedTuple, Protocol


class RapidOperation(NamedTuple):
    """A straight rapid move to ``x z`` as fast as the active rapid rate allows."""

    x: float
    z: float
    rapid_rate: float


class LineOperation(NamedTuple):
    """A straight move to ``x z`` at a feed."""

    x: float
    z: float
    feed: float


class ArcOperation(NamedTuple):
    """An arc from ``start_x start_z`` to ``x z`` around the center ``center_x center_z``.

    ``is_clockwise`` has the same meaning as in elementary blocks: the direction from Z+ to X+.
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
    """One thread pass from ``start_x start_z`` to ``x z``, synchronized with the spindle's index pulse.

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

    ``start_refusal`` is the reason why no motion can start, such as modes that are still being verified, or
    an empty string if motion can start.
    """

    last_done_ticket: int  # every ticket up to this one has been moved to its end
    active_ticket: int  # the ticket that is being moved, 0 unknown or none
    is_at_rest: bool  # nothing moves, and nothing is left in the controller
    is_in_feed_hold: bool  # at rest inside its queue: ``resume`` continues
    start_refusal: str = ""


class BlockController(Protocol):
    """A motion controller with its own planner. None of its functions wait.

    ``capabilities`` contains the supported names from ``core.interpreter.shared.machine_requirements``. A
    program that needs an unsupported function is rejected before the start. ``max_lead_s`` is the maximum
    time of motion, in seconds, that may be queued after the active block. The controller continues this
    motion on its own if it loses the host.
    """

    max_lead_s: float
    css_max_rpm: (
        float  # rpm up to which the spindle can follow the radius: 0 while it is not laid out for that
    )

    def prepare_css(self, max_rpm: float) -> None:
        """Announce the highest rpm that constant surface speed may require.

        ``max_rpm`` is 0 for a constant spindle speed. Otherwise the spindle speed follows the radius up to
        ``max_rpm``. The method is called before each speed command, so that a driver with speed ranges can
        select the range.
        """
        ...

    def get_max_line_speed(self, x_component: float, z_component: float) -> float:
        """Return the highest speed along a straight line in this direction, in mm/s.

        At this speed no axis exceeds the limits of the controller and of the machine file.
        """
        ...

    @property
    def capabilities(self) -> frozenset[str]:
        """Return the supported functions, as names from ``machine_requirements``."""
        ...

    def submit_block(self, block: BlockOperation) -> int | None:
        """Submit a block; return its ticket, or None if the controller cannot accept a block now.

        Raises DriverError if the driver fails.
        """
        ...

    def state(self) -> BlockState:
        """Return the last reported state from memory, without waiting."""
        ...

    def hold_on_path(self) -> None:
        """Stop on the path, but finish a thread pass first."""
        ...

    def resume(self) -> None:
        """Resume motion after a hold. This function never starts the spindle."""
        ...

    def abort_blocks(self) -> None:
        """Stop and discard all blocks; ``state().is_at_rest`` is True when this is complete."""
        ...

    def set_overrides(self, feed_fraction: float, rapid_fraction: float) -> None:
        """Set the overrides as fractions of the programmed speeds, greater than 0.

        The driver verifies that the controller has accepted them.
        """
        ...

    def start_jog(
        self, axis: str, velocity: float, lease_s: float, limits: tuple[float, float] | None
    ) -> bool:
        """Start a jog or renew its lease; return False if no travel remains before ``limits``.

        No motion is queued beyond the end of the lease. Raises DriverError if the driver fails.
        """
        ...

    def move_by_step(self, axis: str, target: float, speed: float) -> None:
        """Move an axis to ``target`` in one step from rest to rest. Raises DriverError if this fails."""
        ...

    def stop_jog(self) -> None:
        """Stop the jog immediately."""
        ...
