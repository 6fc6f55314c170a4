"""Reference of machine-readable output."""
