"""Machine data for other programs, read-only."""
