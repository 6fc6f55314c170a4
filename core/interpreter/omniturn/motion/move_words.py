"""Conversion of moves to the text of program lines, in the active mode and unit."""

from __future__ import annotations

import re
from math import pi

from core.geometry.lines_and_arcs import Arc, Element, Line
from core.interpreter.shared import units
from core.interpreter.shared.contour_stage import AdjustedMoveFactory
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.modal_state import ModalState

_WORD = re.compile(r"([A-Z])([-+0-9.]*)")
_POSITION_WORDS = frozenset("XZIKRC")
_ARC_CODES = frozenset({"G02", "G03"})
_TOLERANCE_MM = 1e-9  # mm
_HALF_TURN = pi - 1e-3  # rad; R does not define a longer arc reliably


def format_move(modal: ModalState, element: Element, required_letters: str = "") -> str:
    """Return the program words of an element: coordinates, or distances under G91.

    The element is in the program frame. The words of ``required_letters`` are included even if their axes
    do not move.
    """
    start, end = element.start, element.end
    scale = units.get_mm_per_unit(is_metric=modal.metric)
    scale_x = scale / 2 if modal.diameter else scale
    base_x, base_z = (
        (modal.secondary_offset_x, modal.secondary_offset_z) if modal.absolute is not False else start
    )
    arc = isinstance(element, Arc)
    moved_x = arc or "X" in required_letters or abs(end[0] - start[0]) > _TOLERANCE_MM
    moved_z = arc or "Z" in required_letters or abs(end[1] - start[1]) > _TOLERANCE_MM
    words = ""
    if moved_x or not moved_z:
        words += "X" + number((end[0] - base_x) / scale_x, is_metric=modal.metric)
    if moved_z:
        words += "Z" + number((end[1] - base_z) / scale, is_metric=modal.metric)
    return words if isinstance(element, Line) else _arc(modal, element, words)


def _arc(modal: ModalState, arc: Arc, words: str) -> str:
    scale = units.get_mm_per_unit(is_metric=modal.metric)
    code = "G02" if arc.clockwise else "G03"
    if abs(arc.sweep_rad) < _HALF_TURN:
        return f"{code}{words}R{number(arc.radius / scale, is_metric=modal.metric)}"
    distances = modal.diameter or modal.absolute is False
    base_x, base_z = arc.start if distances else (modal.secondary_offset_x, modal.secondary_offset_z)
    i = number((arc.center[0] - base_x) / scale, is_metric=modal.metric)
    k = number((arc.center[1] - base_z) / scale, is_metric=modal.metric)
    return f"{code}{words}I{i}K{k}"


def replace_move_words(block: Block, element: Element) -> str:
    """Return the text of a block after its move was changed to ``element``.

    The text contains the modal words, feed and D of the block, with new coordinates.
    """
    words = [match for match in _WORD.finditer(block.text.upper()) if match[0] not in _ARC_CODES]
    before = "".join(word[0] for word in words if word[1] not in _POSITION_WORDS and word[1] != "D")
    offset = "".join(word[0] for word in words if word[1] == "D")
    if offset and block.modal.absolute is False:
        element = _without_secondary_offset(block, element, {word[1]: float(word[2] or 0) for word in words})
    return before + format_move(block.modal, element, block.text.upper()) + offset


def _without_secondary_offset(block: Block, element: Element, words: dict[str, float]) -> Element:
    """Return the element without the secondary offset that D adds on the line of this block."""
    scale = units.get_mm_per_unit(is_metric=block.modal.metric)
    scale_x = scale / 2 if block.modal.diameter else scale
    x = block.x - block.x0 - words.get("X", 0.0) * scale_x
    z = block.z - block.z0 - words.get("Z", 0.0) * scale
    return (
        Line((element.start[0] + x, element.start[1] + z), element.end)
        if isinstance(element, Line)
        else element
    )


def number(value: float, *, is_metric: bool) -> str:
    """Return a number as program text without trailing zeros.

    The text has at most five decimal places in inches and four in mm.
    """
    text = f"{value:.{4 if is_metric else 5}f}".rstrip("0").rstrip(".")
    if text in {"-0", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


class OmniturnMoveFactory(AdjustedMoveFactory):
    """Factory of blocks whose moves were changed by a corner or by nose compensation.

    The text of each block contains the new coordinates.
    """

    def __init__(self, max_rpm: float) -> None:
        self._max_rpm = max_rpm

    @property
    def max_rpm(self) -> float:
        """Return the speed limit of the spindle in rpm."""
        return self._max_rpm

    def replace_element(self, block: Block, element: Element) -> Block:
        """Return the block with its move changed to another element of the same kind."""
        if (block.x0, block.z0) == element.start and (block.x, block.z) == element.end:
            return block
        return self._placed(block, element, replace_move_words(block, element))

    def insert_move(self, block: Block, element: Element) -> Block:
        """Return a new move along an element, to be inserted after ``block``.

        The move has the line, feed and state of ``block``.
        """
        return self._placed(block, element, format_move(block.modal, element))
