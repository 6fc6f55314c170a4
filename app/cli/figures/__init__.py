"""Formatting of results as text and as JSON."""
