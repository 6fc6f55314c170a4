"""Reports of faults in TurnDesk: crash files, and the report that a user may publish."""
