"""The color palettes of the themes, and the colors of the curves."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ColorPalette:
    """Colors as ``#rrggbb``.

    For a background color with the name ``x``, the text color has the name ``on_x``.
    """

    name: str
    ground: str
    panel: str
    frame: str
    text: str
    soft: str
    accent: str
    key: str
    ready: str
    run: str
    pause: str
    wait: str
    alarm: str
    off: str
    on_state: str
    mark: str
    on_mark: str
    lit: str
    on_lit: str
    here: str
    todo: str
    done: str
    rapid: str
    ghost: str
    centre: str
    tip: str
    estop: str = "#c81e1e"  # An E-stop is red on yellow in every theme (IEC 60204-1).
    estop_rim: str = "#7a0d0d"
    estop_plate: str = "#ffd400"
    estop_ground: str = "#14161a"
    estop_ink: str = "#ffffff"


DARK_PALETTE = ColorPalette(
    name="dark",
    ground="#080c14",
    panel="#0f1623",
    frame="#5f7699",
    text="#f4f7fb",
    soft="#a9b9cf",
    accent="#74d4f7",
    key="#1d2a40",
    ready="#dde6f1",
    run="#35c4a2",
    pause="#f5b638",
    wait="#7fc8f6",
    alarm="#ff7f50",
    off="#8b9ab0",
    on_state="#05080d",
    mark="#f5b638",
    on_mark="#05080d",
    lit="#74d4f7",
    on_lit="#05080d",
    here="#203555",
    todo="#8093ad",
    done="#ffffff",
    rapid="#d98e1f",
    ghost="#3a4d6b",
    centre="#a8779a",
    tip="#ff7f50",
)
LIGHT_PALETTE = ColorPalette(
    name="light",
    ground="#dfe5ec",
    panel="#ffffff",
    frame="#66788f",
    text="#0a101b",
    soft="#41506a",
    accent="#005580",
    key="#cdd7e3",
    ready="#2a3547",
    run="#006a52",
    pause="#8f4e00",
    wait="#005f99",
    alarm="#b32d00",
    off="#566478",
    on_state="#ffffff",
    mark="#8f4e00",
    on_mark="#ffffff",
    lit="#005f99",
    on_lit="#ffffff",
    here="#cfe3f3",
    todo="#7c8ca1",
    done="#0a101b",
    rapid="#a85c00",
    ghost="#c3ccd8",
    centre="#94497f",
    tip="#b32d00",
)
# For sunlight and color-blind operators: every text has a contrast ratio of at least 7 to its background
# (WCAG 2.2, level AAA), and the colors of the machine states differ for every kind of color blindness.
CONTRAST_PALETTE = ColorPalette(
    name="contrast",
    ground="#ffffff",
    panel="#ffffff",
    frame="#000000",
    text="#000000",
    soft="#2e2e2e",
    accent="#00357a",
    key="#d6d6d6",
    ready="#000000",
    run="#004f7c",
    pause="#6b3a00",
    wait="#3c1f9c",
    alarm="#9c0000",
    off="#4a4a4a",
    on_state="#ffffff",
    mark="#6b3a00",
    on_mark="#ffffff",
    lit="#00357a",
    on_lit="#ffffff",
    here="#ffe600",
    todo="#6e6e6e",
    done="#000000",
    rapid="#a04800",
    ghost="#a8a8a8",
    centre="#7a2e6a",
    tip="#9c0000",
    estop="#a60d0d",
)
PALETTES = {palette.name: palette for palette in (DARK_PALETTE, LIGHT_PALETTE, CONTRAST_PALETTE)}
# Colors of chart curves on the color ``panel``. Adjacent colors differ in lightness and in hue.
_LIGHT_CURVES = (
    *("#005f99", "#8f4e00", "#006a52", "#b32d00"),
    *("#86347a", "#0a101b", "#5d6b00", "#3a3fb8"),
)
CURVE_COLORS = {
    "dark": (
        *("#74d4f7", "#f5b638", "#35c4a2", "#ff7f50"),
        *("#d6a2e8", "#f4f7fb", "#b5d36a", "#8f9bff"),
    ),
    "light": _LIGHT_CURVES,
    "contrast": _LIGHT_CURVES,
}
