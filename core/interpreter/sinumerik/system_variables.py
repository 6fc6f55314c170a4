"""System variables that a program may read: the tool and the edge in force, and where the axes stand."""

from __future__ import annotations

import re

from core.interpreter.job_setup import ToolOffset
from core.interpreter.modal_state import Modal
from core.tool_edges import NAMED_TOOLS, tool_of


def system_value(name: str, modal: Modal, edge: ToolOffset) -> float | None:
    """What the control has there; None for a variable that is not read here.

    ``edge`` is the row of T and D. $P_TOOL is D, $P_TOOLR the nose radius in mm, 0 with D0: under G70 and for
    a tool without a number nothing is answered, as no number would be right.
    """
    if name == "$P_TOOL":
        return float(modal.edge or 0)
    if name == "$P_TOOLNO" and tool_of(modal.tool) < NAMED_TOOLS:
        return float(tool_of(modal.tool))
    if name == "$P_TOOLR" and modal.metric:
        return edge.nose_radius if modal.edge else 0.0
    return None


_POSITION = re.compile(r"\$(?:AA_IW|P_EP)\[([A-Z][0-9]?)\]")


def position_asked(name: str) -> str:
    """The axis whose position in the program's system a name asks for; empty for any other name."""
    match = _POSITION.fullmatch(name)
    return match[1] if match else ""
