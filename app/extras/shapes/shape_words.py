"""The words of shapes that a screen shows: names, labels of fields and choices, for the list of all texts."""

from __future__ import annotations

from collections.abc import Iterable

from core.extras.shapes.shape import Shape
from core.extras.shapes.shape_fields import Field, choice_text
from core.extras.shapes.threads.thread_series import Series


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
