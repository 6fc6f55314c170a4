"""Implementations of commands. Each module is loaded only when its command runs."""
