"""Settings that one program leaves for the next: units, rapid rate, and the modal state after its end."""

from __future__ import annotations

import re

from core.interpreter.shared.modal_state import Modal
from core.language.source import Dialect, Source

UNITS, RAPID = "units", "rapid"

_COMMENT = re.compile(r"\([^)]*\)?")
_UNIT = re.compile(r"G7[01](?![0-9])")
_RATE = re.compile(r"F[0-9.]")
_PER_REV = re.compile(r"G95(?![0-9])")


def inherited_settings(source: Source) -> frozenset[str]:
    """Return which of ``units`` and ``rapid`` the program inherits.

    Programs of other dialects do not inherit settings.
    """
    if source.dialect is not Dialect.OMNITURN:
        return frozenset()
    first = next((words for words in map(_words, source.lines) if words), "")
    found = set()
    if not _UNIT.search(first):
        found.add(UNITS)
    if not _RATE.search(first) or _PER_REV.search(first):
        found.add(RAPID)
    return frozenset(found)


def _words(line: str) -> str:
    return _COMMENT.sub("", line).replace(" ", "").upper()


def after_end(old: Modal, rpm: float, *, reset: bool) -> Modal:
    """Return the modal state after the program end.

    It is the power-up state except for units, tool offset, preset, and, without ``reset``, the M functions.
    ``rpm`` is the unsigned commanded speed at the end. M30 resets the M functions, and M02 does not.
    """
    return Modal(
        metric=old.metric,
        rapid_rate=old.rapid_rate,
        tool=old.tool,
        tool_x=0.0 if old.settable else old.tool_x,
        tool_z=0.0 if old.settable else old.tool_z,
        preset_x=old.preset_x,
        preset_z=old.preset_z,
        collet_closed=old.collet_closed,
        spindle=0 if reset else old.spindle,
        rpm=rpm if old.spindle and not reset else old.rpm,
        coolant=old.coolant and not reset,
        outputs=frozenset() if reset else old.outputs,
        comment=old.comment,
        # Whole revolutions remain; other offsets are removed.
        offset_c=old.offset_c if old.offset_c % 360.0 == 0.0 else 0.0,
        wraps_c=old.wraps_c,
    )
