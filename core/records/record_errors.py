"""Why a record of the scope cannot be kept, read or analysed: one sentence; a full disk is called full."""

from __future__ import annotations

import errno
from pathlib import Path

from core.coded_error import CodedError
from core.input_file import MB, TooLargeError
from core.message import Message
from core.records.record import UnsoundError


class RecordError(CodedError):
    """``str()`` is the sentence for whoever asked: what, where, what to do."""


class AnalysisError(CodedError):
    """``str()`` is the sentence: what the record lacks, and what to do."""


_FULL = frozenset({errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG})


MOST_BYTES = 512 * MB
"""The most that a record may have, packed or unpacked; five minutes at 1 kHz have 50 MB."""


def damage(path: Path, error: Exception) -> RecordError:
    """Return the error for a file whose content is not as it was written."""
    if isinstance(error, UnsoundError):
        return RecordError(
            Message("{path} is damaged ({error}); open another scope record", path=path, error=error),
            "damaged",
        )
    return RecordError(Message("{path} is damaged; open another scope record", path=path), "damaged")


def why(path: Path, error: OSError) -> RecordError:
    """The same as a sentence."""
    if isinstance(error, TooLargeError):
        return RecordError(
            Message(
                "{path}: {cause}, so the file is not a scope record; check the file name",
                path=path,
                cause=error.strerror,
            ),
            "too-large",
        )
    if error.errno in _FULL:
        return RecordError(Message("{path}: the disk is full; free up disk space", path=path), "disk-full")
    if isinstance(error, FileNotFoundError):
        return RecordError(Message("{path}: file not found", path=path), "not-found")
    return RecordError(Message("{path}: {cause}", path=path, cause=error.strerror or error), "unusable")
