"""The language of the screen: a catalogue of Qt's own format, looked up where texts are drawn."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from PySide6.QtCore import QTranslator

from app.desk.translation import ENGLISH, Catalogue, speak

CONTEXT = "turndesk"


def speak_in(language: str) -> None:
    """From now on texts are shown in this language. Raises FileNotFoundError for one without a catalogue."""
    speak(None if language == ENGLISH else catalogue(language).translate, language)


@cache
def catalogue(language: str) -> Catalogue:
    """The catalogue of a language, read once."""
    folder = files("resources") / "translations"
    translator = QTranslator()
    if not translator.load(str(folder / f"turndesk_{language}.qm")):
        raise FileNotFoundError(f"catalog turndesk_{language}.qm not found in {folder}")
    templates = (folder / "templates.txt").read_text(encoding="utf-8").splitlines()
    return Catalogue(lambda text: translator.translate(CONTEXT, text) or "", templates)
