"""Driver for grblHAL controllers, which plan their own motion, on a serial or TCP connection.

See docs/decisions/0027-grblhal.md.
"""
