"""Transfer of setpoints in profile position mode (PP), or of one setpoint per SYNC (CSP or IP).

Mode IP uses object 60C1h for the setpoints.

With one setpoint per SYNC, a drive moves linearly from setpoint to setpoint in the time of object 60C2h and
stops at the last setpoint. After a late SYNC, the path continues without a jump and then runs 2 % faster
until the delay is recovered. A delay of more than 10 ms is a fault, because the drives have then stopped
during a cut.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from core.ports import DriverError, Fault, MotionSegments, is_queue_finished
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_nodes import MAX_SYNC_DELAY_FRACTION
from drivers.canopen.canopen_objects import AT_ONCE, BIT_12, IP, NEW, PP
from drivers.canopen.drive_set import DrivenAxis
from drivers.setpoint_queue import SetpointQueue


class SetpointFollower(ABC):
    """Base class of objects that make the drives follow the setpoint queue.

    The drives start from their current positions.
    """

    cia402_mode: int  # Mode of CiA 402.

    def __init__(self, axes: Sequence[DrivenAxis], axis_indices: Sequence[int], queue: SetpointQueue) -> None:
        """Create the follower; ``axis_indices`` are the indices of the axes in the queue."""
        self._axes = axes
        self._indices = axis_indices
        self._queue = queue
        self.failure: Fault | str = ""  # Reason why the drives cannot follow the queue.
        self.must_send_now = False  # The commands must be sent in this tick.
        self.max_deviation_counts = 0.0  # Largest unavoidable deviation in counts.

    @property
    def is_executing(self) -> bool:
        """Return whether the drives are still executing transferred setpoints."""
        return False

    def get_path_time(self, time_s: float) -> float:
        """Return the time in the setpoint queue that the drives had reached at time ``time_s``."""
        return time_s

    def check_segments(self, segments: MotionSegments) -> None:
        """Raise DriverError if the drives cannot follow ``segments``.

        This default implementation accepts any path.
        """

    def handle_braking(self, brake_time_s: float) -> None:
        """Adapt to a braking ramp that replaced the queued setpoints from ``brake_time_s`` on.

        This default implementation does nothing, because the next call of ``transfer_setpoints`` transfers
        the braking setpoints.
        """

    @abstractmethod
    def transfer_setpoints(self, now: float) -> None:
        """Transfer setpoints; call this method once per tick before the commands are sent."""

    def prepare_targets(self) -> None:
        """Set the targets to the current positions before the drives are switched on."""
        for axis in self._axes:
            axis.drive.target_value = axis.drive.position

    def abort_transfer(self) -> None:
        """Stop transferring setpoints; the drives stop on their own, without setpoints."""
        self.failure = ""


# --- Profile position: the drive plans jogs and single moves, for drives without a path queue.


_ACKNOWLEDGE_TIMEOUT_S = 0.2  # Seconds in which a drive must acknowledge a target.


class ProfilePositionFollower(SetpointFollower):
    """Follower that sends the end position of the queue to each drive as its target.

    Each drive also receives the speed of the path. Only straight moves are possible, because each drive
    plans its own motion.
    """

    cia402_mode = PP

    def __init__(self, axes: Sequence[DrivenAxis], axis_indices: Sequence[int], queue: SetpointQueue) -> None:
        super().__init__(axes, axis_indices, queue)
        self._pending: tuple[float, MotionSegments | None] | None = None
        self._told = -1.0

    @property
    def is_executing(self) -> bool:
        """Return whether a target has not been sent yet or has not been acknowledged yet."""
        return self._pending is not None or self._told >= 0.0

    def check_segments(self, segments: MotionSegments) -> None:
        """Check that a move is straight, and store its end as the next target.

        Raises DriverError if the path is not straight.
        """
        dt = segments.durations_s[-1]
        end = segments.positions[-1] + (segments.velocities[-1] + 0.5 * segments.accelerations[-1] * dt) * dt
        displacement = end - segments.positions[0]
        length = float(np.linalg.norm(displacement))
        along = displacement / length if length > 0.0 else displacement
        off = segments.positions - segments.positions[0]
        off = off - np.outer(off @ along, along)
        limit = max(axis.config.count for axis in self._axes)
        if float(np.abs(off).max()) > limit:
            raise DriverError(
                'the drives plan only single straight moves ([canopen] mode = "pp"); to run '
                'programs, set mode to "csp" or "ip", or to "pvt" for drives with a queue',
                "drive-limits",
                reason="one-move-only",
            )
        self._pending = (float(segments.start_times_s[0]), segments)

    def handle_braking(self, brake_time_s: float) -> None:
        """Set the end of the braking ramp as the pending target, with the maximum deceleration."""
        self._pending = (brake_time_s, None)

    def prepare_targets(self) -> None:
        """Discard the pending target and set the targets to the current positions."""
        self._pending = None
        super().prepare_targets()

    def abort_transfer(self) -> None:
        """Discard the pending target, and stop waiting for an acknowledgment."""
        self._pending, self._told, self.failure = None, -1.0, ""
        for axis in self._axes:
            axis.drive.mode_bits &= ~(NEW | AT_ONCE)

    def transfer_setpoints(self, now: float) -> None:
        """Send the pending target when it is due, and then wait for the acknowledgment."""
        if self._told >= 0.0:
            self._await_acknowledgment(now)
        elif self._pending is not None and now >= self._pending[0]:
            _, segments = self._pending
            self._pending, self._told = None, now
            self._hand_over(segments)

    def _hand_over(self, segments: MotionSegments | None) -> None:
        rest, _ = self._queue.get_commanded_state(float("inf"))
        self.must_send_now = True
        for axis, i in zip(self._axes, self._indices, strict=True):
            config, drive = axis.config, axis.drive
            accel = config.amax
            if segments is not None:
                speed = config.convert_to_drive_speed(float(np.abs(segments.velocities[:, i]).max()))
                accel = float(np.abs(segments.accelerations[:, i]).max())
                drive.setup.write(od.PROFILE_SPEED, 0, max(round(speed), 1))
            drive.setup.write_optional_object(
                od.PROFILE_ACCEL, 0, config.convert_to_drive_acceleration(accel)
            )
            drive.setup.write_optional_object(
                od.PROFILE_DECEL, 0, config.convert_to_drive_acceleration(accel)
            )
            drive.target_value = config.convert_position(rest[i])
            drive.mode_bits |= NEW | AT_ONCE

    def _await_acknowledgment(self, now: float) -> None:
        """Clear bit 4 of the control word after all drives have acknowledged the target.

        A drive acknowledges the target by bit 12 of its status word.
        """
        late = [a.config.name for a in self._axes if not a.drive.status_word & BIT_12]
        if not late:
            self._told = -1.0
            for axis in self._axes:
                axis.drive.mode_bits &= ~(NEW | AT_ONCE)
        elif now - self._told > _ACKNOWLEDGE_TIMEOUT_S:
            self.failure = self.failure or Fault(
                "{late}: the drive did not accept its target position", "axis", late=", ".join(late)
            )


# --- One setpoint per SYNC: cyclic synchronous position, and interpolated position.


MAX_SETPOINT_GAP_S = 0.01  # Seconds without a setpoint in motion; more is a fault.
_RECOVERY_FRACTION = 0.02  # Fraction of a period, per period.
_START_TIMEOUT_S = 0.3  # Seconds in which a drive must start to interpolate.


class SyncSchedule:
    """Schedule of SYNC times, which stays in phase even if one SYNC is late."""

    def __init__(self, period_s: float, now: float) -> None:
        self.period_s = period_s
        self.due_time_s = now
        self.max_delay_s = 0.0  # Largest delay in s since the last report.
        self._late = 0.0  # Delay of the last SYNC.

    def record_sync(self, now: float) -> float:
        """Record a SYNC at time ``now``, and return by how many seconds it delayed the drives.

        The result is 0 if the drives tolerate the delay, and while the SYNCs return to the schedule.
        """
        late = max(now - self.due_time_s, 0.0)
        self.max_delay_s = max(self.max_delay_s, late)
        longer = late - self._late if late > MAX_SYNC_DELAY_FRACTION * self.period_s else 0.0
        missed = int(late / self.period_s + 1e-6)
        self._late = late - missed * self.period_s
        self.due_time_s += (missed + 1) * self.period_s
        return max(longer, 0.0)


class CyclicSetpointFollower(SetpointFollower):
    """Follower that sends one setpoint per SYNC in mode CSP or IP.

    Mode IP must be started by bit 4 of the control word and is confirmed by bit 12 of the status word.
    """

    def __init__(
        self,
        axes: Sequence[DrivenAxis],
        axis_indices: Sequence[int],
        queue: SetpointQueue,
        mode: int,
        schedule: SyncSchedule,
    ) -> None:
        super().__init__(axes, axis_indices, queue)
        self.cia402_mode = mode
        self.schedule = schedule
        self.lag_s = 0.0  # Delay of the path relative to the clock in s.
        self._fed = -math.inf  # Time in the queue up to which the drives have setpoints.
        self.gap_count = 0  # Number of times that the drives waited at a setpoint in motion.
        self._asked: float | None = None  # Time of the start command for interpolation in s.
        queue.get_transferred_until = lambda: self._fed

    @property
    def is_executing(self) -> bool:
        """Return whether the drives have not reached the end of the queue yet."""
        return self.lag_s > 0.0 and not is_queue_finished(
            self._queue.get_end_time(-1e9), self.get_path_time(self.schedule.due_time_s)
        )

    def get_path_time(self, time_s: float) -> float:
        """Return the time in the setpoint queue at ``time_s``, which is ``time_s`` minus the lag."""
        return time_s - self.lag_s

    def abort_transfer(self) -> None:
        """Stop transferring setpoints and reset the lag of the path to 0."""
        self.lag_s, self.failure, self._asked = 0.0, "", None
        for axis in self._axes:
            axis.drive.mode_bits &= ~NEW

    def delay_path(self, waited_s: float) -> None:
        """Delay the path by ``waited_s`` seconds, for which the drives waited at a setpoint.

        If the total delay is too long, a fault is set.
        """
        if is_queue_finished(
            self._queue.get_end_time(-1e9), self.get_path_time(self.schedule.due_time_s) - waited_s
        ):
            self.lag_s = 0.0
            return
        self.gap_count += 1
        self.lag_s += waited_s
        if self.lag_s > MAX_SETPOINT_GAP_S:
            self.failure = self.failure or Fault(
                "setpoints were {lag} ms late because this computer stalled for too long",
                "queue-dry",
                lag=f"{1000 * self.lag_s:.0f}",
            )

    def transfer_setpoints(self, now: float) -> None:
        """Set the targets for the next SYNC; the drives reach these targets one SYNC later."""
        standing = is_queue_finished(self._queue.get_end_time(-1e9), self.get_path_time(now))
        self.lag_s = 0.0 if standing else max(self.lag_s - _RECOVERY_FRACTION * self.schedule.period_s, 0.0)
        self._fed = self.get_path_time(self.schedule.due_time_s + self.schedule.period_s)
        p, _ = self._queue.get_commanded_state(self._fed)
        for axis, index in zip(self._axes, self._indices, strict=True):
            axis.drive.target_value = axis.config.convert_position(p[index])
        if self.cia402_mode == IP:
            self._interpolate(now)

    def _interpolate(self, now: float) -> None:
        """Start interpolation by bit 4 of the control word; set a fault if a drive does not start."""
        if self._asked is None:
            self._asked = now
            for axis in self._axes:
                axis.drive.mode_bits |= NEW
        stand = [a.config.name for a in self._axes if not a.drive.status_word & BIT_12]
        if stand and now - self._asked > _START_TIMEOUT_S:
            self.failure = self.failure or Fault(
                "{stand}: the drive did not start interpolated motion", "queue-dry", stand=", ".join(stand)
            )
