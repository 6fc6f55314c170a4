"""Moving by hand, homing and touching tools off; no Qt."""
