"""The drives' own limits, the last line behind the control's: setpoints beyond them are refused."""

from __future__ import annotations

from collections.abc import Sequence

from core.ports import Cam, DriverError, Segments
from drivers.simulated.servo import Servo

_STANDS = 10.0  # rpm; faster than this the spindle's drive turns, and cannot position
_SLIPS = 1.1  # of an axis' speed: a spindle that asks for more is refused, one that asks for less slips


def check_limits(segments: Segments, servos: Sequence[Servo], rpm: float) -> None:
    """Raises DriverError for setpoints too fast, out of the travel, or of C while the spindle turns."""
    for i, servo in enumerate(servos):
        axis = servo.axis
        fastest = abs(segments.v[:, i]).max(initial=0.0)
        if fastest > axis.vmax * 1.001 + 0.01:
            raise DriverError(
                f"{axis.name}: setpoints faster than {axis.vmax:.1f}/s; nothing was queued", "drive-limits"
            )
        if axis.name == "C" and not axis.own_drive and fastest > 0.0 and abs(rpm) > _STANDS:
            raise DriverError(f"C: the spindle turns at {rpm:.0f} rpm; nothing was queued", "drive-limits")
        if axis.travel is None or not servo.homed:
            continue
        low, high = axis.travel
        if segments.p[:, i].min(initial=low) < low - 0.01 or segments.p[:, i].max(initial=high) > high + 0.01:
            raise DriverError(
                f"{axis.name}: setpoints leave the travel {low:.2f}…{high:.2f}; nothing queued",
                "drive-limits",
            )


def check_cam(cam: Cam, servos: Sequence[Servo], rpm: float) -> None:
    """The same for motion over the turns of a spindle that turns at ``rpm``."""
    by_time = cam.way.v * (abs(rpm) / 60.0 / _SLIPS)
    check_limits(cam.way._replace(v=by_time), servos, rpm)
    if cam.then is not None:
        check_limits(cam.then, servos, rpm)
