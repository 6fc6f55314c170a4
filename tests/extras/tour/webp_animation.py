"""Writer of animated WebP pictures from single pictures that Qt encodes.

The format is described at https://developers.google.com/speed/webp/docs/riff_container.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QBuffer, QByteArray, QIODevice, QRect
from PySide6.QtGui import QImage

_FORMAT = "WEBP"  # Name of the format in Qt.
_HEADER_BYTES = 12  # RIFF, the size, and WEBP
_ANIMATION_FLAG, _ALPHA_FLAG = 0x02, 0x10
_BLOCK_PX = 16  # A block with a changed pixel is stored as a whole.
_PIXEL_CHUNKS = frozenset({b"VP8 ", b"VP8L", b"ALPH"})


@dataclass
class WebpAnimation:
    """Animation of equally large pictures, which stores only the changed blocks of each picture.

    All other pixels of a picture are transparent. ``quality`` is 0 to 100, as for a single picture.
    """

    width_px: int
    height_px: int
    quality: int
    _frames: list[tuple[QRect, bytes, int]] = field(default_factory=list)  # Place, chunks, duration in ms.
    _shown: npt.NDArray[np.uint32] | None = None

    def add_picture(self, picture: QImage, duration_ms: int) -> None:
        """Add a picture. A picture that equals its predecessor only extends the predecessor's duration.

        Raises ValueError if the picture has another size.
        """
        if (picture.width(), picture.height()) != (self.width_px, self.height_px):
            raise ValueError(f"the picture is not {self.width_px}×{self.height_px} pixels large")
        pixels = _read_pixels(picture)
        changed = self._find_changed_blocks(pixels)
        rows, columns = np.nonzero(changed)
        if not rows.size:
            last_place, chunks, before_ms = self._frames[-1]
            self._frames[-1] = last_place, chunks, before_ms + duration_ms
            return
        self._shown = pixels
        left, top = int(columns.min()), int(rows.min())  # even, because blocks have an even size
        place = QRect(left, top, int(columns.max()) + 1 - left, int(rows.max()) + 1 - top)
        visible = np.where(changed, pixels | np.uint32(0xFF000000), np.uint32(0))
        stored = QImage(
            visible.tobytes(), self.width_px, self.height_px, 4 * self.width_px, QImage.Format.Format_ARGB32
        ).copy(place)
        self._frames.append((place, encode_chunks(stored, self.quality), duration_ms))

    def _find_changed_blocks(self, pixels: npt.NDArray[np.uint32]) -> npt.NDArray[np.bool_]:
        """Return which pixels are in a block that has changed since the previous picture."""
        if self._shown is None:
            return np.ones(pixels.shape, np.bool_)
        changed = np.zeros(pixels.shape, np.bool_)
        for top in range(0, self.height_px, _BLOCK_PX):
            for left in range(0, self.width_px, _BLOCK_PX):
                block = np.s_[top : top + _BLOCK_PX, left : left + _BLOCK_PX]
                changed[block] = bool(np.any(pixels[block] != self._shown[block]))
        return changed

    def make_file(self) -> bytes:
        """Return the contents of the file, which repeats the animation without end."""
        size = _three_bytes(self.width_px - 1) + _three_bytes(self.height_px - 1)
        chunks = [
            _make_chunk(b"VP8X", bytes((_ANIMATION_FLAG | _ALPHA_FLAG, 0, 0, 0)) + size),
            _make_chunk(b"ANIM", struct.pack("<IH", 0xFFFFFFFF, 0)),
        ]
        for place, encoded, duration_ms in self._frames:
            numbers = (place.x() // 2, place.y() // 2, place.width() - 1, place.height() - 1, duration_ms)
            head = b"".join(map(_three_bytes, numbers)) + b"\0"  # blended with the previous picture
            chunks.append(_make_chunk(b"ANMF", head + encoded))
        return _make_chunk(b"RIFF", b"WEBP" + b"".join(chunks))


def _read_pixels(picture: QImage) -> npt.NDArray[np.uint32]:
    """Return a copy of the pixels by row and column."""
    picture = picture.convertToFormat(QImage.Format.Format_RGB32)
    rows = np.frombuffer(picture.constBits(), np.uint32).reshape(picture.height(), -1)
    return rows[:, : picture.width()].copy()


def encode_chunks(picture: QImage, quality: int) -> bytes:
    """Return the chunks with the pixels of a picture that Qt encodes as WebP.

    Raises OSError if this Qt cannot write WebP.
    """
    data = QByteArray()
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    if not picture.save(buffer, _FORMAT, quality):  # type: ignore[call-overload]
        raise OSError("this Qt cannot write WebP pictures")
    contents, at, found = bytes(data.data()), _HEADER_BYTES, b""
    while at < len(contents):
        name, size = contents[at : at + 4], struct.unpack_from("<I", contents, at + 4)[0]
        end = at + 8 + size + size % 2
        if name in _PIXEL_CHUNKS:
            found += contents[at:end]
        at = end
    return found


def _make_chunk(name: bytes, contents: bytes) -> bytes:
    """Return a chunk, whose contents are padded to an even number of bytes."""
    return name + struct.pack("<I", len(contents)) + contents + b"\0" * (len(contents) % 2)


def _three_bytes(number: int) -> bytes:
    return number.to_bytes(3, "little")
