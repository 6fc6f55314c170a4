"""Generated moves as lines of the program would say them, in the mode and unit in force."""

from __future__ import annotations

import re
from math import pi

from core.geometry.contour import Arc, Element, Line
from core.interpreter import units
from core.interpreter.blocks import Block
from core.interpreter.modal import Modal

_WORD = re.compile(r"([A-Z])[-+0-9.]*", re.IGNORECASE)
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
    words = [match[0] for match in _WORD.finditer(block.text) if match[1].upper() not in _PLACE]
    before = "".join(word for word in words if word.upper() not in _ANEW and word[0] not in "Dd")
    offset = "".join(word for word in words if word[0] in "Dd")
    return before + move_words(block.modal, element, block.text.upper()) + offset


def number(value: float, *, metric: bool) -> str:
    """A number of the program: five places in inch, four in metric, without needless zeros."""
    text = f"{value:.{4 if metric else 5}f}".rstrip("0").rstrip(".")
    if text in {"-0", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text
