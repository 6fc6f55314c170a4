"""Why a record cannot be analysed: one sentence that says what is missing and what to do."""

from __future__ import annotations


class AnalysisError(Exception):
    """``str()`` is the sentence."""
