"""Refusals of shapes on a Spanish screen."""

from __future__ import annotations

import pytest

from app.desk.translation import tr
from app.extras.shapes.shape_form import ShapeForm
from core.extras.shapes.shape_fields import ProgramSettings
from core.extras.shapes.shape_table import SHAPES_BY_KEY
from tests.screen.hands import Hands
from tests.screen.test_language import spanish

__all__ = ["spanish"]


@pytest.mark.parametrize(
    ("key", "told"),
    [
        ("R", "TAMAÑO"),
        ("G", "DIÁMETRO"),
        ("F", "DIÁMETRO INICIAL"),
    ],
)
def test_spanish_error_names_the_field_as_the_form_does(spanish: Hands, key: str, told: str) -> None:
    form = ShapeForm(SHAPES_BY_KEY[key], ProgramSettings())
    assert tr(form.current_error).startswith(f"{told} falta: ")
    assert tr(SHAPES_BY_KEY[key].name) not in {"", SHAPES_BY_KEY[key].name}
