"""Queue of the setpoints that HAL has not received yet."""

from __future__ import annotations

from drivers.setpoint_pieces import MotionPiece
from drivers.spindle_gear import AxisMotion, GearedQueue


class HalQueue(GearedQueue):
    """Setpoint queue whose axes may follow the spindle, until the bridge reports the end of the cam."""

    def calculate_cam_setpoint(self, time_s: float, revolutions: float) -> AxisMotion | None:
        """Return the axis setpoint for one spindle position sample, or None without an active cam."""
        return (
            None if self._gearing is None else self._gearing.calculate_setpoint(time_s, time_s, revolutions)
        )

    def end_cam(self, time_s: float) -> None:
        """End the cam at time ``time_s``, when the time-based motion that follows it has started."""
        if self._gearing is not None:
            self._leave_gearing(time_s, self._gearing)

    def replace_with_braking(self, time_s: float, pieces: list[MotionPiece]) -> None:
        """Replace the queue by a braking ramp that the bridge has executed."""
        if self._gearing is not None:
            self.reset_to_position(pieces[0].positions)
        self.replace_pieces_from(time_s, pieces)
