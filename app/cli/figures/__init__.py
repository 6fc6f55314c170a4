"""Figures as the commands show them, for a person and as JSON."""
