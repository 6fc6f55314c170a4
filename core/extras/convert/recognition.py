"""Recognition of the control for which a turning program was written."""

from __future__ import annotations

import re
from collections.abc import Sequence

from core.extras.convert.source_options import SourceControl
from core.language.omniturn import other_controls
from core.language.source import Dialect
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

_OMNITURN_LINE = re.compile(
    r"\}\d+|LS\d+|LF|RF"  # subroutine, loop and contour
    r"|(?=.*G7[23](?!\d))[^PQUWR]*"  # G72 and G73 select diameters and radii; others have cycles there
    r"|.*(G7[67]S\d|G33(?=.*I)(?=.*K)|G74X.*I|G75I|G78U|M97I\d+C).*"
)
"""Line of an OmniTurn program, without spaces and comments, that other controls do not have."""
_PLANE_MILLING = re.compile(r"\(\s*~PL[XZ]C", re.IGNORECASE)
_FIRST_LINE = re.compile(r".*G9[01](?![\d.])")
"""First line of each OmniTurn program. Other controls may have such a line too."""
_MOVE_CODE = re.compile(r"G0*[0-3](?![\d.])")
_PLAIN_MOVE = re.compile(r"(?=.*[XZ])([XZFDST][-+]?[\d.]+|G9[0145]|G7[0-3]|M\d\d)+")
_OTHER_CODE = re.compile(
    r"(G1[789]|G2[018]|G30|G4[39]|G5[04-9]|G6[14]|G80|G9[89]|M0?6|G0?[0-3](?=\D))(?![\d.])"
)
"""Codes that OmniTurn does not have, or writes with two digits."""
_MIN_OTHER_CODES = 2  # a single one may be a typing error


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


def recognize_language(lines: Sequence[str]) -> SourceControl | Dialect | None:
    """Return the control of a program, ``Dialect.OMNITURN``, or None if this is unclear.

    It is unclear if the program has words of OmniTurn and of other controls, or of neither. OmniTurn has
    words such as G33 with K that other controls have too, and each OmniTurn program begins with G90 or G91.
    """
    texts = (_COMMENT.sub("", each).replace(" ", "").upper().lstrip("/") for each in lines)
    codes = [each for each in texts if each and not each.startswith("%")]
    is_omniturn = _has_omniturn_words(lines, codes)
    other = recognize_other_control(lines)
    if is_omniturn or other is not None:
        return None if is_omniturn and other is not None else other or Dialect.OMNITURN
    begins_as_omniturn = bool(codes) and _FIRST_LINE.match(codes[0]) is not None
    other_codes = {each for code in codes for each in _OTHER_CODE.findall(code)}
    return None if begins_as_omniturn and len(other_codes) < _MIN_OTHER_CODES else recognize_control(lines)


def recognize_other_control(lines: Sequence[str]) -> SourceControl | None:
    """Return the probable control of a program, or None if it is probably an OmniTurn program.

    The text must contain words that OmniTurn does not have.
    """
    warning = other_controls.recognize_control(lines)
    if warning is None or not isinstance(warning.message, Message):
        return None
    return recognize_control(lines) or _USUAL_CONTROLS[str(warning.message.values["control"])]


def _has_omniturn_words(lines: Sequence[str], codes: Sequence[str]) -> bool:
    """Return whether a program begins as each OmniTurn program and has words that only OmniTurn has."""
    if not codes or not _FIRST_LINE.match(codes[0]):
        return False
    if any(map(_OMNITURN_LINE.fullmatch, codes)) or any(map(_PLANE_MILLING.match, lines)):
        return True
    for code in codes:  # other controls need a G code before the first move
        if _MOVE_CODE.search(code):
            return False
        if _PLAIN_MOVE.fullmatch(code):
            return True
    return False
