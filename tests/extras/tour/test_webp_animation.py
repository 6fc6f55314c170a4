"""Animated WebP pictures: a reader of another project shows each picture, and wrong sizes are rejected."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QBuffer, QByteArray, QIODevice
from PySide6.QtGui import QColor, QImage, QImageReader, QPainter

from tests.extras.tour import webp_animation
from tests.extras.tour.webp_animation import WebpAnimation, encode_chunks

SIZE = (96, 64)


def draw(*colors: str) -> QImage:
    """Return a picture with vertical stripes of these colors."""
    picture = QImage(*SIZE, QImage.Format.Format_RGB32)
    painter = QPainter(picture)
    width = SIZE[0] // len(colors)
    for number, color in enumerate(colors):
        painter.fillRect(number * width, 0, width, SIZE[1], QColor(color))
    painter.end()
    return picture


def read_back(contents: bytes) -> list[tuple[QImage, int]]:
    """Return the pictures with their durations in ms, as Qt reads them."""
    data = QByteArray(contents)
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.ReadOnly)
    reader, found = QImageReader(buffer, QByteArray(b"webp")), list[tuple[QImage, int]]()
    while not (picture := reader.read()).isNull():
        found.append((picture, reader.nextImageDelay()))
    return found


def colors_of(picture: QImage, count: int) -> list[str]:
    """Return the nearest pure colors in the middle of each stripe."""
    middles = (QColor(picture.pixel((2 * n + 1) * SIZE[0] // count // 2, SIZE[1] // 2)) for n in range(count))
    names = {(True, False): "red", (False, True): "blue"}
    return [names[(each.red() > 128, each.blue() > 128)] for each in middles]


def test_changed_stripe_is_shown_over_the_unchanged_rest(qapp: object) -> None:
    animation = WebpAnimation(*SIZE, 80)
    animation.add_picture(draw("red", "red", "blue"), 200)
    animation.add_picture(draw("red", "blue", "blue"), 300)
    first, second = read_back(animation.make_file())
    assert colors_of(first[0], 3) == ["red", "red", "blue"]
    assert colors_of(second[0], 3) == ["red", "blue", "blue"]
    assert (first[1], second[1]) == (200, 300)


def test_equal_picture_only_extends_the_duration(qapp: object) -> None:
    animation = WebpAnimation(*SIZE, 80)
    animation.add_picture(draw("red"), 200)
    animation.add_picture(draw("red"), 200)
    ((_, duration_ms),) = read_back(animation.make_file())
    assert duration_ms == 400


def test_picture_of_another_size_is_rejected(qapp: object) -> None:
    with pytest.raises(ValueError, match="96×64"):
        WebpAnimation(*SIZE, 80).add_picture(draw("red").copy(0, 0, 8, 8), 200)


def test_qt_without_webp_is_reported(qapp: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(webp_animation, "_FORMAT", "NOSUCHFORMAT")
    with pytest.raises(OSError, match="cannot write WebP"):
        encode_chunks(draw("red"), 80)
