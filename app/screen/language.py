"""The language of the screen: a catalogue of Qt's own format, looked up where texts are drawn."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from PySide6.QtCore import QTranslator

from app.desk.translation import ENGLISH, Translate, speak
from core.message import Message

CONTEXT = "turndesk"


def speak_in(language: str) -> None:
    """From now on texts are shown in this language. Raises FileNotFoundError for one without a catalogue."""
    speak(None if language == ENGLISH else catalogue(language), language)


@cache
def catalogue(language: str) -> Translate:
    """Return the catalog of a language, read once; it returns an empty text for one that it does not have."""
    folder = files("resources") / "translations"
    translator = QTranslator()
    if not translator.load(str(folder / f"turndesk_{language}.qm")):
        raise FileNotFoundError(
            Message("catalog turndesk_{language}.qm not found in {folder}", language=language, folder=folder)
        )
    return lambda text: translator.translate(CONTEXT, text) or ""
