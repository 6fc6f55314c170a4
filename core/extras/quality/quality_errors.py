"""What is refused of measured parts: one sentence, with what to do."""

from __future__ import annotations

from core.message import CodedError


class QualityError(CodedError, ValueError):
    """Figures from which nothing can be told; the text says which and what to do."""
