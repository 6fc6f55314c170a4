"""Implementations of commands, which are loaded only when they are needed."""
