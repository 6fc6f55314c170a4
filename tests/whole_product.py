"""Marks tests of generated pages, which describe the product with all optional features."""

from __future__ import annotations

import pytest

from app.compose.extra import NAMES, extras

WHOLE_PRODUCT = pytest.mark.skipif(set(extras()) != set(NAMES), reason="an optional feature is left out")
