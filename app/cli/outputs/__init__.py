"""Formatting of command results as text and JSON."""
