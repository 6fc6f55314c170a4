"""Programs over a serial line (RS-232)."""
