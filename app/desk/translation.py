"""Translation of texts into the operator's language, without Qt.

The screen sets the translator when it starts. For a ``Message``, the template is translated, and its values
are translated and inserted. A text without values is translated as a whole. A text that is not in the
catalog remains in English.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

from core.message import LETTER_CASES, Message, MessageValue

# Returns the translation of a template or text; empty if the catalog has none.
Translate = Callable[[str], str]

ENGLISH_CODE = "en"


class _ActiveTranslation:
    """The active translator and its language."""

    translate_text: Translate | None = None
    language = ENGLISH_CODE


def set_translator(translate: Translate | None, language_code: str = ENGLISH_CODE) -> None:
    """Set the translator for all texts. With None, the texts remain in English.

    ``language_code`` is the ISO 639-1 code of the translator's language.
    """
    _ActiveTranslation.translate_text = None if translate is None else lru_cache(8192)(translate)
    _ActiveTranslation.language = language_code


def get_language() -> str:
    """Return the ISO 639-1 code of the active language."""
    return _ActiveTranslation.language


_NAMES = frozenset({"name", "program", "path", "text", "remark"})  # Placeholders for text of the user.
_PLACEHOLDER = re.compile(r"\{\w*\}")
_LOWER_CASE = re.compile(r"[a-z]{2}")
_CODE = re.compile(r"[^a-z\s]+")  # One word in capitals.

_DATA, _END = "\u2068", "\u2069"  # Unicode's isolate characters, which are not visible.


def mark_untranslated(text: str) -> str:
    """Return a user text, such as a remark, with a mark that prevents its translation by ``tr``."""
    return f"{_DATA}{text}{_END}" if text else ""


def tr(text: str) -> str:
    """Return a text in the operator's language, or the English text if it has no translation."""
    translate = _ActiveTranslation.translate_text
    shown = text if translate is None else _translated(text, translate)
    return shown.replace(_DATA, "").replace(_END, "") if _DATA in shown else str.__str__(shown)


def _translated(text: str, translate: Translate) -> str:
    if isinstance(text, Message):
        return _fill_message(text, translate)
    if text.startswith(_DATA) or not text:
        return text
    # A text in capitals may have its translation under the text in small letters.
    return translate(text) or (translate(text.lower()).upper() if text.isupper() else "") or text


def _fill_message(message: Message, translate: Translate) -> str:
    """Return the translated template with its translated values inserted."""
    template = translate(message.template) or message.template
    of_program = _LOWER_CASE.search(_PLACEHOLDER.sub("", message.template)) is not None
    values = {
        name: each if _is_untranslatable(name, each, of_program) else _translated(str(each), translate)
        for name, each in message.values.items()
    }
    made = template.format(**values)
    return LETTER_CASES[message.case](made) if message.case else made


def _is_untranslatable(name: str, value: MessageValue, of_program: bool) -> bool:
    """Return whether a value is a number, a name or a program word, which must not be translated."""
    if isinstance(value, Message):
        return False
    if not isinstance(value, str) or name in _NAMES:
        return True
    return of_program and _CODE.fullmatch(value) is not None
