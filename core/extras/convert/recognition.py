"""Recognition of the control for which a turning program was written."""

from __future__ import annotations

import re
from collections.abc import Sequence

from core.extras.convert.source_options import SourceControl
from core.language.omniturn import other_controls
from core.message import Message

_COMMENT = re.compile(r"\([^)]*\)?|;.*")
_LINUXCNC = re.compile(
    r"^\s*O\s*(<|\d+\s*(SUB|CALL|IF|WHILE|DO|REPEAT)\b)|#<|\bG0?[78](?!\d)|\bG33(?!\d)[^(]*K|G76[^(]*[IJ][^(]*K",
    re.IGNORECASE | re.MULTILINE,
)
_FANUC = re.compile(
    r"^\s*[O:]\d+\s*$|[UW][-+.\d]|T\d{3,4}(?!\d)|G50(?!\d)[^(]*S|G7[0-3][^(]*P\d+[^(]*Q|G28\s*U|^%?\s*O\d{3,5}",
    re.IGNORECASE | re.MULTILINE,
)
_PLANE = re.compile(r"G18(?!\d)", re.IGNORECASE)
_SYSTEM_B = re.compile(
    r"G9[45](?!\d)[^XZ]*F|G92(?!\d)[^XZ(]*S|G7[789](?!\d)[^(\n]*[XZ]|G91(?!\d)", re.IGNORECASE
)
_HAAS = re.compile(
    r"\bG53\b|\bM97\b|\bHAAS\b|G76[^(\n]*D[^(\n]*K|G7[12][^(\n]*P\d+[^(\n]*D|^\s*(N\d+\s*)?G28\s*($|\()",
    re.IGNORECASE | re.MULTILINE,
)

_USUAL_CONTROLS = {
    "LinuxCNC": SourceControl.LINUXCNC,
    "Mach": SourceControl.MACH,
    "Haas": SourceControl.HAAS,
    "Fanuc": SourceControl.FANUC_A,
}
"""Control by the name in the warning that a program is not an OmniTurn program."""


def recognize_control(lines: Sequence[str]) -> SourceControl | None:
    """Return the control for which a program was probably written, or None if this is unclear."""
    text = "\n".join(_COMMENT.sub(" ", each) for each in lines)
    if _LINUXCNC.search(text):
        return SourceControl.LINUXCNC
    if not _FANUC.search(text):
        return SourceControl.LINUXCNC if _PLANE.search(text) else None
    if _HAAS.search("\n".join(lines)):
        return SourceControl.HAAS
    return SourceControl.FANUC_B if _SYSTEM_B.search(text) else SourceControl.FANUC_A


def recognize_other_control(lines: Sequence[str]) -> SourceControl | None:
    """Return the probable control of a program, or None if it is probably an OmniTurn program.

    OmniTurn has words such as G33 with K that other controls have too. Therefore, the text must also contain
    words that OmniTurn does not have.
    """
    warning = other_controls.recognize_control(lines)
    if warning is None or not isinstance(warning.message, Message):
        return None
    return recognize_control(lines) or _USUAL_CONTROLS[str(warning.message.values["control"])]
