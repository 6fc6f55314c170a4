"""The scene around a part in its picture (chuck and tool), with its colors and their shades."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.picture.clamping_bodies import Body
from core.part.picture.solid_bodies import ToolBody

ImageArray = npt.NDArray[np.uint32]
SHADES = 256


class PartColors(NamedTuple):
    """Colors of the part and of the objects around it, as 0xRRGGBB.

    ``outside``, ``bore``, ``section`` and ``hit_material`` are the colors of the part. ``chuck``, ``jaw``,
    ``bar``, ``holder`` and ``insert`` are the colors of the objects around it. ``background`` is the
    background color as 0xAARRGGBB.
    """

    outside: int = 0xB9C3CC
    bore: int = 0xC9B48A
    section: int = 0xD98E4A
    hit_material: int = 0xE5322D
    background: int = 0x00000000
    chuck: int = 0x7D7B78
    jaw: int = 0x8C8F94
    bar: int = 0xA3ABB2
    holder: int = 0x6C7A89
    insert: int = 0xE8B923

    @property
    def part_colors(self) -> tuple[int, int, int, int]:
        """Return the colors of the part in the order of their numbers."""
        return self.outside, self.bore, self.section, self.hit_material

    @property
    def body_colors(self) -> tuple[int, ...]:
        """Return the colors of the clamping in the order of ``BodyMaterial``."""
        return self.chuck, self.jaw, self.bar, self.chuck


class PartScene(NamedTuple):
    """The objects around the part: the bodies that clamp it, a tool, and the transparent stock."""

    clamping: tuple[Body, ...] = ()
    tool: ToolBody | None = None
    stock: tuple[Body, ...] = ()


def make_color_table(colors: Sequence[int]) -> ImageArray:
    """Return the shades of each color as 0xAARRGGBB values, as an array (colors, shades).

    A color is dark at a brightness of 0, unchanged at 0.7, and lighter above that.
    """
    share = np.linspace(0.0, 1.0, SHADES)
    rows = []
    for colour in colors:
        rgb = np.array([(colour >> 16) & 255, (colour >> 8) & 255, colour & 255])[:, None]
        dark = rgb * np.minimum(share / 0.7, 1.0)
        light = dark + (255.0 - dark) * np.maximum((share - 0.7) / 0.3, 0.0) * 0.9
        red, green, blue = np.clip(light, 0, 255).astype(np.uint32)
        rows.append((np.uint32(0xFF) << 24) | (red << 16) | (green << 8) | blue)
    return np.array(rows, np.uint32)
