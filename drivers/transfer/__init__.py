"""Transfer of programs over a serial line (RS-232)."""
