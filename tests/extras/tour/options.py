"""Options of ``turndesk tour`` for the tests of all commands. The command has none of its own."""

from __future__ import annotations

COVERED: dict[tuple[str, str], str] = {}
REST: dict[str, list[str]] = {"tour": []}
READS = {"tour"}  # the tour has its own data folder
