"""A program laid out in time: every elementary block with its start and end, by the law that a run obeys."""

from __future__ import annotations
