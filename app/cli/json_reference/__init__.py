"""Generator of the reference page for machine-readable output."""
