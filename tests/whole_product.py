"""Marks tests of generated pages, which describe the product with all optional features."""

from __future__ import annotations

import pytest

from app.compose.optional_features import FEATURE_NAMES, extras

WHOLE_PRODUCT = pytest.mark.skipif(
    set(extras()) != set(FEATURE_NAMES), reason="an optional feature is left out"
)
