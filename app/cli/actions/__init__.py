"""Implementations of commands, loaded only when they are needed."""
