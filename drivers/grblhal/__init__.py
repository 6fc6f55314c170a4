"""Driver for grblHAL controllers on a serial port or TCP connection, which plan their own motion.

See docs/decisions/0027-grblhal.md.
"""
