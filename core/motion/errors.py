"""What the motion room has to say when a movement cannot be planned."""

from __future__ import annotations


class MotionError(Exception):
    """A movement cannot be planned; one sentence says which block, what is wrong and what to do."""
