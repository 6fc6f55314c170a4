"""grblHAL over a serial line or TCP: a controller that plans by itself (docs/decisions/0027-grblhal.md)."""
