"""Transfer of programs over the RS-232 serial line, in both directions."""
