"""The driver for LinuxCNC's HAL, with setpoints, spindle and terminals on any hardware that HAL supports."""
