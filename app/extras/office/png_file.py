"""A picture in memory as a PNG file (RFC 2083, section 4), where no window system may be asked."""

from __future__ import annotations

import struct
import zlib

import numpy as np

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_BITS, _RGBA = 8, 6  # a sample; the colour type


def png_of(pixels: bytes, width: int, height: int) -> bytes:
    """32 bits a pixel, alpha, red, green, blue from the highest; rows from the top."""
    argb = np.frombuffer(pixels, dtype=np.uint32).reshape(height, width)
    rgba = np.stack([argb >> 16, argb >> 8, argb, argb >> 24], axis=-1).astype(np.uint8)
    rows = np.zeros((height, 1 + 4 * width), dtype=np.uint8)  # each begins with its filter: none
    rows[:, 1:] = rgba.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, _BITS, _RGBA, 0, 0, 0)
    body = _chunk(b"IHDR", head) + _chunk(b"IDAT", zlib.compress(rows.tobytes())) + _chunk(b"IEND", b"")
    return _SIGNATURE + body


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
