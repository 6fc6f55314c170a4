"""Post-processors that CAM programs run to write programs for TurnDesk."""
