"""Tour that shows TurnDesk on a simulated lathe: its store, its director and its input filter."""
