"""Translation of texts into the operator's language. No Qt: the screen passes in the translator at its start.

A text with values is a ``Message``: its template is looked up, its values are translated and put in.
A text without values is looked up as it is. A text that the catalogue does not have stays English.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

from core.message import CASES, Message, Value

Translate = Callable[[str], str]  # the translation of a template or a whole text; empty if there is none

ENGLISH = "en"


class _Speaker:
    """The translator in use and its language."""

    translate: Translate | None = None
    language = ENGLISH


def speak(translate: Translate | None, language: str = ENGLISH) -> None:
    """Translate texts by ``translate`` from now on; None leaves them English.

    ``language`` is its code, as ISO 639-1 has it.
    """
    _Speaker.translate = None if translate is None else lru_cache(8192)(translate)
    _Speaker.language = language


def spoken() -> str:
    """Return the language that texts are shown in now."""
    return _Speaker.language


_NAMES = frozenset({"name", "program", "path", "text", "remark"})  # holes for text of the user
_HOLE = re.compile(r"\{\w*\}")
_LOWER = re.compile(r"[a-z]{2}")
_CODE = re.compile(r"[^a-z\s]+")  # one word in capitals

_DATA, _END = "\u2068", "\u2069"  # Unicode's isolates: they are not visible


def data(text: str) -> str:
    """Mark a text of the user, such as a remark or a name: ``tr`` does not translate it."""
    return f"{_DATA}{text}{_END}" if text else ""


def tr(text: str) -> str:
    """Return a text in the operator's language; the English text where the catalogue has none."""
    translate = _Speaker.translate
    shown = text if translate is None else _translated(text, translate)
    return shown.replace(_DATA, "").replace(_END, "") if _DATA in shown else str.__str__(shown)


def _translated(text: str, translate: Translate) -> str:
    if isinstance(text, Message):
        return _filled(text, translate)
    if text.startswith(_DATA) or not text:
        return text
    # Sentences that are written in small letters are found by them where the screen shows capitals.
    return translate(text) or (translate(text.lower()).upper() if text.isupper() else "") or text


def _filled(message: Message, translate: Translate) -> str:
    """Return the translated template with its translated values."""
    template = translate(message.template) or message.template
    of_program = _LOWER.search(_HOLE.sub("", message.template)) is not None
    values = {
        name: each if _is_own_word(name, each, of_program) else _translated(str(each), translate)
        for name, each in message.values.items()
    }
    made = template.format(**values)
    return CASES[message.case](made) if message.case else made


def _is_own_word(name: str, value: Value, of_program: bool) -> bool:
    """Return whether a value is a number, a name, or a word of the program in a finding."""
    if isinstance(value, Message):
        return False
    if not isinstance(value, str) or name in _NAMES:
        return True
    return of_program and _CODE.fullmatch(value) is not None
