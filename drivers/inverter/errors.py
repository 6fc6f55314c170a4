"""What can go wrong between a request and its answer."""

from __future__ import annotations

from core.ports import DriverError


class NoAnswerError(DriverError):
    """The device has not answered, or nothing that could be read."""


class RefusedError(DriverError):
    """The device answered that it will not."""
