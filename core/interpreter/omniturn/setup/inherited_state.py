"""Settings that a program inherits from the previous program: units, rapid rate and modal state."""

from __future__ import annotations

import re

from core.interpreter.shared.modal_state import ModalState
from core.language.source import Dialect, ProgramSource

UNITS, RAPID = "units", "rapid"

_COMMENT = re.compile(r"\([^)]*\)?")
_UNIT = re.compile(r"G7[01](?![0-9])")
_RATE = re.compile(r"F[0-9.]")
_PER_REV = re.compile(r"G95(?![0-9])")


def find_inherited_settings(source: ProgramSource) -> frozenset[str]:
    """Return the settings among ``units`` and ``rapid`` that the program inherits.

    Programs in other dialects do not inherit settings.
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


def compute_modal_after_end(previous: ModalState, rpm: float, *, resets_m_functions: bool) -> ModalState:
    """Return the modal state after the end of a program.

    This is the power-up state, but units, tool offset and preset remain. If ``resets_m_functions`` is
    False, the M functions also remain; M30 resets them, and M02 does not. ``rpm`` is the unsigned commanded
    speed at the end.
    """
    return ModalState(
        metric=previous.metric,
        rapid_rate=previous.rapid_rate,
        tool=previous.tool,
        tool_offset_x=0.0 if previous.settable else previous.tool_offset_x,
        tool_offset_z=0.0 if previous.settable else previous.tool_offset_z,
        preset_x=previous.preset_x,
        preset_z=previous.preset_z,
        collet_closed=previous.collet_closed,
        spindle=0 if resets_m_functions else previous.spindle,
        rpm=rpm if previous.spindle and not resets_m_functions else previous.rpm,
        coolant=previous.coolant and not resets_m_functions,
        outputs=frozenset() if resets_m_functions else previous.outputs,
        comment=previous.comment,
        # Whole revolutions remain; other offsets are removed.
        offset_c=previous.offset_c if previous.offset_c % 360.0 == 0.0 else 0.0,
        is_c_axis_modulo=previous.is_c_axis_modulo,
    )
