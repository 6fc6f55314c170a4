"""Pseudo terminals, where the machine has any: a bare container may lack them."""

from __future__ import annotations

import os

import pytest


def open_pty() -> tuple[int, int]:
    """Both ends of a new pseudo terminal; the test is skipped, and says so, where there is none to be had."""
    try:
        return os.openpty()
    except OSError as error:
        pytest.skip(f"no pseudo terminals here: {error}")
