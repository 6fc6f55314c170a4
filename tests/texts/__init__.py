"""Texts of the product by id: a test names a message and its values, never its wording.

Each file ``NAME.toml`` of this folder holds ``id = "ENGLISH TEXT WITH {value}"``; a text in ``screen.toml``
has the id ``screen.id``. A text that is reworded changes in the product and on one line here.
``test_texts.py`` holds every line against the texts that the product has.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

from core.message import Message
from resources.translations.message_list import read_list

FOLDER = Path(__file__).parent
OF_EXTRAS = FOLDER.parent / "extras"  # an optional feature has the texts of its tests with them
SPANISH = FOLDER.parents[1] / "resources" / "translations" / "turndesk_es.ts"
HOLE = re.compile(r"\{[^{}]*\}")


class Pattern(str):
    """A regular expression; as a value of another pattern it is used as it is."""


@cache
def all_texts() -> dict[str, str]:
    """Return every template by its id."""
    return {
        f"{path.stem}.{name}": template
        for path in (*sorted(FOLDER.glob("*.toml")), *sorted(OF_EXTRAS.glob("*/*.toml")))
        for name, template in tomllib.loads(path.read_text(encoding="utf-8")).items()
    }


def text(name: str, /, **values: object) -> str:
    """Return a text with its values put in; raises KeyError for an unknown id or a missing value."""
    template = all_texts()[name]
    return template.format(**values) if values else template


def message(name: str, /, **values: object) -> Message:
    """Return a text as the product makes it: with the names that its template has for the values."""
    template = all_texts()[name]
    source, _ = spanish_texts()[HOLE.sub("{}", template)]
    names = dict(zip(HOLE.findall(template), HOLE.findall(source), strict=True))
    return Message(source, **{names[f"{{{key}}}"][1:-1]: value for key, value in values.items()})


def pattern(name: str, /, **values: object) -> Pattern:
    """Return a regular expression for the text; a value that is not given matches anything."""
    template = all_texts()[name]
    unknown = values.keys() - {part[1:-1] for part in HOLE.findall(template)}
    if unknown:
        raise KeyError(f"{name} has no {', '.join(sorted(unknown))}")
    parts = re.split(r"(\{\w+\})", template)
    return Pattern(
        "".join(
            _as_pattern(values.get(part[1:-1], Pattern(".*")))
            if re.fullmatch(r"\{\w+\}", part)
            else re.escape(part)
            for part in parts
        )
    )


def _as_pattern(value: object) -> str:
    """Return a value as a regular expression; only a pattern is one already."""
    return value if isinstance(value, Pattern) else re.escape(str(value))


def begins(shown: str, name: str, /, **values: object) -> bool:
    """Return whether the screen shows the text first; a value that is not given matches anything."""
    return re.match(pattern(name, **values), shown) is not None


def shows(shown: str, name: str, /, **values: object) -> bool:
    """Return whether the text is part of what is shown; a value that is not given matches anything."""
    return re.search(pattern(name, **values), shown) is not None


def fragment(name: str, /, **values: object) -> str:
    """Return the longest run of the text without an unknown value, for a search by plain text."""
    return max(_runs(name, values), key=len).strip()


def opening(name: str, /, **values: object) -> str:
    """Return the text up to its first unknown value, for a search by plain text."""
    return _runs(name, values)[0].strip()


def _runs(name: str, values: dict[str, object]) -> list[str]:
    """Return the runs of the text between its unknown values."""
    template = all_texts()[name]
    for key, value in values.items():
        template = template.replace(f"{{{key}}}", str(value))
    return HOLE.split(template)


@cache
def product_texts() -> frozenset[str]:
    """Return every English text of the product with its holes as ``{}``; those of drivers stay English."""
    return frozenset(HOLE.sub("{}", each) for each in read_list().values())


@cache
def spanish_texts() -> dict[str, tuple[str, str]]:
    """Return source and translation by the English text with its holes as ``{}``."""
    messages = ElementTree.parse(SPANISH).iter("message")
    return {
        HOLE.sub("{}", source): (source, each.findtext("translation") or "")
        for each in messages
        if (source := each.findtext("source"))
    }


def text_in_spanish(name: str, /, **values: object) -> str:
    """Return the translation of a text with its values put in; raises KeyError if there is none."""
    template = all_texts()[name]
    source, translation = spanish_texts()[HOLE.sub("{}", template)]
    ours = (part[1:-1] for part in HOLE.findall(template))
    names = dict(zip(HOLE.findall(source), ours, strict=True))
    return HOLE.sub(lambda hole: str(values[names[hole[0]]]), translation)
