"""Why a record of the scope cannot be kept, read or analysed: one sentence; a full disk is called full."""

from __future__ import annotations

import errno
from pathlib import Path

from core.coded_error import CodedError


class RecordError(CodedError):
    """``str()`` is the sentence for whoever asked: what, where, what to do."""


class AnalysisError(CodedError):
    """``str()`` is the sentence: what the record lacks, and what to do."""


_FULL = frozenset({errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG})


def why(path: Path, error: OSError) -> RecordError:
    """The same as a sentence."""
    if error.errno in _FULL:
        return RecordError(f"{path}: the disk is full; make room on it", "disk-full")
    if isinstance(error, FileNotFoundError):
        return RecordError(f"{path}: there is no such file", "not-found")
    return RecordError(f"{path}: {error.strerror or error}", "unusable")
