"""MDI: one line at a time."""
