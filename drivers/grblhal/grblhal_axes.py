"""Axes of a grblHAL controller, which plans its own motion and therefore accepts no setpoints."""

from __future__ import annotations

from collections.abc import Callable

from core.ports import AxisSample, DriverError, MotionSegments, StopMode
from drivers.grblhal import grblhal_codes, grblhal_scripts
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_transport import GrblTransport
from drivers.wakeups import ConnectionAttempt

_REPORT_TOLERANCE_MM = (
    0.002  # Difference in mm between the end of a block and a report, which has three decimals.
)
_STEPS = 100  # Number of the setting for steps per millimeter.


class GrblAxes:
    """Axis port (``core.ports.AxisSink``) of a grblHAL controller.

    Each call of ``sample`` runs one cycle of the driver.
    """

    commit = 0.0

    def __init__(
        self,
        controller: GrblController,
        blocks: GrblBlocks,
        run_cycle: Callable[[], None],
        reopen: Callable[[], ConnectionAttempt[GrblTransport]],
    ) -> None:
        """Create the axes.

        ``run_cycle`` runs one cycle of the driver, and ``reopen`` starts to reopen the connection.
        """
        self._c = controller
        self._reopen = reopen
        self._blocks = blocks
        self._pump = run_cycle
        self.axes = tuple(axis.name for axis in controller.config.axes)
        self._known = {
            axis.name: axis.has_absolute_encoder or not axis.is_wired for axis in controller.config.axes
        }
        self._wired = {axis.name for axis in controller.wired_axes}
        self._homing = ""

    def now(self) -> float:
        """Return the time of the host's clock in seconds.

        The controller does not have a clock that TurnDesk can read.
        """
        return self._c.clock.now()

    def horizon(self) -> float:
        """Return the current time as the end time, because no setpoints are queued."""
        return self.now()

    def splice(self, segments: MotionSegments) -> None:  # noqa: ARG002  the port's
        """Raise DriverError, because the controller accepts only blocks."""
        raise DriverError(
            "this controller plans its own motion; it accepts blocks, not setpoints", reason="blocks-only"
        )

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:  # noqa: ARG002  at rest only
        """Return the current positions and zero velocities.

        If the exact end of the last block is known, the returned positions are the end of that block.
        """
        return self._places(), (0.0,) * len(self.axes)

    def sample(self) -> AxisSample:
        """Run one cycle of the driver, and return the axis state of the last report."""
        self._pump()
        c = self._c
        if c.has_restarted:
            c.has_restarted = False
            self._mark_not_homed()
        if c.fault or not c.is_position_reliable:
            self._homing = ""
        if self._homing and not c.is_script_running and (c.is_ready or c.is_axis_homed(self._homing)):
            self._known[self._homing], self._homing = True, ""
        places = self._places()
        return AxisSample(
            t=c.last_report_s,
            demand=places,
            actual=places,
            following_error=(0.0,) * len(self.axes),
            enabled=self._blocks.is_motion_enabled and not c.fault,
            homed=tuple(self._is_known(name) for name in self.axes),
            moving=not self._blocks.state().is_at_rest,
            fault=c.fault,
        )

    def enable(self, is_on: bool) -> None:
        """Permit or block motion in the driver.

        Raises DriverError if motion is to be permitted while a fault is active.
        """
        if is_on and self._c.fault:
            raise DriverError(
                "the controller stays locked: {fault}; press Reset first", "no-power", fault=self._c.fault
            )
        self._blocks.is_motion_enabled = is_on

    def stop(self, mode: StopMode) -> None:
        """Abort the motion and, unless ``mode`` is RAMP_HOLD, block further motion."""
        self._blocks.is_motion_enabled = self._blocks.is_motion_enabled and mode is StopMode.RAMP_HOLD
        if self._c.alarm_number not in grblhal_codes.STANDSTILL_ALARMS:
            self._blocks.abort_blocks()

    def home(self, axis: str) -> None:
        """Start to home an axis.

        Raises DriverError if the controller does not have the axis, if motion is not permitted, or if the
        controller cannot start the homing now.
        """
        axes = {each.name: each for each in self._c.config.axes}
        if axis not in axes or not axes[axis].is_wired:
            raise DriverError(
                "the controller does not have an axis {axis} to home", reason="no-axis", axis=f"{axis!r}"
            )
        self._blocks.require_motion_enabled()
        if self._blocks.get_start_refusal_reason() and self._c.alarm_number == 0:
            raise DriverError(
                "{axis} cannot home: {hindrance}",
                "homing",
                axis=axis,
                hindrance=self._blocks.get_start_refusal_reason(),
            )
        self._known[axis], self._homing = False, axis
        self._c.is_position_reliable = True
        self._blocks.start_homing(axis)

    def clear_fault(self) -> None:
        """Reset, unlock and verify the controller, or start to reopen a lost connection.

        If the connection cannot be reopened, the driver sets a new fault with the reason.
        """
        self._blocks.is_motion_enabled = False
        if not self._c.is_position_reliable:
            self._mark_not_homed()
        if self._c.is_lost:
            self._c.reconnect(self._reopen(), lambda: grblhal_scripts.reconnect_controller(self._c))
        elif self._c.fault:
            self._c.fault = ""
            self._c.start_script(grblhal_scripts.recover_from_alarm(self._c))

    def _mark_not_homed(self) -> None:
        """Mark the wired axes as not homed, because their counted positions may be wrong."""
        self._known = {axis.name: not axis.is_wired for axis in self._c.config.axes}

    def _is_known(self, name: str) -> bool:
        """Return whether the machine position of an axis is known.

        If homing is enabled in the controller, the controller reports this. Otherwise the machine file
        specifies it.
        """
        is_homed = self._c.is_axis_homed(name)
        known = self._known[name] if is_homed is None or name not in self._wired else is_homed
        return known and self._c.is_position_reliable and self._homing != name

    def _places(self) -> tuple[float, ...]:
        places = [self._c.position.get(name, 0.0) for name in self.axes]
        rest = self._blocks.last_block_end
        if rest is not None:
            for i, exact in enumerate(rest):
                places[i] = (
                    exact if abs(places[i] - exact) <= self._position_tolerance(self.axes[i]) else places[i]
                )
        return tuple(places)

    def _position_tolerance(self, name: str) -> float:
        """Return half a motor step of the axis plus the rounding error of the reports, in mm."""
        steps = self._c.read_axis_setting(_STEPS, name)
        return max(_REPORT_TOLERANCE_MM, 0.5 / steps + 0.001) if steps else _REPORT_TOLERANCE_MM
