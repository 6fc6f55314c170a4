"""The fixtures of the screen tests and of the Jog page."""

from tests.screen.conftest import dressed, hands, machine, never_late, nothing_left
from tests.screen.jog.conftest import jog, lost

__all__ = ["dressed", "hands", "jog", "lost", "machine", "never_late", "nothing_left"]
