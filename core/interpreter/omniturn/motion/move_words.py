"""Moves as lines of the program would say them, in the mode and unit in force."""

from __future__ import annotations

import re
from math import pi

from core.geometry.lines_and_arcs import Arc, Element, Line
from core.interpreter.shared import units
from core.interpreter.shared.contour_stage import AdjustedMoves
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.modal_state import Modal

_WORD = re.compile(r"([A-Z])([-+0-9.]*)")
_PLACE = frozenset("XZIKRC")
_ANEW = frozenset({"G02", "G03"})
_SAME = 1e-9  # mm
_HALF_TURN = pi - 1e-3  # rad; a longer arc is not safely said by its R


def move_words(modal: Modal, element: Element, named: str = "") -> str:
    """An element in the program's frame as a move: coordinates, or distances under G91.

    ``named``: letters that stand there even where nothing moves along them.
    """
    start, end = element.start, element.end
    scale = units.per_unit(metric=modal.metric)
    scale_x = scale / 2 if modal.diameter else scale
    base_x, base_z = (modal.secondary_x, modal.secondary_z) if modal.absolute is not False else start
    arc = isinstance(element, Arc)
    moved_x = arc or "X" in named or abs(end[0] - start[0]) > _SAME
    moved_z = arc or "Z" in named or abs(end[1] - start[1]) > _SAME
    words = ""
    if moved_x or not moved_z:
        words += "X" + number((end[0] - base_x) / scale_x, metric=modal.metric)
    if moved_z:
        words += "Z" + number((end[1] - base_z) / scale, metric=modal.metric)
    return words if isinstance(element, Line) else _arc(modal, element, words)


def _arc(modal: Modal, arc: Arc, words: str) -> str:
    scale = units.per_unit(metric=modal.metric)
    code = "G02" if arc.clockwise else "G03"
    if abs(arc.sweep) < _HALF_TURN:
        return f"{code}{words}R{number(arc.radius / scale, metric=modal.metric)}"
    distances = modal.diameter or modal.absolute is False
    base_x, base_z = arc.start if distances else (modal.secondary_x, modal.secondary_z)
    i = number((arc.centre[0] - base_x) / scale, metric=modal.metric)
    k = number((arc.centre[1] - base_z) / scale, metric=modal.metric)
    return f"{code}{words}I{i}K{k}"


def with_other_words(block: Block, element: Element) -> str:
    """The text of a block that now follows ``element``: its own modal words, feed and D, the place anew."""
    words = [match for match in _WORD.finditer(block.text.upper()) if match[0] not in _ANEW]
    before = "".join(word[0] for word in words if word[1] not in _PLACE and word[1] != "D")
    offset = "".join(word[0] for word in words if word[1] == "D")
    if offset and block.modal.absolute is False:
        element = _without_change(block, element, {word[1]: float(word[2] or 0) for word in words})
    return before + move_words(block.modal, element, block.text.upper()) + offset


def _without_change(block: Block, element: Element, words: dict[str, float]) -> Element:
    """The element whose distances lack what D adds to the way of its line: more than X and Z say."""
    scale = units.per_unit(metric=block.modal.metric)
    scale_x = scale / 2 if block.modal.diameter else scale
    x = block.x - block.x0 - words.get("X", 0.0) * scale_x
    z = block.z - block.z0 - words.get("Z", 0.0) * scale
    return (
        Line((element.start[0] + x, element.start[1] + z), element.end)
        if isinstance(element, Line)
        else element
    )


def number(value: float, *, metric: bool) -> str:
    """A number of the program: five places in inch, four in metric, without needless zeros."""
    text = f"{value:.{4 if metric else 5}f}".rstrip("0").rstrip(".")
    if text in {"-0", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


class WordedMoves(AdjustedMoves):
    """Moves cut at a corner or beside the contour: their text says the new place."""

    def __init__(self, max_rpm: float) -> None:
        self._max_rpm = max_rpm

    @property
    def highest_rpm(self) -> float:
        """The speed limit of the spindle."""
        return self._max_rpm

    def along(self, block: Block, element: Element) -> Block:
        """The block's own move along another element of its kind."""
        if (block.x0, block.z0) == element.start and (block.x, block.z) == element.end:
            return block
        return self._placed(block, element, with_other_words(block, element))

    def inserted(self, block: Block, element: Element) -> Block:
        """A move of its own after ``block``, of the same line, feed and state, along an element."""
        return self._placed(block, element, move_words(block.modal, element))
