"""Check of a translated text of the guide: its keys, codes, numbers, links and texts of the screen."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping

_LINK_TARGET = re.compile(r"\]\(([^)\s]+)\)")
_SPAN = re.compile(r"`([^`]+)`")
_KEY_LABEL = re.compile(r"`(F\d+)` \(?([A-Z][A-Z0-9+.\-]*(?: [A-Z0-9+.\-]+)*)(?![a-z])")
_NUMBER = re.compile(r"\d+(?:\.\d+)*")
_CAPITALS = re.compile(r"(?<![\w.-])[A-Z][A-Z-]+(?![\w=])")
_SENTENCE = re.compile(r"[A-Z][a-z]+(?: [\w,:]+)+[.?]|[a-z]+(?: [a-z:]+){3,}")
_CELL_MARK = " | "
_COMMAND_WORDS = frozenset({"FILE"})
"""Words that stand for a value in commands and are also labels of the screen."""


def find_faults(english: str, translation: str, screen_texts: Mapping[str, str]) -> list[str]:
    """Return the faults of a translation, or an empty list.

    ``screen_texts`` contains the translation of each text of the screen. Keys, codes, commands, numbers and
    links must be the same in both texts, and texts of the screen must be those of the translated screen.
    """
    if not translation.strip():
        return ["not translated"]
    pairs = [
        ("links", _LINK_TARGET.findall(english), _LINK_TARGET.findall(translation)),
        ("numbers", _NUMBER.findall(english), _NUMBER.findall(translation)),
        ("cells", [_CELL_MARK] * english.count(_CELL_MARK), [_CELL_MARK] * translation.count(_CELL_MARK)),
        ("bold marks", ["**"] * english.count("**"), ["**"] * translation.count("**")),
        *_pair_spans(english, translation, screen_texts),
        *_pair_labels(english, translation, screen_texts),
    ]
    return [fault for name, wanted, found in pairs for fault in _compare(name, wanted, found)]


def is_screen_text(span: str) -> bool:
    """Return whether a code span is a text of the screen, and not a key, a code, a command or a file."""
    if span in _COMMAND_WORDS or span.startswith(("turndesk", "sh ", "[", "-")):
        return False
    return bool(_CAPITALS.search(span) or _SENTENCE.fullmatch(span))


def _pair_spans(
    english: str, translation: str, screen_texts: Mapping[str, str]
) -> list[tuple[str, list[str], list[str]]]:
    """Return the code spans that the translation must contain, together with those that it contains.

    A text of the screen that is not in the catalog as a whole, such as the beginning of a message, is only
    counted.
    """
    wanted = [screen_texts.get(span, "") if is_screen_text(span) else span for span in _SPAN.findall(english)]
    found = _SPAN.findall(translation)
    fixed = Counter(span for span in wanted if span)
    rest = list((Counter(found) - fixed).elements())
    return [
        ("code spans", sorted(fixed.elements()), sorted((Counter(found) & fixed).elements())),
        ("number of code spans", ["`"] * (len(wanted) - fixed.total()), ["`"] * len(rest)),
    ]


def _pair_labels(
    english: str, translation: str, screen_texts: Mapping[str, str]
) -> list[tuple[str, list[str], list[str]]]:
    """Return the labels of function keys that the translation must contain, and those that it contains."""
    wanted = [
        f"`{key}` {screen_texts[label]}"
        for key, label in _KEY_LABEL.findall(english)
        if label in screen_texts
    ]
    plain = translation.replace("` (", "` ")
    return [("key labels", wanted, [label for label in wanted if label in plain])]


def _compare(name: str, wanted: list[str], found: list[str]) -> list[str]:
    """Return the differences between the wanted and the found elements, regardless of their order."""
    missing, extra = Counter(wanted) - Counter(found), Counter(found) - Counter(wanted)
    return [f"{name}: missing {each}" for each in missing] + [f"{name}: unexpected {each}" for each in extra]
