"""Animation of the tour: Qt reads each picture that was written, and an empty animation is rejected."""

from __future__ import annotations

import io

import pytest
from PySide6.QtCore import QBuffer, QByteArray, QIODevice
from PySide6.QtGui import QColor, QImage, QImageReader

from tests.extras.tour.tour_picture import PICTURE_MS, write_animation


def draw(color: str, width_px: int = 33) -> QImage:
    """Return a picture of one color, whose rows end with padding."""
    picture = QImage(width_px, 8, QImage.Format.Format_RGB32)
    picture.fill(QColor(color))
    return picture


def test_pictures_are_read_back_with_their_colors_and_duration(qapp: object) -> None:
    file = io.BytesIO()
    write_animation([draw("red"), draw("blue")], file)
    buffer = QBuffer(data := QByteArray(file.getvalue()))
    buffer.open(QIODevice.OpenModeFlag.ReadOnly)
    reader = QImageReader(buffer, QByteArray(b"webp"))
    for red, blue in ((255, 0), (0, 255)):
        picture = reader.read()
        assert (picture.width(), picture.height(), reader.nextImageDelay()) == (33, 8, PICTURE_MS)
        color = QColor(picture.pixel(32, 7))
        assert color.red() == pytest.approx(red, abs=20)
        assert color.blue() == pytest.approx(blue, abs=20)
    assert reader.read().isNull()
    assert data.size() < 1000


def test_animation_without_pictures_is_rejected() -> None:
    with pytest.raises(ValueError, match="no pictures"):
        write_animation([], io.BytesIO())
