"""Which optional features are installed, for tests of pages that describe all of them."""

import pytest

from app.compose.extra import NAMES, extras

all_installed = pytest.mark.skipif(len(extras()) < len(NAMES), reason="an optional feature is not installed")
"""Marks the test of a generated page that describes every optional feature."""
