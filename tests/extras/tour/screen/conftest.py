"""The fixtures of the screen tests."""

from tests.screen.conftest import dressed, hands, journal, machine, never_late, nothing_left

__all__ = ["dressed", "hands", "journal", "machine", "never_late", "nothing_left"]
