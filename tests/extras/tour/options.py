"""Option of ``turndesk tour`` for the tests of all commands."""

from __future__ import annotations

COVERED = {("tour", "--from-screen"): "tests/extras/tour"}
REST: dict[str, list[str]] = {"tour": []}
READS = {"tour"}  # the tour has its own data folder
