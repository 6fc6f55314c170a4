"""Where everything stands on the editor page. Pure arithmetic, in the unit of the Automatic page."""

from __future__ import annotations

from typing import NamedTuple

from app.screen.layout import Rect, unit


class EditorPlaces(NamedTuple):
    """The parts of the page; ``ask`` is empty while nothing is asked."""

    title: Rect
    text: Rect
    path: Rect
    findings: Rect
    ask: Rect
    prompt: Rect
    keys: Rect
    body: Rect  # text, path and findings together: the history takes it


def editor_places(width: int, height: int, *, asking: bool) -> EditorPlaces:
    """Divide a window of this size."""
    u = unit(width, height)
    gap = max(4, round(0.7 * u))
    title_h, prompt_h, keys_h = (round(k * u) for k in (4.8, 4.6, 6.6))
    ask_h = round(6.2 * u) if asking else 0
    keys = Rect(gap, height - gap - keys_h, width - 2 * gap, keys_h)
    prompt = Rect(gap, keys.y - gap - prompt_h, width - 2 * gap, prompt_h)
    ask = Rect(gap, prompt.y - gap - ask_h, width - 2 * gap, ask_h)
    top = title_h + gap
    bottom = (ask.y if asking else prompt.y) - gap
    body = Rect(gap, top, width - 2 * gap, bottom - top)
    text = Rect(body.x, top, round(0.54 * body.w), body.h)
    x = text.right + gap
    findings_h = round(min(0.36 * body.h, 24 * u))
    path = Rect(x, top, body.right - x, body.h - findings_h - gap)
    findings = Rect(x, path.bottom + gap, path.w, findings_h)
    return EditorPlaces(Rect(0, 0, width, title_h), text, path, findings, ask, prompt, keys, body)
