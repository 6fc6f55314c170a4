"""LinuxCNC's HAL: setpoints, spindle and terminals on whatever HAL has a driver for."""
