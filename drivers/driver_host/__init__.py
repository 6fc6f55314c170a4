"""Driver host: a process that owns the drive bus and setpoint queue and survives a control crash."""
