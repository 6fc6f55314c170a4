"""RS-232: programs sent and received over the serial line."""
