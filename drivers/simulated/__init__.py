"""Backend that runs TurnDesk on the simulated machine instead of real hardware."""
