"""Both palettes keep the contrast that reading from two metres needs (WCAG 2.2: AA)."""

from __future__ import annotations

from dataclasses import fields

import pytest
from PySide6.QtGui import QFontInfo, QFontMetricsF, QRawFont

from app.screen.look import LEAST, Look, load_fonts
from app.screen.theme import DARK, PALETTES, Palette, contrast

TEXT = [
    *((ink, ground) for ink in ("text", "soft", "accent") for ground in ("ground", "panel", "key")),
    *(("on_state", tone) for tone in ("ready", "run", "pause", "wait", "alarm", "off")),
    *((ink, "here") for ink in ("text", "accent")),
    *((sign, "panel") for sign in ("alarm", "pause", "mark")),
    ("on_mark", "mark"),
    ("on_lit", "lit"),
    ("estop_ink", "estop"),
    ("estop_ground", "estop_plate"),
]
SHAPES = [
    *((line, "panel") for line in ("todo", "done", "rapid", "centre", "tip", "frame", "lit", "run", "pause")),
    ("frame", "ground"),
    ("estop", "estop_plate"),
]


def test_known_ratios() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)  # the well known near miss
    assert contrast("#123456", "#123456") == pytest.approx(1.0)


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
@pytest.mark.parametrize(("ink", "ground"), TEXT)
def test_text_is_readable(palette: Palette, ink: str, ground: str) -> None:
    assert contrast(getattr(palette, ink), getattr(palette, ground)) >= 4.5


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
@pytest.mark.parametrize(("shape", "ground"), SHAPES)
def test_shapes_stand_out(palette: Palette, shape: str, ground: str) -> None:
    assert contrast(getattr(palette, shape), getattr(palette, ground)) >= 3.0


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_done_and_to_come_differ_in_lightness(palette: Palette) -> None:
    assert contrast(palette.done, palette.todo) >= 2.5


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_colours_are_written_as_six_digits(palette: Palette) -> None:
    for field in fields(palette):
        value = getattr(palette, field.name)
        assert field.name == "name" or (len(value) == 7 and int(value[1:], 16) >= 0)


def test_the_bundled_font_is_what_is_drawn_with() -> None:
    assert "B612" in load_fonts()
    look = Look(DARK, 12.0)
    info = QFontInfo(look.font(2.0, bold=True))
    assert info.family() == "B612"
    assert info.bold()


def test_figures_are_of_one_width() -> None:
    metrics = QFontMetricsF(Look(DARK, 12.0).font(7.0, bold=True))
    assert len({metrics.horizontalAdvance(digit) for digit in "0123456789"}) == 1


@pytest.mark.parametrize("sign", "Ø−·—°")
def test_every_sign_is_in_the_font(sign: str) -> None:
    assert QRawFont.fromFont(Look(DARK, 12.0).font(2.0)).supportsCharacter(ord(sign))


def test_text_that_is_too_long_is_made_smaller_but_never_unreadable() -> None:
    look, text = Look(DARK, 12.0), "A PROGRAM NAME OF SOME LENGTH"
    font = look.fit(text, 3.0, 400.0, bold=True)
    assert QFontMetricsF(font).horizontalAdvance(text) <= 400.0
    assert look.fit(text, 3.0, 10.0, bold=True).pixelSize() == round(LEAST * 12.0)
