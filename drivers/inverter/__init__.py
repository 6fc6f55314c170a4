"""The driver for spindle inverters on a serial line (RS-485)."""
