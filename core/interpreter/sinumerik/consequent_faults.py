"""Suppression of SINUMERIK errors that are only consequences of an earlier error."""

from __future__ import annotations

import re

from core.language.diagnostics import Diagnostic
from core.language.sinumerik.sinumerik_alarms import NAME_NOT_DEFINED

_NO_AXIS = re.compile(r"this lathe has no (?:axis )?([A-Z][0-9]?)\b")
_ARC_IN_Y = re.compile(r": J: an arc in G18 uses I and K")
# Codes of findings that depend on position and modal state, which are unknown after an invalid block.
_STATE_DEPENDENT_CODES = frozenset(
    {
        *("14040", "arc-radius", "arc-no-chord", "10720", "corner-too-large", "corner-next"),
        *("10860", "g95-spindle-stopped", "dwell-spindle-stopped", "speed-missing", "surface-speed-missing"),
        *("word-unused", str(NAME_NOT_DEFINED)),
    }
)


def depends_on_state(finding: Diagnostic) -> bool:
    """Return whether a finding depends on position and modal state, so an earlier error may cause it."""
    return finding.code in _STATE_DEPENDENT_CODES or finding.code.startswith("comp-")


class MissingAxes:
    """Record of the axes that a program uses but the machine lacks, to report each axis only once."""

    def __init__(self) -> None:
        self._missing_axes: set[str] = set()

    def is_axis_reported(self, finding: Diagnostic) -> bool:
        """Return whether a finding reports a missing axis that was already reported.

        A program for a mill uses the missing axis in many lines. A J word counts as Y, as in arcs in Y.
        """
        match = _NO_AXIS.search(finding.message)
        axis = "Y" if _ARC_IN_Y.search(finding.message) else match[1] if match else ""
        if not axis:
            return False
        is_reported = axis in self._missing_axes
        self._missing_axes.add(axis)
        return is_reported
