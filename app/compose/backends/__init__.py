"""Machines as their files describe them: how each backend is connected, checked and played."""
