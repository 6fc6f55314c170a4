"""Texts in the operator's language. No Qt here: the screen says at its start who translates.

Everything that is read on the screen goes through ``tr`` with its English text as a literal, so that the
catalogues can be made from the sources; values are put in afterwards: ``tr("LINE {line}").format(line=7)``.
"""

from __future__ import annotations

from collections.abc import Callable

Translate = Callable[[str], str]


class _Speaker:
    """Whoever translates now; English needs nobody."""

    translate: Translate | None = None


def speak(translate: Translate | None) -> None:
    """From now on texts go through ``translate``; None: they stay English."""
    _Speaker.translate = translate


def tr(text: str) -> str:
    """The text in the operator's language; the English one where the catalogue has none."""
    translate = _Speaker.translate
    return text if translate is None else translate(text) or text
