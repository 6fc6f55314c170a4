"""The fixtures of the screen tests, and a writer at the editor."""

from tests.screen.conftest import dressed, machine, never_late, nothing_left
from tests.screen.editor.conftest import memory, writer

__all__ = ["dressed", "machine", "memory", "never_late", "nothing_left", "writer"]
