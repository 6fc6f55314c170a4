"""Script, program and tools of the tour, which shows TurnDesk on a simulated lathe."""
