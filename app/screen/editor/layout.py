"""Where everything stands on the editor page. Pure arithmetic, in the unit of the Automatic page."""

from __future__ import annotations

from typing import NamedTuple

from app.screen.layout import Rect

KEYS = 29.0  # units: height of the drawn keyboard, four rows of a finger's height
NOWHERE = Rect(0, 0, 0, 0)
HEAD = 6.8  # units: a finger's height, for the place that shows the keyboard


class EditorPlaces(NamedTuple):
    """The parts of the page; ``ask`` is empty while nothing is asked, ``keys`` without the drawn keyboard.

    ``path`` is the place of all pictures of the program: one of the part being cut is one more choice.
    """

    head: Rect
    text: Rect
    path: Rect
    findings: Rect
    ask: Rect
    keys: Rect
    body: Rect  # text, path and findings together: the history takes it


def editor_places(width: int, height: int, u: float, *, asking: bool, keys: float = 0.0) -> EditorPlaces:
    """Divide the room that the frame leaves to its page; ``u`` is its unit.

    ``keys`` units of it are the drawn keyboard's: the text then has the whole width over it.
    """
    gap = max(4, round(0.7 * u))
    head = Rect(0, 0, width, round(HEAD * u))
    keys_h = round(keys * u)
    foot = height - keys_h
    ask_h = round(6.2 * u) if asking else 0
    low = foot - gap if keys_h else foot
    ask = Rect(0, low - ask_h, width, ask_h)
    top = head.bottom + gap
    body = Rect(0, top, width, (ask.y - gap if asking else low) - top)
    keyboard = Rect(0, foot, width, keys_h)
    if keys_h:
        return EditorPlaces(head, body, NOWHERE, NOWHERE, ask, keyboard, body)
    text = Rect(0, top, round(0.56 * width), body.h)
    x = text.right + gap
    findings_h = round(min(0.4 * body.h, 24 * u))
    path = Rect(x, top, width - x, body.h - findings_h - gap)
    findings = Rect(x, path.bottom + gap, path.w, findings_h)
    return EditorPlaces(head, text, path, findings, ask, keyboard, body)
