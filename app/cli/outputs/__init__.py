"""Formatting of results as text and JSON."""
