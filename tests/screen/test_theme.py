"""Both palettes keep the contrast that reading from two metres needs (WCAG 2.2: AA)."""

from __future__ import annotations

from dataclasses import fields
from types import SimpleNamespace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QFontInfo, QFontMetricsF, QRawFont

from app.desk.screen_settings import SYSTEM_THEME, ScreenSettings
from app.screen.color_palettes import (
    CONTRAST_PALETTE,
    CURVE_COLORS,
    DARK_PALETTE,
    LIGHT_PALETTE,
    PALETTES,
    ColorPalette,
)
from app.screen.screen_theme import MIN_TEXT_SIZE, ScreenTheme, find_palette, load_fonts, measure_text
from tests.screen.lathe import Operator

TEXT = [
    *((ink, ground) for ink in ("text", "soft", "accent") for ground in ("ground", "panel", "key")),
    *(("on_state", tone) for tone in ("ready", "run", "pause", "wait", "alarm", "off")),
    *((ink, "here") for ink in ("text", "accent", "soft")),
    *((sign, "panel") for sign in ("alarm", "pause", "mark")),
    ("on_mark", "mark"),
    ("on_lit", "lit"),
    ("estop_ink", "estop"),
    ("estop_ground", "estop_plate"),
]
SHAPES = [
    *((line, "panel") for line in ("todo", "done", "rapid", "centre", "tip", "frame", "lit", "run", "pause")),
    *(
        (tone, ground)
        for tone in ("ready", "run", "pause", "wait", "alarm", "off")
        for ground in ("panel", "here")
    ),
    *((line, "here") for line in ("lit", "accent", "mark")),
    ("accent", "key"),
    ("frame", "ground"),
    ("estop", "estop_plate"),
]


def test_alpha_of_returned_color_does_not_change_theme() -> None:
    """The part view draws holders through; the state in the title has the same colour."""
    look = ScreenTheme(DARK_PALETTE)
    look.get_color("off").setAlphaF(0.12)
    assert look.get_color("off").alphaF() == 1.0


def luminance(colour: str) -> float:
    """Relative luminance after WCAG 2.2, 0…1."""
    linear = []
    for at in (1, 3, 5):
        share = int(colour[at : at + 2], 16) / 255
        linear.append(share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4)
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    """Contrast ratio after WCAG 2.2, 1…21."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_known_contrast_ratios_are_calculated() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)  # the well known near miss
    assert contrast("#123456", "#123456") == pytest.approx(1.0)


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
@pytest.mark.parametrize(("ink", "ground"), TEXT)
def test_text_has_readable_contrast(palette: ColorPalette, ink: str, ground: str) -> None:
    assert contrast(getattr(palette, ink), getattr(palette, ground)) >= 4.5


@pytest.mark.parametrize(
    ("ink", "ground"),
    [
        *TEXT,
        *(
            (tone, ground)
            for tone in ("ready", "run", "pause", "wait", "alarm", "off", "mark", "lit")
            for ground in ("ground", "panel")
        ),
        ("on_state", "estop"),
    ],
)
def test_high_contrast_text_has_contrast_of_7(ink: str, ground: str) -> None:
    """Level AAA of WCAG 2.2, for sunlight."""
    assert contrast(getattr(CONTRAST_PALETTE, ink), getattr(CONTRAST_PALETTE, ground)) >= 7.0


@pytest.mark.parametrize(
    ("scheme", "palette"),
    [
        (Qt.ColorScheme.Light, LIGHT_PALETTE),
        (Qt.ColorScheme.Dark, DARK_PALETTE),
        (Qt.ColorScheme.Unknown, DARK_PALETTE),
    ],
)
def test_theme_follows_the_system_until_the_operator_chooses(
    monkeypatch: pytest.MonkeyPatch, scheme: Qt.ColorScheme, palette: ColorPalette
) -> None:
    hints = SimpleNamespace(colorScheme=lambda: scheme)
    monkeypatch.setattr("app.screen.screen_theme.QGuiApplication", SimpleNamespace(styleHints=lambda: hints))
    assert ScreenSettings().theme == SYSTEM_THEME
    assert find_palette(SYSTEM_THEME) is palette
    for name, chosen in PALETTES.items():
        assert find_palette(name) is chosen


@pytest.mark.parametrize("name", ["", "pink", "System"])
def test_an_unknown_theme_is_rejected(name: str) -> None:
    with pytest.raises(KeyError):
        find_palette(name)


def test_theme_key_selects_each_theme_in_turn(operator: Operator) -> None:
    """The machine runs on a screen whose system reports no colors, so the first theme is dark."""
    seen = []
    for _ in range(4):
        seen.append(operator.window.theme.palette.name)
        operator.type("t")
    assert seen == ["dark", "light", "contrast", "dark"]
    assert operator.stage.desk.settings_store.current_settings.theme == "light"


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
@pytest.mark.parametrize(("shape", "ground"), SHAPES)
def test_shapes_have_sufficient_contrast(palette: ColorPalette, shape: str, ground: str) -> None:
    assert contrast(getattr(palette, shape), getattr(palette, ground)) >= 3.0


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
@pytest.mark.parametrize("number", range(8))
def test_curves_have_sufficient_contrast(palette: ColorPalette, number: int) -> None:
    assert contrast(CURVE_COLORS[palette.name][number], palette.panel) >= 3.0


# Machado, Oliveira and Fernandes (2009): what eyes without L, M or S cones see, in linear RGB.
BLIND = {
    "protan": (
        (0.152286, 1.052583, -0.204868),
        (0.114503, 0.786281, 0.099216),
        (-0.003882, -0.048116, 1.051998),
    ),
    "deutan": (
        (0.367322, 0.860646, -0.227968),
        (0.280085, 0.672501, 0.047413),
        (-0.011820, 0.042940, 0.968881),
    ),
    "tritan": (
        (1.255528, -0.076749, -0.178779),
        (-0.078411, 0.930809, 0.147602),
        (0.004733, 0.691367, 0.303900),
    ),
}
TOLD_APART = [
    ("run", "alarm"),
    ("run", "pause"),
    ("alarm", "wait"),
    ("run", "off"),
    ("pause", "wait"),
    ("alarm", "off"),
]


def linear(colour: str) -> list[float]:
    shares = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    return [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]


def lab(rgb: list[float]) -> tuple[float, float, float]:
    """CIE L*a*b* of linear sRGB, white D65."""
    r, g, b = (max(0.0, min(1.0, share)) for share in rgb)
    xyz = (
        (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
    )
    x, y, z = (v ** (1 / 3) if v > 0.008856 else 7.787 * v + 16 / 116 for v in xyz)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
@pytest.mark.parametrize("eyes", BLIND)
@pytest.mark.parametrize(("one", "other"), TOLD_APART)
def test_state_colors_differ_for_color_blind_viewers(
    palette: ColorPalette, eyes: str, one: str, other: str
) -> None:
    """A difference of 10 in L*a*b* is seen at a glance; words and shapes tell the states as well."""
    seen = [
        lab(
            [
                sum(k * share for k, share in zip(row, linear(getattr(palette, name)), strict=True))
                for row in BLIND[eyes]
            ]
        )
        for name in (one, other)
    ]
    assert sum((a - b) ** 2 for a, b in zip(*seen, strict=True)) ** 0.5 >= 10


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_executed_and_remaining_path_differ_in_lightness(palette: ColorPalette) -> None:
    assert contrast(palette.done, palette.todo) >= 2.5


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES)
def test_colors_are_written_as_six_hex_digits(palette: ColorPalette) -> None:
    for field in fields(palette):
        value = getattr(palette, field.name)
        assert field.name == "name" or (len(value) == 7 and int(value[1:], 16) >= 0)


def test_bundled_font_is_used_for_drawing() -> None:
    assert "B612" in load_fonts()
    look = ScreenTheme(DARK_PALETTE, 12.0)
    info = QFontInfo(look.make_font(2.0, is_bold=True))
    assert info.family() == "B612"
    assert info.bold()


def test_digits_have_equal_width() -> None:
    metrics = QFontMetricsF(ScreenTheme(DARK_PALETTE, 12.0).make_font(7.0, is_bold=True))
    assert len({metrics.horizontalAdvance(digit) for digit in "0123456789"}) == 1


@pytest.mark.parametrize("sign", "Ø−·—°")
def test_every_character_is_in_the_font(sign: str) -> None:
    assert QRawFont.fromFont(ScreenTheme(DARK_PALETTE, 12.0).make_font(2.0)).supportsCharacter(ord(sign))


def test_long_text_is_shrunk_but_remains_readable() -> None:
    look, text = ScreenTheme(DARK_PALETTE, 12.0), "A PROGRAM NAME OF SOME LENGTH"
    font = look.fit_font(text, 3.0, 400.0, is_bold=True)
    assert QFontMetricsF(font).horizontalAdvance(text) <= 400.0
    assert look.fit_font(text, 3.0, 10.0, is_bold=True).pixelSize() == round(MIN_TEXT_SIZE * 12.0)


@pytest.mark.parametrize("bold", [False, True])
def test_text_width_is_measured_in_requested_font(bold: bool) -> None:
    look = ScreenTheme(DARK_PALETTE, 12.0)
    for size in (1.5, 3.0, 1.5):
        font = look.make_font(size, is_bold=bold)
        assert measure_text("X−12.3456", font) == QFontMetricsF(font).horizontalAdvance("X−12.3456")
