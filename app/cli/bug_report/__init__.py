"""Crash files for errors in TurnDesk, and the bug report that a user may publish."""
