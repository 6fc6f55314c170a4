"""Cycles of other controls, expanded to moves."""
