"""The fixtures of the screen tests."""

from tests.screen.conftest import dressed, never_late, nothing_left

__all__ = ["dressed", "never_late", "nothing_left"]
