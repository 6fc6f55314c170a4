"""The ways to follow setpoints, by the word of the machine file."""

from __future__ import annotations

from drivers.canopen.config import CanopenConfig
from drivers.canopen.drives import DriveSet
from drivers.canopen.follow import CspFollower, Follower
from drivers.canopen.profiled import ProfiledFollower
from drivers.canopen.pvt_queue import PvtFollower
from drivers.canopen.states import CSP, IP, PP
from drivers.setpoint_queue import SetpointQueue

MODES = {"pvt": IP, "pp": PP, "csp": CSP}  # objects 0x6060


def follower_of(config: CanopenConfig, drives: DriveSet, queue: SetpointQueue) -> Follower:
    """The one of ``config.mode``."""
    if config.mode == "pp":
        return ProfiledFollower(drives.axes, drives.indices, queue)
    if config.mode == "csp":
        return CspFollower(drives.axes, drives.indices, queue, config.bus.sync)
    return PvtFollower(drives.axes, drives.indices, queue, config.commit, config.record)
