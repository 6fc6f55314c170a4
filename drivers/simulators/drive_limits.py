"""The drives' own limits, the last line behind the control's: setpoints beyond them are refused."""

from __future__ import annotations

from collections.abc import Sequence

from core.message import Message
from core.ports import Cam, DriverError, Segments
from drivers.setpoint_queue import check_limits
from drivers.simulators.servo_axis import Servo

_STANDS = 10.0  # rpm; faster than this the spindle's drive turns, and cannot position
_SLIPS = 1.1  # of an axis' speed: a spindle that asks for more is refused, one that asks for less slips


def check_drives(segments: Segments, servos: Sequence[Servo], rpm: float) -> None:
    """Raises DriverError for setpoints too fast, out of the travel, or of C while the spindle turns."""
    axes = [servo.axis for servo in servos]
    check_limits(segments, axes, [servo.homed for servo in servos], [servo.reading for servo in servos])
    for i, axis in enumerate(axes):
        if axis.name == "C" and not axis.own_drive and abs(rpm) > _STANDS and segments.v[:, i].any():
            raise DriverError(
                Message(
                    "C axis: the spindle is turning at {rpm} rpm, so no setpoints were queued",
                    rpm=f"{rpm:.0f}",
                ),
                "drive-limits",
            )


def check_cam(cam: Cam, servos: Sequence[Servo], rpm: float) -> None:
    """The same for motion over the turns of a spindle that turns at ``rpm``."""
    by_time = cam.way.v * (abs(rpm) / 60.0 / _SLIPS)
    check_drives(cam.way._replace(v=by_time), servos, rpm)
    if cam.then is not None:
        check_drives(cam.then, servos, rpm)
