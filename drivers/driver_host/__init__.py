"""The driver host: a process that owns the bus and the queue and survives a crash of the control."""
