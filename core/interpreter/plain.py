"""Lines of G00 or G01, X, Z and F and no more: nearly all of a long program, so they are read as numbers.

A statement takes a kilobyte and ten microseconds; here a move takes a tenth of both.
"""

from __future__ import annotations

import re

from core.interpreter.moves import rounded
from core.interpreter.state import State
from core.interpreter.statement import CodedMove, PlainMove

_NUMBER = r"[-+]?(?:[0-9]{1,4}(?:\.[0-9]{0,5})?|\.[0-9]{1,5})"
_MOVE = re.compile(
    f"(?:[Gg]0(?P<g>[01]))?(?:[Xx](?P<x>{_NUMBER}))?(?:[Zz](?P<z>{_NUMBER}))?(?:[Ff](?P<f>{_NUMBER}))?"
)
_FIVE_PLACES = re.compile(r"\.[0-9]{5}")

NO_CODE = -1


def move_words(text: str) -> re.Match[str] | None:
    """A line of G00 or G01, X, Z and F and no more, with one of X and Z; groups ``g x z f``."""
    match = _MOVE.fullmatch(text)
    return None if match is None or match["x"] is match["z"] is None else match


def is_fine(text: str) -> bool:
    """Whether a number has a fifth decimal."""
    return _FIVE_PLACES.search(text) is not None


def read_move(text: str) -> PlainMove | CodedMove | None:
    """The numbers of a line of G00 or G01, X, Z and F, or None for a line that is more, or no move."""
    match = move_words(text)
    if match is None:
        return None
    g, x, z, f = match.groups()
    to_x, to_z = None if x is None else float(x), None if z is None else float(z)
    fine = is_fine(text)
    if g is None and f is None and not fine:
        return to_x, to_z
    feed = None if f is None else float(f)
    if feed is not None and feed <= 0:
        return None
    return to_x, to_z, fine, NO_CODE if g is None else int(g), feed


def plain(state: State, line: int, text: str, move: CodedMove) -> PlainMove | None:
    """X and Z of a line whose other words say what is in force already; None where they change something."""
    x, z, fine, g, f = move
    if g == 0:
        if f is not None or not state.modal.rapid or state.title_rapid:
            return None
    elif state.steady_feed is None:
        if g == 1 or f is not None:
            return None
    elif f is not None and state.feed_word(f) != state.steady_feed:
        return None
    return rounded(state, line, text, x, z) if fine else (x, z)
