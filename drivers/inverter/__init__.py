"""Spindle inverters on a serial line (RS-485)."""
