"""Reference page for the machine-readable output."""
