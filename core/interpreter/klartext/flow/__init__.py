"""Jumps, calls, Q parameters and mid-program startup of Klartext."""
