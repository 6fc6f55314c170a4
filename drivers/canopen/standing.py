"""What every drive is told at each start unless the machine file says otherwise: stops, limits, watching."""

from __future__ import annotations

from collections.abc import Sequence

from core.ports import DriverError, Segments
from drivers.canopen import objects as od
from drivers.canopen.config import AxisConfig, BusConfig, Objects


def standing(config: AxisConfig, bus: BusConfig) -> Objects:
    """For one axis drive."""
    return (
        *stopping(bus),
        (od.WINDOW, 0, round(config.following_window / config.count)),
        (od.WINDOW_TIME, 0, round(1000 * config.following_time)),
        (od.QUICK_DECEL, 0, round(config.amax / config.count)),
        *(limits(config) if config.absolute else ()),
    )


def stopping(bus: BusConfig) -> Objects:
    """For any drive: quick stop when our heartbeat is missing, then no power."""
    return (
        (od.ABORT_OPTION, 0, 3),
        (od.QUICK_OPTION, 0, 2),
        (od.FAULT_OPTION, 0, 2),
        *watching(bus),
    )


def watching(bus: BusConfig) -> Objects:
    """For any node: its heartbeat, and ours, which it misses after three."""
    return (
        (od.HEARTBEAT, 0, round(1000 * bus.heartbeat)),
        (od.WATCHED, 1, bus.host_id << 16 | round(3000 * bus.heartbeat)),
    )


def limits(config: AxisConfig) -> Objects:
    """The drive's own software limits; they mean something once it knows where home is."""
    if config.travel is None:
        return ()
    low, high = config.travel
    return ((od.LIMITS, 1, round(low / config.count)), (od.LIMITS, 2, round(high / config.count)))


def check_limits(segments: Segments, axes: Sequence[AxisConfig], homed: Sequence[bool]) -> None:
    """The last line before the wire, behind the control's own. Raises DriverError."""
    for i, axis in enumerate(axes):
        if abs(segments.v[:, i]).max() > axis.vmax * 1.001 + 0.01:
            raise DriverError(
                f"{axis.name}: setpoints faster than {axis.vmax:.1f}/s; nothing was queued", "drive-limits"
            )
        if axis.travel is None or not homed[i]:
            continue
        low, high = axis.travel
        if segments.p[:, i].min() < low - 0.01 or segments.p[:, i].max() > high + 0.01:
            raise DriverError(
                f"{axis.name}: setpoints leave {low:.2f}…{high:.2f}; nothing was queued", "drive-limits"
            )
