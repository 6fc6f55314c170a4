"""Canned cycles of OmniTurn: drilling, roughing and threading."""
