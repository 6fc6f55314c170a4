"""Driver host: a separate process that owns bus and queue and survives a crash of the control."""
