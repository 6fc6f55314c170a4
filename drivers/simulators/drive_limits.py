"""The drives' own limits, the last line behind the control's: setpoints beyond them are refused."""

from __future__ import annotations

from collections.abc import Sequence

from core.message import Message
from core.ports import Cam, DriverError, Segments
from drivers.simulators.servo_axis import Servo

_STANDS = 10.0  # rpm; faster than this the spindle's drive turns, and cannot position
_SLIPS = 1.1  # of an axis' speed: a spindle that asks for more is refused, one that asks for less slips


def check_limits(segments: Segments, servos: Sequence[Servo], rpm: float) -> None:
    """Raises DriverError for setpoints too fast, out of the travel, or of C while the spindle turns."""
    for i, servo in enumerate(servos):
        axis = servo.axis
        fastest = abs(segments.v[:, i]).max(initial=0.0)
        if fastest > axis.vmax * 1.001 + 0.01:
            raise DriverError(
                Message(
                    "{axis}: the setpoint speed exceeds {vmax}/s; nothing was queued",
                    axis=axis.name,
                    vmax=f"{axis.vmax:.1f}",
                ),
                "drive-limits",
                reason="too-fast",
            )
        if axis.name == "C" and not axis.own_drive and fastest > 0.0 and abs(rpm) > _STANDS:
            raise DriverError(
                Message(
                    "C axis: the spindle is turning at {rpm} rpm, so no setpoints were queued",
                    rpm=f"{rpm:.0f}",
                ),
                "drive-limits",
            )
        if axis.travel is None or not servo.homed:
            continue
        low, high = _reach(axis.travel, servo)
        if segments.p[:, i].min(initial=low) < low - 0.01 or segments.p[:, i].max(initial=high) > high + 0.01:
            raise DriverError(
                Message(
                    "{axis}: setpoints are outside the travel range {low}…{high}; no setpoints were queued",
                    axis=axis.name,
                    low=f"{low:.2f}",
                    high=f"{high:.2f}",
                ),
                "drive-limits",
                reason="leaves-travel",
            )


def _reach(travel: tuple[float, float], servo: Servo) -> tuple[float, float]:
    """The travel, and for a slide that stands beyond it the way back: as drives have it, and no further."""
    return min(travel[0], servo.reading), max(travel[1], servo.reading)


def check_cam(cam: Cam, servos: Sequence[Servo], rpm: float) -> None:
    """The same for motion over the turns of a spindle that turns at ``rpm``."""
    by_time = cam.way.v * (abs(rpm) / 60.0 / _SLIPS)
    check_limits(cam.way._replace(v=by_time), servos, rpm)
    if cam.then is not None:
        check_limits(cam.then, servos, rpm)
