"""Bridge to HAL, which runs under the system's Python and needs only LinuxCNC's ``hal`` module."""
