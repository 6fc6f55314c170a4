"""Translation of texts into the operator's language. No Qt: the screen says at its start who translates.

Everything that is read on the screen goes through ``tr`` with its English text as a literal, so that the
catalogues can be made from the sources; values are put in afterwards: ``tr("LINE {line}").format(line=7)``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import lru_cache

Translate = Callable[[str], str]


ENGLISH = "en"


class _Speaker:
    """Whoever translates now, and into which language; English needs nobody."""

    translate: Translate | None = None
    language = ENGLISH


def speak(translate: Translate | None, language: str = ENGLISH) -> None:
    """From now on texts go through ``translate``; None: they stay English.

    ``language`` is its code, as ISO 639-1 has it.
    """
    _Speaker.translate, _Speaker.language = translate, language


def spoken() -> str:
    """The language that texts are shown in now."""
    return _Speaker.language


_DATA, _END = "\u2068", "\u2069"  # Unicode's own isolates: they take no room


def data(text: str) -> str:
    """Somebody's text within a sentence that ``tr`` gets: a remark, a name. It is left as it is."""
    return f"{_DATA}{text}{_END}" if text else ""


def tr(text: str) -> str:
    """The text in the operator's language; the English one where the catalogue has none."""
    translate = _Speaker.translate
    shown = text if translate is None else translate(text) or text
    return shown.replace(_DATA, "").replace(_END, "") if _DATA in shown else shown


# --- the catalogue of texts ---------------------------------------------------------------------------


Find = Callable[[str], str]  # the translation of a whole text; empty: it has none

HOLE = re.compile(r"%\d|\{\w*(?:[:.][^{}]*)?\}")
BETWEEN = "  ·  "  # parts of a title are texts of their own
_AND = " · "  # those of the prompt line too
_UNIT = re.compile(r"(?<=\d )in(?:/min|/rev|/s²?)?(?=$|[,;)]|  | […×]|\n)")  # not the word in of a sentence
_WORD = re.compile(r"[^\W\d_]{2}")
_DEEPEST = 5  # values in values: REFUSED, why, the program, its line, the sentence, what stands in it
_JOINER = 8  # characters round holes, such as " and ", that also stand in sentences nobody knows
_SENTENCE = re.compile(r"(?<=[.?!]) (?=[A-Z0-9'/(%{\[])|(?<=\)) (?=[A-Z][a-z])")
_NAMES = frozenset({"{name}", "{program}", "{path}", "{text}", "{remark}"})  # holes for somebody's text
_HINT = "] — "  # what to do, behind the code of a finding
_SLIGHT = 4  # characters between two holes, such as " OF ", that any sentence has


_LOWER = re.compile(r"[a-z]{2}")
_CODE = re.compile(r"[^a-z\s]+")  # one word in capitals: in a finding it is the program's own


def _is_data(text: str) -> bool:
    return text.startswith(_DATA) and text.find(_END) == len(text) - 1


def _is_unknown(text: str, told: str) -> bool:
    """Whether it is a piece of a sentence that has no translation: it would stand half translated."""
    return told == text and _LOWER.search(text) is not None and " " in text


class _Template:
    """One sentence with holes, in both languages.

    ``of_program``: it is no sentence of the screen, which are in capitals, but a finding about a program.
    """

    def __init__(self, english: str, other: str) -> None:
        pieces = HOLE.split(english)
        self.head, self.tail = pieces[0], pieces[-1]
        self.weight = sum(map(len, pieces)) - 2 * pieces.count(" ")  # two holes side by side are unsure
        self.joined = _AND in english
        self.of_program = any(_LOWER.search(piece) for piece in pieces)
        self.slight = not (self.head or self.tail) and self.weight <= _SLIGHT
        self.before = bool(self.head) and not self.tail and pieces[-2].endswith(": ")
        self.hinted = any(_HINT in piece for piece in pieces)
        self.several = len(_SENTENCE.split(english)) > 1
        self.joiner = not self.head and len(self.tail) <= 1 and self.weight <= _JOINER
        self._holes = HOLE.findall(english)
        self._other = other
        self._pattern: re.Pattern[str] | None = None
        self._pieces = pieces

    def values(self, text: str) -> dict[str, str] | None:
        """What stands in the holes; None when the text was not made of this."""
        if not (text.startswith(self.head) and text.endswith(self.tail)):
            return None
        if self._pattern is None:
            self._pattern = re.compile("(.+?)".join(map(re.escape, self._pieces)), re.DOTALL)
        found = self._pattern.fullmatch(text)
        return dict(zip(self._holes, found.groups(), strict=True)) if found else None

    def filled(self, values: dict[str, str]) -> str:
        """The other language's sentence with these values."""
        return HOLE.sub(lambda hole: values.get(hole.group(), hole.group()), self._other)


class Catalogue:
    """``find`` answers whole texts, ``templates`` are the English ones with holes."""

    def __init__(self, find: Find, templates: Iterable[str]) -> None:
        self._find = find
        found = [_Template(text, other) for text in templates if (other := find(text))]
        told = (template for template in found if not template.slight)
        self._templates = sorted(told, key=lambda template: -template.weight)
        self._before = [each for each in self._templates if each.before]
        self.translate = lru_cache(8192)(self._translated)

    def _translated(self, text: str) -> str:
        return self._look_up(text, 0) or text

    def _look_up(self, text: str, depth: int, of_program: bool = False) -> str:
        """Empty when nothing of it is known; ``of_program``: within a finding about a program."""
        if depth > _DEEPEST or not _WORD.search(text) or _is_data(text):
            return ""
        whole = self._find(text) or self._shouted(text)
        made = whole or self._sentences(text, depth, of_program) or self._made(text, depth, of_program)
        return made or self._joined(text, depth) or self._headed(text, depth) or self._measured(text)

    def _shouted(self, text: str) -> str:
        """Sentences of the control that are shown in capitals."""
        return self._find(text.lower()).upper() if text.isupper() else ""

    def _sentences(self, text: str, depth: int, of_program: bool) -> str:
        """What is wrong and what to do behind it: both in one template, or each known by itself."""
        said = _SENTENCE.split(text)
        if len(said) == 1 or _HINT in text or self._announced(text):
            return ""
        whole = self._made(text, depth, of_program, several=True)
        told = [] if whole else [self._look_up(each, depth + 1, of_program) for each in said]
        return whole or (" ".join(told) if all(told) else "")

    def _announced(self, text: str) -> str:
        """The head of what stands before a sentence, such as REFUSED or its line: it goes first."""
        return next((each.head for each in self._before if each.values(text)), "")

    def _joined(self, text: str, depth: int) -> str:
        if _AND not in text:
            return ""
        between = BETWEEN if BETWEEN in text else _AND
        parts = [self._look_up(part, depth + 1) or part for part in text.split(between)]
        joined = between.join(parts)
        return joined if joined != text else ""

    def _headed(self, text: str, depth: int) -> str:
        """A name, a colon and a sentence: what a tool, a file or a feature is told of."""
        head, _, said = text.partition(": ")
        told = self._look_up(said, depth + 1) if said and " " in said else ""
        return f"{head}: {told}" if told else ""

    def _measured(self, text: str) -> str:
        """The units behind figures that no sentence stands round."""
        shown = _UNIT.sub(lambda unit: self._find(unit.group()) or unit.group(), text)
        return shown if shown != text else ""

    def _made(self, text: str, depth: int, of_program: bool, several: bool = False) -> str:
        joined = _AND in text  # its parts are texts: no hole reaches over from one into the next
        before = self._announced(text)
        hinted = _HINT in text and not before  # a finding in one line: it is taken apart first
        for template in self._templates:
            if (joined and not template.joined) or (several and not template.several):
                continue
            if hinted and not template.hinted:
                continue
            values = template.values(text) if template.head.startswith(before) else None
            if values is None:
                continue
            found = of_program or template.of_program
            told = {hole: self._value(hole, value, depth, found) for hole, value in values.items()}
            if not (template.joiner and any(map(_is_unknown, values.values(), told.values()))):
                return template.filled(told)
        return ""

    def _value(self, hole: str, value: str, depth: int, of_program: bool) -> str:
        """What stands in a hole: a sentence of ours is translated, what a program says is not."""
        if hole in _NAMES or (of_program and _CODE.fullmatch(value)):
            return value
        return self._look_up(value, depth + 1, of_program) or value
