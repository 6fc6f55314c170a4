"""Path functions, tilted planes and feeds of Klartext."""
