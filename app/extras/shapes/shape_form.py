"""Form of one shape: entries, calculated values and errors; also the base of forms from other features."""

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
_NAMES = frozenset("0123456789./#-MX")  # characters for the names of sizes
_LONGEST = 24


class Cell(NamedTuple):
    """Field for display: label, value, whether it was typed, and its error."""

    word: str
    label: str
    figure: str
    typed: bool
    trouble: str
    choice: bool


@dataclass(slots=True)
class ShapeForm:
    """Form of a shape. ``typed`` contains texts by field, and ``rows`` texts by column of each point.

    ``marked`` is the index of the selected field or, after the fields, of the selected point. ``instead`` is
    the piece of the text from which the form was opened.
    """

    shape: Shape
    setting: Setting
    instead: Piece | None = None
    typed: dict[str, str] = field(default_factory=dict)
    rows: list[dict[str, str]] = field(default_factory=list)
    marked: int = 0
    column: int = 0
    afresh: bool = True  # the next character replaces the entry
    one: Filled = field(init=False)
    troubles: dict[str, str] = field(default_factory=dict)
    lines: list[str] = field(default_factory=list)
    worked: int = 0  # number of calculations
    words: tuple[str, ...] = ()  # remarks about the lines

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
        """Enter all values of a piece of the text as typed entries."""
        for word, value in one.values.items():
            self.typed[word] = value if isinstance(value, str) else plain(value, 6)
        for row in one.rows:
            said = {c: getattr(row, p) for c, p in zip(COLUMNS, _PARTS, strict=True)}
            keep = {c: v for c, v in said.items() if v is not None and (v or c in "XZ")}
            self.rows.append({c: plain(v, 6) for c, v in keep.items()})

    def _first(self) -> int:
        """Return the first field without a proposed value, or else the second point of a contour."""
        for place, each in enumerate(self.fields):
            if self.one.values.get(each.word) is None:
                return place
        return len(self.fields) + 1 if self.shape.contour else 0

    # --- calculation ---------------------------------------------------------------------------------

    def work(self) -> None:
        """Calculate everything from the entries."""
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

    # --- display -------------------------------------------------------------------------------------

    @property
    def fields(self) -> tuple[Field, ...]:
        """Fields that apply to the present choices."""
        return self.one.fields if hasattr(self, "one") else self.shape.fields

    @property
    def count(self) -> int:
        """Number of fields and points, including an empty point at the end."""
        return len(self.fields) + (len(self.rows) + 1 if self.shape.contour else 0)

    @property
    def field(self) -> Field | None:
        """Selected field, or None if a point is selected."""
        return self.fields[self.marked] if self.marked < len(self.fields) else None

    @property
    def point(self) -> int:
        """Index of the selected point from 0, or -1 if a field is selected."""
        return self.marked - len(self.fields) if self.marked >= len(self.fields) else -1

    @property
    def word(self) -> str:
        """Word of the selected field or point."""
        here = self.field
        return here.word if here is not None else row_word(self.point + 1)

    def cells(self) -> list[Cell]:
        """Return all fields for display."""
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
        """Return the text of a field: the entry, or else the proposed value."""
        if each.word in self.typed:
            return self.typed[each.word]
        value = self.one.values.get(each.word)
        if value is None:
            return ""
        return value if isinstance(value, str) else plain(value, 6)

    def shown(self, each: Field) -> str:
        """Return the text of a field for the operator, with translated choices."""
        said = self.figure(each)
        return shown_choice(each, said) if self.is_word(each, said) else said

    def is_word(self, each: Field, choice: str) -> bool:
        """Return whether a choice is a translatable word instead of a name or a size."""
        return choice in each.choices

    def dimension(self, word: str) -> str:
        """Return the value of a dimension of the drawing, or an empty string."""
        if word.startswith("#"):
            number = int(word[1:]) - 1
            return word if number < len(self.rows) else ""
        known = self.shape.field(word)
        return self.shown(known) if known is not None and known in self.fields else ""

    def choices(self, each: Field) -> tuple[str, ...]:
        """Return the choices of a field, or an empty tuple if the field is typed."""
        if each.word == "CLASS":
            return class_choices(self.one.values)
        if each.word == "SIZE":
            return tuple(size.name for size in SIZES.get(series_of(self.one.values), ()))
        return each.choices

    @property
    def trouble(self) -> str:
        """Error of the selected field or point, or else the first error."""
        return self.troubles.get(self.word) or next(iter(self.troubles.values()), "")

    @property
    def sketch(self) -> Sketch:
        """Drawing whose dimensions are the fields."""
        return self.shape.sketch(self.one)

    @property
    def waits(self) -> bool:
        """Whether the lines are still being calculated."""
        return False

    # --- keys ----------------------------------------------------------------------------------------

    def touch_at(self, point: tuple[float, float]) -> None:
        """Handle a touch on the drawing outside its dimensions."""

    def go(self, place: int, column: int = 0) -> None:
        """Select a field or point by index."""
        self.marked = max(0, min(place, self.count - 1))
        self.column, self.afresh = column, True

    def go_to(self, word: str) -> None:
        """Select the field or point of a word."""
        if word.startswith("#"):
            self.go(len(self.fields) + int(word[1:]) - 1)
            return
        for place, each in enumerate(self.fields):
            if each.word == word:
                self.go(place)

    def takes(self, key: str) -> bool:
        """Return whether a character is part of an entry at the selection."""
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
        """Handle a key. Return False if it has no function here."""
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
        """Select the next choice that begins with a letter. Delete restores the proposed choice."""
        choices, now = self.choices(here), self.figure(here)
        if key in {"Back", "Delete"}:
            self.typed.pop(here.word, None)
            self.work()
            return
        start = choices.index(now) + 1 if now in choices else 0
        order = (*choices[start:], *choices[:start])
        self._set(here.word, next(each for each in order if self._begins(here, each, key)))

    def _begins(self, here: Field, choice: str, key: str) -> bool:
        """Return whether the displayed text of a choice begins with a letter."""
        said = shown_choice(here, choice) if self.is_word(here, choice) else choice
        return said.upper().startswith(key.upper())

    def _write_point(self, key: str) -> None:
        """Handle a key on a point.

        A letter selects its column, and digits edit the value. The empty point at the end becomes a new
        point.
        """
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
        """Calculate again and keep the selection on a point, because the fields depend on the points."""
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
        """Insert an empty point before the selected point."""
        if self.point >= 0:
            self.rows.insert(self.point, {})
            self._work_at(self.point)

    def drop_point(self) -> None:
        """Delete the selected point."""
        if 0 <= self.point < len(self.rows):
            del self.rows[self.point]
            self._work_at(self.point)


def shown_choice(each: Field, choice: str) -> str:
    """Return the translated text of a choice, or the choice itself without a translation."""
    known = choice_text(each, choice)
    said = tr(known)
    return choice if said == known else said


Show = Callable[[ShapeForm], str | None]
"""Shows what a form has worked out, and returns the whole text; None when the form is no longer open."""


class AddedForm(ABC):
    """Form that another feature adds to the list; calculates on a worker, and ``key`` opens it."""

    key: str
    shape: Shape

    @abstractmethod
    def open_form(self, setting: Setting, before: tuple[str, ...], wanted: Path | None) -> ShapeForm:
        """Return a new form.

        ``before`` contains the preceding lines, ``wanted`` is the file to open.
        """

    @abstractmethod
    def makes_of(self, name: str) -> bool:
        """Return whether this form makes a program from a file with this name."""

    @abstractmethod
    def work(self, form: ShapeForm, show: Show, tell: Callable[[str], None]) -> None:
        """Calculate the form on a worker.

        ``tell`` is called with a reason if that is not possible.
        """

    @abstractmethod
    def cancel(self, form: ShapeForm) -> None:
        """Cancel the calculation."""

    @abstractmethod
    def keys(self, form: ShapeForm, show: Show) -> Mapping[int, Key]:
        """Return the function keys that only this form has."""

    @abstractmethod
    def prompt(self, form: ShapeForm) -> str:
        """Return the text of the prompt line."""

    @abstractmethod
    def poll(self) -> None:
        """Process the results of the workers; called once per frame."""

    @abstractmethod
    def close(self) -> None:
        """Stop the workers."""


def words_of(shapes: Iterable[Shape]) -> list[str]:
    """Return the names of shapes, fields and choices for the check of translations."""
    shapes = tuple(shapes)
    fields = [field for shape in shapes for field in shape.fields]
    labels = {field.label for field in fields if len(field.label) > 1}
    choices = {choice_text(field, choice) for field in fields for choice in _in_words(field)}
    return sorted({shape.name for shape in shapes} | labels | choices)


def _in_words(field: Field) -> tuple[str, ...]:
    """Return the choices that are translatable words.

    Thread series and classes have international names.
    """
    if field.word == "SERIES":
        return (Series.OWN.value,)
    return () if field.word in {"CLASS", "SIZE"} else field.choices
