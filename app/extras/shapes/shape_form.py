"""The form of one shape: what is typed, what it comes to, what is wrong; and forms that features add."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from app.desk.arithmetic import CHARACTERS, EntryError, value_of
from app.desk.pages.sheet import Key, edited
from app.desk.translation import tr
from core.extras.shapes.contour import Row, row_word
from core.extras.shapes.lines.code_lines import plain
from core.extras.shapes.pieces import Piece
from core.extras.shapes.shape import Filled, Shape, filled
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, choice_text
from core.extras.shapes.threads.thread_series import SIZES, Series
from core.extras.shapes.threads.thread_values import class_choices, series_of
from core.sketch import Sketch

COLUMNS = ("X", "Z", "C", "R", "A")
"""Of a point: diameter, Z, chamfer, radius, arc (+ by G02, − by G03)."""
_PARTS = ("x", "z", "chamfer", "radius", "arc")
_NAMES = frozenset("0123456789./#-MX")  # that names of sizes are typed with
_LONGEST = 24


class Cell(NamedTuple):
    """What is shown of a field: label, figure, whether it was typed, what is wrong with it."""

    word: str
    label: str
    figure: str
    typed: bool
    trouble: str
    choice: bool


@dataclass(slots=True)
class ShapeForm:
    """``typed`` has texts by field, ``rows`` texts by column; ``marked`` counts fields, then points.

    ``instead``: the piece of the text that it was opened from.
    """

    shape: Shape
    setting: Setting
    instead: Piece | None = None
    typed: dict[str, str] = field(default_factory=dict)
    rows: list[dict[str, str]] = field(default_factory=list)
    marked: int = 0
    column: int = 0
    afresh: bool = True  # the next character begins the entry anew
    one: Filled = field(init=False)
    troubles: dict[str, str] = field(default_factory=dict)
    lines: list[str] = field(default_factory=list)
    worked: int = 0  # how often it was worked out
    words: tuple[str, ...] = ()  # what is to be said of the lines

    def __post_init__(self) -> None:
        if self.instead is not None:
            self._take(self.instead.filled)
        elif self.shape.contour:
            self.rows = [{"X": "0", "Z": "0"}]
        self.work()
        self.marked = self._first()

    def use_setting(self, setting: Setting) -> None:
        """Calculate again with other tool data."""
        self.setting = setting
        self.work()

    def _take(self, one: Filled) -> None:
        """Everything that the text says counts as typed."""
        for word, value in one.values.items():
            self.typed[word] = value if isinstance(value, str) else plain(value, 6)
        for row in one.rows:
            said = {c: getattr(row, p) for c, p in zip(COLUMNS, _PARTS, strict=True)}
            keep = {c: v for c, v in said.items() if v is not None and (v or c in "XZ")}
            self.rows.append({c: plain(v, 6) for c, v in keep.items()})

    def _first(self) -> int:
        """Where to begin: at the first field for which nothing is proposed, else at the points."""
        for place, each in enumerate(self.fields):
            if self.one.values.get(each.word) is None:
                return place
        return len(self.fields) + 1 if self.shape.contour else 0

    # --- what it comes to ----------------------------------------------------------------------------

    def work(self) -> None:
        """Everything anew from what is typed."""
        self.worked += 1
        self.troubles = {}
        values = {word: value for word in self.typed if (value := self._value(word)) is not None}
        rows = tuple(self._row(number) for number in range(len(self.rows)))
        while rows and rows[-1].empty:
            rows = rows[:-1]
        self.one = filled(self.shape, values, self.setting, rows)
        if not self.troubles:
            for refused in self._refusals():
                self.troubles.setdefault(refused.word, refused.text)
        self.lines = [] if self.troubles else self.one.lines(self.setting)
        self.words = () if self.troubles else self.shape.says(self.one, self.setting)

    def _refusals(self) -> list[Refusal]:
        try:
            return self.one.refusals(self.setting)
        except ArithmeticError:
            word = self.fields[min(self.marked, len(self.fields) - 1)].word
            return [
                Refusal(
                    word, "These values do not make a valid shape: check the last value that you entered."
                )
            ]

    def _value(self, word: str) -> Value | None:
        known, said = self.shape.field(word), self.typed[word]
        if known is None or not said:
            return None
        if known.kind in {Kind.CHOICE, Kind.NAME}:
            return said
        return self._number(word, said)

    def _number(self, word: str, said: str) -> float | None:
        try:
            return value_of(said)
        except EntryError as error:
            self.troubles[word] = str(error)
            return None

    def _row(self, number: int) -> Row:
        said = self.rows[number]
        word = row_word(number + 1)
        found = {c: self._number(word, said[c]) for c in COLUMNS if said.get(c)}
        return Row(found.get("X"), found.get("Z"), *(found.get(c) or 0.0 for c in ("C", "R", "A")))

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def fields(self) -> tuple[Field, ...]:
        """Those that exist now."""
        return self.one.fields if hasattr(self, "one") else self.shape.fields

    @property
    def count(self) -> int:
        """Of fields and points, an empty one behind the last."""
        return len(self.fields) + (len(self.rows) + 1 if self.shape.contour else 0)

    @property
    def field(self) -> Field | None:
        """The marked one; None on a point."""
        return self.fields[self.marked] if self.marked < len(self.fields) else None

    @property
    def point(self) -> int:
        """The number of the marked point, from 0; -1 on a field."""
        return self.marked - len(self.fields) if self.marked >= len(self.fields) else -1

    @property
    def word(self) -> str:
        """That of the marked field or point."""
        here = self.field
        return here.word if here is not None else row_word(self.point + 1)

    def cells(self) -> list[Cell]:
        """All fields."""
        return [
            Cell(
                each.word,
                each.label,
                self.shown(each),
                each.word in self.typed,
                self.troubles.get(each.word, ""),
                bool(self.choices(each)),
            )
            for each in self.fields
        ]

    def figure(self, each: Field) -> str:
        """What stands in a field: as typed, else what is proposed."""
        if each.word in self.typed:
            return self.typed[each.word]
        value = self.one.values.get(each.word)
        if value is None:
            return ""
        return value if isinstance(value, str) else plain(value, 6)

    def shown(self, each: Field) -> str:
        """The same as an operator reads it: a choice in his language, names and sizes as they are."""
        said = self.figure(each)
        return shown_choice(each, said) if self.is_word(each, said) else said

    def is_word(self, each: Field, choice: str) -> bool:
        """Whether a choice is a word of ours, and no name or size."""
        return choice in each.choices

    def dimension(self, word: str) -> str:
        """The figure of a dimension of the drawing."""
        if word.startswith("#"):
            number = int(word[1:]) - 1
            return word if number < len(self.rows) else ""
        known = self.shape.field(word)
        return self.shown(known) if known is not None and known in self.fields else ""

    def choices(self, each: Field) -> tuple[str, ...]:
        """What a field is chosen from; none where it is typed."""
        if each.word == "CLASS":
            return class_choices(self.one.values)
        if each.word == "SIZE":
            return tuple(size.name for size in SIZES.get(series_of(self.one.values), ()))
        return each.choices

    @property
    def trouble(self) -> str:
        """What is wrong where the mark stands, else what is wrong first."""
        return self.troubles.get(self.word) or next(iter(self.troubles.values()), "")

    @property
    def sketch(self) -> Sketch:
        """The drawing whose dimensions are the fields."""
        return self.shape.sketch(self.one)

    @property
    def waits(self) -> bool:
        """Whether the lines are still to come."""
        return False

    # --- keys ----------------------------------------------------------------------------------------

    def touch_at(self, point: tuple[float, float]) -> None:
        """The pointer on the drawing, beside all figures."""

    def go(self, place: int, column: int = 0) -> None:
        """Mark another field or point."""
        self.marked = max(0, min(place, self.count - 1))
        self.column, self.afresh = column, True

    def go_to(self, word: str) -> None:
        """Mark the field or the point of this word, as a finger on the drawing does."""
        if word.startswith("#"):
            self.go(len(self.fields) + int(word[1:]) - 1)
            return
        for place, each in enumerate(self.fields):
            if each.word == word:
                self.go(place)

    def takes(self, key: str) -> bool:
        """Whether a character is text where the mark stands."""
        if len(key) != 1:
            return False
        here = self.field
        if here is None:
            return key in CHARACTERS or key.upper() in COLUMNS
        if here.kind is Kind.NAME:
            return key.upper() in _NAMES
        if here.kind is Kind.CHOICE:
            return any(self._begins(here, each, key) for each in self.choices(here))
        return key in CHARACTERS

    def typed_key(self, key: str) -> bool:
        """A key; False when it means nothing here."""
        moves = {"Up": -1, "Down": 1, "Enter": 1, "Page up": -8, "Page down": 8}
        if key in moves:
            self.go(self.marked + moves[key])
        elif key in {"Left", "Right", "Tab"}:
            self._sideways(-1 if key == "Left" else 1)
        elif self.takes(key) or key in {"Back", "Delete"}:
            self._write(key)
        else:
            return False
        return True

    def _sideways(self, by: int) -> None:
        here = self.field
        if here is None:
            self.column, self.afresh = (self.column + by) % len(COLUMNS), True
        elif choices := self.choices(here):
            now = self.figure(here)
            place = choices.index(now) + by if now in choices else 0
            self._set(here.word, choices[place % len(choices)])
        else:
            self.go(self.marked + by)

    def _write(self, key: str) -> None:
        here = self.field
        if here is None:
            self._write_point(key)
        elif here.kind is Kind.CHOICE:
            self._pick(here, key)
        else:
            before = "" if self.afresh and key != "Back" else self.figure(here)
            self._set(here.word, edited(before, key.upper() if here.kind is Kind.NAME else key, _LONGEST))
            self.afresh = False

    def _pick(self, here: Field, key: str) -> None:
        """The next choice that begins with a letter; Delete takes the proposal again."""
        choices, now = self.choices(here), self.figure(here)
        if key in {"Back", "Delete"}:
            self.typed.pop(here.word, None)
            self.work()
            return
        start = choices.index(now) + 1 if now in choices else 0
        order = (*choices[start:], *choices[:start])
        self._set(here.word, next(each for each in order if self._begins(here, each, key)))

    def _begins(self, here: Field, choice: str, key: str) -> bool:
        """Whether a choice begins with a letter as it is shown."""
        said = shown_choice(here, choice) if self.is_word(here, choice) else choice
        return said.upper().startswith(key.upper())

    def _write_point(self, key: str) -> None:
        """A letter leads to its column, figures are written there; the empty point behind the last begins."""
        if key.upper() in COLUMNS:
            self.column, self.afresh = COLUMNS.index(key.upper()), True
            return
        while len(self.rows) <= self.point:
            self.rows.append({})
        row, column = self.rows[self.point], COLUMNS[self.column]
        before = "" if self.afresh and key != "Back" else row.get(column, "")
        row[column] = edited(before, key, _LONGEST)
        if not row[column]:
            del row[column]
        self.afresh = False
        self._work_at(self.point)

    def _work_at(self, point: int) -> None:
        """Calculate again with the mark on a point: the fields above it depend on the points."""
        self.work()
        self.marked = len(self.fields) + point

    def _set(self, word: str, said: str) -> None:
        if said:
            self.typed[word] = said
        else:
            self.typed.pop(word, None)
        self.work()
        self.marked = next((n for n, each in enumerate(self.fields) if each.word == word), self.marked)

    def insert_point(self) -> None:
        """An empty point before the marked one."""
        if self.point >= 0:
            self.rows.insert(self.point, {})
            self._work_at(self.point)

    def drop_point(self) -> None:
        """Take the marked point out."""
        if 0 <= self.point < len(self.rows):
            del self.rows[self.point]
            self._work_at(self.point)


def shown_choice(each: Field, choice: str) -> str:
    """A choice in the operator's language, which may call it otherwise beside another label."""
    known = choice_text(each, choice)
    said = tr(known)
    return choice if said == known else said


Show = Callable[[ShapeForm], str | None]
"""Shows what a form has worked out, and returns the whole text; None when the form is no longer open."""


class AddedForm(ABC):
    """One form of the list, with what it works out beside the screen. ``key`` opens it."""

    key: str
    shape: Shape

    @abstractmethod
    def open_form(self, setting: Setting, before: tuple[str, ...], wanted: Path | None) -> ShapeForm:
        """Return a new form; ``before`` are the lines in front, ``wanted`` is the file to begin with."""

    @abstractmethod
    def makes_of(self, name: str) -> bool:
        """Return whether this form makes a program of a file of this name."""

    @abstractmethod
    def work(self, form: ShapeForm, show: Show, tell: Callable[[str], None]) -> None:
        """Work out what has been typed; ``tell`` is told why that is impossible."""

    @abstractmethod
    def cancel(self, form: ShapeForm) -> None:
        """Stop working."""

    @abstractmethod
    def keys(self, form: ShapeForm, show: Show) -> Mapping[int, Key]:
        """Return the function keys that only this form has."""

    @abstractmethod
    def prompt(self, form: ShapeForm) -> str:
        """Return what the prompt line says."""

    @abstractmethod
    def poll(self) -> None:
        """Take up what the workers have found; called once a frame."""

    @abstractmethod
    def close(self) -> None:
        """End the workers."""


def words_of(shapes: Iterable[Shape]) -> list[str]:
    """Return the names of shapes and of their fields: many are single words."""
    shapes = tuple(shapes)
    fields = [field for shape in shapes for field in shape.fields]
    labels = {field.label for field in fields if len(field.label) > 1}
    choices = {choice_text(field, choice) for field in fields for choice in _in_words(field)}
    return sorted({shape.name for shape in shapes} | labels | choices)


def _in_words(field: Field) -> tuple[str, ...]:
    """The choices that are words: series and classes of threads have names that all languages use."""
    if field.word == "SERIES":
        return (Series.OWN.value,)
    return () if field.word in {"CLASS", "SIZE"} else field.choices
