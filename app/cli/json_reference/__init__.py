"""The reference of machine-readable output."""
