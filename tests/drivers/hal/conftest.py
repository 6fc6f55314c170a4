"""The one fixture of this folder."""

from __future__ import annotations

from tests.drivers.hal.halrun import halrun

__all__ = ["halrun"]
