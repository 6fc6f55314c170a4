"""Pictures of the office page: an SVG of the following errors around an alarm, and PNG encoding."""

from __future__ import annotations

import struct
import zlib
from html import escape

import numpy as np

from core.records.record import FloatArray, ScopeRecord

WIDE, HIGH = 640, 220  # pixels
_LEFT, _TOP, _FOOT = 8, 24, 22
_INKS = ("#0b5cad", "#b5651d", "#6a1b9a", "#2e7d32", "#b3261e")
_POINTS = 600  # maximum number of columns of a curve
_ERROR = " following error"


def make_alarm_svg(record: ScopeRecord) -> bytes:
    """Return an SVG of the following errors over time, with the text and the time of the alarm.

    All following errors are drawn to the same scale. The result is an empty string if there are no data.
    """
    curves = _curves(record)
    times = record.times_s - record.times_s[0] if len(record.times_s) else record.times_s
    lasts = float(times[-1]) if len(times) else 0.0
    most = max((float(np.nanmax(np.abs(error))) for error in curves.values()), default=0.0)
    if not curves or lasts <= 0.0 or most <= 0.0:
        return b""
    parts = [_text(_LEFT, 16, record.about.get("alarm", ""), "#b3261e")]
    for place, (name, error) in enumerate(curves.items()):
        ink = _INKS[place % len(_INKS)]
        parts.append(_curve(times / lasts, error / most, ink))
        parts.append(_text(_LEFT + 40 * place, HIGH - 6, name, ink))
    alarm = record.about.get("alarm time")
    if alarm is not None:
        x = _LEFT + (float(alarm) - float(record.times_s[0])) / lasts * (WIDE - 2 * _LEFT)
        parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{_TOP}" y2="{HIGH - _FOOT}" stroke="#b3261e"/>')
    parts.append(
        _text(
            WIDE - 220,
            HIGH - 6,
            f"±{most:.4f} mm, {lasts:.1f} s",
            "#5b626b",
        )
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {HIGH}" width="{WIDE}" height="{HIGH}">'
        f'<rect width="{WIDE}" height="{HIGH}" fill="#fbfcfd"/>{"".join(parts)}</svg>'
    ).encode()


def _curves(record: ScopeRecord) -> dict[str, FloatArray]:
    """Return the following errors by axis letter, for the linear axes that have data."""
    found = {
        each.name.removesuffix(_ERROR): record.values_by_channel[each.name]
        for each in record.channels
        if each.name.endswith(_ERROR) and each.unit == "mm" and each.name in record.values_by_channel
    }
    return {name: error for name, error in found.items() if np.isfinite(error).any()}


def _curve(at: FloatArray, height: FloatArray, ink: str) -> str:
    """Return the SVG element of a curve.

    The curve is reduced to the minimum and maximum of each short section, so no peak is lost.
    """
    known = np.isfinite(height)
    at, height = at[known], height[known]
    chunks = np.array_split(np.arange(len(at)), min(_POINTS, len(at)))
    middle, room = (_TOP + HIGH - _FOOT) / 2, (HIGH - _FOOT - _TOP) / 2
    points = " ".join(
        f"{_LEFT + at[i] * (WIDE - 2 * _LEFT):.1f},{middle - height[i] * room:.1f}"
        for chunk in chunks
        for i in sorted({int(chunk[np.argmin(height[chunk])]), int(chunk[np.argmax(height[chunk])])})
    )
    return f'<polyline fill="none" stroke="{ink}" stroke-width="1.2" points="{points}"/>'


def _text(x: float, y: float, text: str, ink: str) -> str:
    return f'<text x="{x}" y="{y}" font-family="sans-serif" font-size="12" fill="{ink}">{escape(text)}</text>'


_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_BITS, _RGBA = 8, 6  # bits per sample; the color type


def encode_png(pixels: bytes, width: int, height: int) -> bytes:
    """Return an image as the bytes of a PNG file. The first row of pixels is the top row.

    Each pixel has 32 bits: alpha, red, green and blue, from the highest bits to the lowest.
    """
    argb = np.frombuffer(pixels, dtype=np.uint32).reshape(height, width)
    rgba = np.stack([argb >> 16, argb >> 8, argb, argb >> 24], axis=-1).astype(np.uint8)
    rows = np.zeros((height, 1 + 4 * width), dtype=np.uint8)  # each row begins with its filter type, 0
    rows[:, 1:] = rgba.reshape(height, -1)
    head = struct.pack(">IIBBBBB", width, height, _BITS, _RGBA, 0, 0, 0)
    body = _chunk(b"IHDR", head) + _chunk(b"IDAT", zlib.compress(rows.tobytes())) + _chunk(b"IEND", b"")
    return _SIGNATURE + body


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
